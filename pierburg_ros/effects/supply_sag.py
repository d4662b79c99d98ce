"""A supply whose voltage falls under current."""

from pierburg_ros.effects.effect import CONTRACT, Effect, Parameter
from pierburg_ros.kernel import kernel

EFFECT = Effect(
    id="supply_sag",
    stage="drive",
    sentence="The supply voltage drops when the motor draws current: thin wires or a weak battery.",
    equation="supply - source_resistance duty i",
    origin=CONTRACT,
    shows_in="large duty",
    record="steps to small and to full duty, with the supply voltage logged",
    parameters=(
        Parameter(
            "source_resistance",
            "ohm",
            0.0,
            50.0,
            (0.2, 3.5),
            "resistance of supply and wiring; less than armature_resistance",
        ),
    ),
    strength=("source_resistance",),
)


@kernel
def resistance(p, duty):
    """What the source adds to the resistance of the motor circuit at `duty` [ohm].

    The bridge draws duty i from the supply and passes on duty times what is left of it.
    """
    return p.source_resistance * duty * duty
