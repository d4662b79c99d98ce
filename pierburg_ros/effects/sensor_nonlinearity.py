"""A Hall characteristic that bends."""

import math

from pierburg_ros.effects.effect import CONTRACT, Effect, Parameter
from pierburg_ros.kernel import kernel

EFFECT = Effect(
    id="sensor_nonlinearity",
    stage="sensor",
    sentence="The sensor reads a little too high or too low between its end points.",
    equation="Hall span (x + amplitude sin(half_waves pi x)), x = angle / (pi/2)",
    origin=CONTRACT,
    shows_in="a smooth error over the angle, at rest too",
    record="standstills over the whole travel, and runs to both stops",
    parameters=(
        Parameter("amplitude", "1", -0.3, 0.3, (-0.06, 0.06), "largest error as a fraction of the span"),
        Parameter("half_waves", "1", 1.0, 2.0, (1.0, 2.0), "half waves over the span", choices=(1.0, 2.0)),
    ),
    strength=("amplitude",),
)


@kernel
def bent(p, fraction):
    """Indicated fraction of the span, at the true `fraction`."""
    if p.amplitude == 0.0:
        return fraction
    return fraction + p.amplitude * math.sin(p.half_waves * math.pi * fraction)
