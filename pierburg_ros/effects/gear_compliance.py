"""An elastic transmission between motor and shaft."""

from collections.abc import Mapping

from pierburg_ros.arrays import Signal
from pierburg_ros.effects.effect import MOTORS, Effect, Motion, Parameter, Variant, grid
from pierburg_ros.intake.bounds import LARGEST


def along(motion: Motion, values: Mapping[str, float]) -> Signal:
    """What brakes the motor more than the shaft's own velocity says: it also turns as the gear twists."""
    twisting = motion.rate(lambda whole: whole.load(values)) / values["gear_compliance.stiffness"]
    return motion.braking(values) * twisting


EFFECT = Effect(
    id="gear_compliance",
    stage="transmission",
    sentence="The gear twists under load before it passes the motion on.",
    equation="torque = stiffness (motor angle - angle) + damping (motor velocity - velocity)",
    source="Spong, Modeling and control of elastic joint robots (1987)",
    shows_in="each reversal, and in proportion to the transmitted torque",
    record="reversals at several angles, and steps out of standstill",
    parameters=(
        Parameter(
            "stiffness",
            None,
            "torsional stiffness at the shaft; 0: rigid",
            "N.m/rad",
            0.0,
            LARGEST,
            plausible=(1.76, 35.0),
            logarithmic=True,
            inverse=True,
        ),
        Parameter(
            "damping",
            0.0,
            "damping of the twist",
            "N.m.s/rad",
            0.0,
            LARGEST,
            plausible=(0.0061, 0.31),
            logarithmic=True,
        ),
    ),
    strength=("stiffness",),
    along=along,
    typical={"stiffness": 17.60643, "damping": 0.06146564},
    variants=(Variant(("stiffness", "damping"), grid(stiffness=(2.35, 7.0, 23.5), damping=(0.061,))),),
    linear=True,
    drives=MOTORS,
)
