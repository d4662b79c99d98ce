"""A bridge that ignores small duty."""

import math

from pierburg_ros.effects.effect import CONTRACT, Effect, Parameter
from pierburg_ros.kernel import kernel

EFFECT = Effect(
    id="pwm_deadband",
    stage="input",
    sentence="Small commands do not reach the motor.",
    equation="effective duty = sign(duty) max(abs(duty) - width, 0)",
    origin=CONTRACT,
    shows_in="small duty, and every change of its sign",
    record="the return at duty 0, and negative duty",
    parameters=(Parameter("width", "1", 0.0, 0.5, (0.004, 0.04), "duty that is lost"),),
    strength=("width",),
)


@kernel
def effective(p, duty):
    """Duty that reaches the motor."""
    if p.width == 0.0:
        return duty
    return math.copysign(max(abs(duty) - p.width, 0.0), duty)
