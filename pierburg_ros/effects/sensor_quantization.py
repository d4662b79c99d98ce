"""The resolution of the converter."""

import math

from pierburg_ros.effects.effect import Effect, Elsewhere, Parameter
from pierburg_ros.intake.bounds import LARGEST
from pierburg_ros.kernel import kernel

EFFECT = Effect(
    id="sensor_quantization",
    stage="sensor",
    sentence="The measurement comes in steps.",
    equation="measured value rounded to multiples of step",
    source="Widrow, Kollar, Quantization Noise (2008)",
    elsewhere=Elsewhere(modelica={"measured": "{step}*floor(({input})/{step} + 0.5)"}),
    shows_in="standstills; a staircase at slow travel",
    record="very slow ramps with little noise",
    parameters=(
        Parameter(
            "step",
            None,
            "resolution (rad where the angle itself is measured)",
            "V",
            0.0,
            LARGEST,
            plausible=(0.00024, 0.0122),
            measure="reading",
        ),
    ),
    strength=("step",),
    typical={"step": 0.001219512},
    linear=True,
    rounds="step",
)


@kernel
def rounded(p, value):
    """`value` on the converter's grid, same unit."""
    if p.step == 0.0:
        return value
    return math.floor(value / p.step + 0.5) * p.step
