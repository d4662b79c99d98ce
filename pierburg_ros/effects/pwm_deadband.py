"""A bridge that ignores small duty."""

import math

from pierburg_ros.effects.effect import Effect, Elsewhere, Parameter, Variant, grid
from pierburg_ros.kernel import kernel

EFFECT = Effect(
    id="pwm_deadband",
    stage="input",
    sentence="Small commands do not reach the motor.",
    equation="effective duty = sign(duty) max(abs(duty) - width, 0)",
    source="Mohan, Undeland, Robbins, Power Electronics, 3rd ed. (2003)",
    elsewhere=Elsewhere(modelica={"command": "sign({input})*max(abs({input}) - {width}, 0)"}),
    shows_in="small duty, and every change of its sign",
    record="the return at duty 0, and negative duty",
    parameters=(
        Parameter(
            "width", None, "duty that is lost", "1", 0.0, 1.0, plausible=(0.004, 0.04), searched=(0.0, 0.5), stride=5.0
        ),
    ),
    strength=("width",),
    typical={"width": 0.02},
    variants=(Variant(("width",), grid(width=(0.005, 0.015, 0.04))),),
    linear=True,
    drives=("voltage",),
)


@kernel
def effective(p, duty):
    """Duty that reaches the motor."""
    if p.width == 0.0:
        return duty
    return math.copysign(max(abs(duty) - p.width, 0.0), duty)
