"""Viscous friction: a torque in proportion to velocity."""

from pierburg_ros.effects.effect import ARMSTRONG, Effect, Parameter
from pierburg_ros.kernel import kernel

EFFECT = Effect(
    id="viscous_friction",
    stage="friction",
    sentence="The mechanism is harder to turn the faster it turns, like a bearing in cold grease.",
    equation="friction + coefficient w",
    origin=ARMSTRONG,
    shows_in="fast travel, both directions",
    record="full-duty travel in both directions, and the motor resistance measured",
    parameters=(Parameter("coefficient", "N.m.s/rad", 0.0, 2.0, (0.01, 0.1), "torque per velocity at the shaft"),),
    strength=("coefficient",),
)


@kernel
def damping(p):
    """Damping [N.m.s/rad]."""
    return p.coefficient
