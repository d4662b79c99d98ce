"""Viscous friction: a torque in proportion to velocity."""

from collections.abc import Mapping

from pierburg_ros.arrays import Signal
from pierburg_ros.effects.effect import ARMSTRONG, Effect, Elsewhere, Motion, Parameter, Variant, grid
from pierburg_ros.intake.bounds import LARGEST
from pierburg_ros.kernel import kernel


def along(motion: Motion, values: Mapping[str, float]) -> Signal:
    """What resists the velocity."""
    return values["viscous_friction.coefficient"] * motion.velocity


EFFECT = Effect(
    id="viscous_friction",
    stage="friction",
    sentence="The mechanism is harder to turn the faster it turns, like a bearing in cold grease.",
    equation="friction + coefficient w",
    source=ARMSTRONG,
    elsewhere=Elsewhere(modelica={"damping": "{coefficient}"}, quantities={"viscous_damping": "coefficient"}),
    shows_in="fast travel, both directions",
    record="full-duty travel in both directions, with the motor resistance measured and held",
    parameters=(
        Parameter(
            "coefficient",
            None,
            "torque per velocity at the shaft",
            "N.m.s/rad",
            0.0,
            LARGEST,
            plausible=(0.061, 0.61),
            stride=5.0,
        ),
    ),
    strength=("coefficient",),
    along=along,
    typical={"coefficient": 0.1843969},
    variants=(Variant(("coefficient",), grid(coefficient=(0.184,))),),
    linear=True,
)


@kernel
def damping(p):
    """Damping [N.m.s/rad]."""
    return p.coefficient
