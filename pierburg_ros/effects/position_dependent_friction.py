"""A place on the travel where it rubs more."""

import math

from pierburg_ros.effects.effect import ARMSTRONG, Effect, Parameter
from pierburg_ros.kernel import kernel

EFFECT = Effect(
    id="position_dependent_friction",
    stage="friction",
    sentence="There is a tight spot on the way.",
    equation="friction level + amplitude exp(-((angle - center)/width)^2)",
    origin=ARMSTRONG,
    shows_in="a band of angle, both directions",
    record="slow ramps over the whole travel in both directions",
    parameters=(
        Parameter("amplitude", "N.m", 0.0, 5.0, (0.02, 0.12), "additional friction at the tight spot"),
        Parameter("center", "rad", -6.3, 6.3, (0.1, 1.5), "angle of the tight spot"),
        Parameter("width", "rad", 0.005, 3.0, (0.04, 0.3), "half width of the tight spot, to 1/e"),
    ),
    strength=("amplitude",),
)


@kernel
def level(p, angle):
    """Additional friction level [N.m] at `angle` [rad]."""
    if p.amplitude == 0.0 or p.width == 0.0:
        return 0.0
    distance = (angle - p.center) / p.width
    return p.amplitude * math.exp(-distance * distance)


@kernel
def slope(p, angle, level):
    """Derivative of `level` [N.m] with respect to angle [N.m/rad]."""
    if level == 0.0:
        return 0.0
    return -2.0 * (angle - p.center) / (p.width * p.width) * level
