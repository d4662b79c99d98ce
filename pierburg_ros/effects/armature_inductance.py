"""Inductance of the armature winding."""

from collections.abc import Mapping

from pierburg_ros.arrays import Signal
from pierburg_ros.effects.effect import PAPER, Effect, Elsewhere, Motion, Parameter, Variant, grid
from pierburg_ros.intake.bounds import LARGEST


def along(motion: Motion, values: Mapping[str, float]) -> Signal:
    """What the current that comes late would have driven."""
    late = values["armature_inductance.inductance"] / values["armature_resistance"]
    return late * motion.rate(lambda whole: whole.load(values))


EFFECT = Effect(
    id="armature_inductance",
    stage="drive",
    sentence="The motor current follows the voltage a little late.",
    equation="inductance di/dt = u - R i - k_g k_m w",
    source=PAPER,
    elsewhere=Elsewhere(modelica={"inductance": "{inductance}"}, quantities={"winding_inductance": "inductance"}),
    shows_in="fractions of a millisecond after each change of duty",
    record="samples at 10 kHz or more",
    parameters=(Parameter("inductance", None, "of the winding", "H", 0.0, LARGEST, plausible=(0.00025, 0.064)),),
    strength=("inductance",),
    along=along,
    typical={"inductance": 0.002530387},
    variants=(Variant(("inductance",), grid(inductance=(0.0025, 0.0127))),),
    linear=True,
    drives=("voltage",),
)
