"""A supply whose voltage falls under current."""

from collections.abc import Mapping

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.effects.effect import Effect, Elsewhere, Motion, Parameter, Variant, grid
from pierburg_ros.intake.bounds import LARGEST
from pierburg_ros.kernel import kernel


def along(motion: Motion, values: Mapping[str, float]) -> Signal:
    """The torque of the current that the source's resistance takes."""
    added = values["supply_sag.source_resistance"] * np.square(motion.command)
    return motion.motor_torque(values) * added / (values["armature_resistance"] + added)


EFFECT = Effect(
    id="supply_sag",
    stage="drive",
    sentence="The supply voltage drops when the motor draws current: thin wires or a weak battery.",
    equation="supply - source_resistance duty i",
    source="Mohan, Undeland, Robbins, Power Electronics, 3rd ed. (2003)",
    elsewhere=Elsewhere(modelica={"resistance": "{source_resistance}*command^2"}),
    shows_in="large duty",
    record="steps to small and to full duty, with the supply voltage logged",
    parameters=(
        Parameter(
            "source_resistance",
            None,
            "resistance of supply and wiring; less than armature_resistance",
            "ohm",
            0.0,
            LARGEST,
            plausible=(0.048, 0.85),
            below="armature_resistance",
            stride=5.0,
        ),
    ),
    strength=("source_resistance",),
    along=along,
    typical={"source_resistance": 0.1208021},
    variants=(Variant(("source_resistance",), grid(source_resistance=(0.12, 0.36, 0.72))),),
    linear=True,
    drives=("voltage",),
    recorded_in="supply_voltage",
)


@kernel
def resistance(p, duty):
    """What the source adds to the resistance of the motor circuit at `duty` [ohm].

    The bridge draws duty i from the supply and passes on duty times what is left of it.
    """
    return p.source_resistance * duty * duty
