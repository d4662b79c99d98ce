"""A place on the travel where it rubs more."""

import math
from collections.abc import Mapping, Sequence

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.effects.effect import ARMSTRONG, Effect, Elsewhere, Motion, Parameter, Reach, Start, Variant
from pierburg_ros.intake.bounds import LARGEST
from pierburg_ros.kernel import kernel

FADED = 6.0
"""Widths from its centre at which a spot is nothing: exp(-36) is the rounding of a number."""


def _every_spot(reach: Reach) -> Sequence[Start]:
    """Spots of three widths, the next one closer than its width."""
    return [
        {"amplitude": 0.015, "center": float(center), "width": width}
        for width in (0.03, 0.08, 0.19)
        for center in np.arange(reach.low, reach.high, 0.7 * width)
    ]


def along(motion: Motion, values: Mapping[str, float]) -> Signal:
    """The friction of the spot at the measured angle."""
    amplitude, center, width = (values[f"position_dependent_friction.{name}"] for name in EFFECT.names)
    return motion.direction * amplitude * np.exp(-np.square((motion.angle - center) / max(width, 1e-300)))


EFFECT = Effect(
    id="position_dependent_friction",
    stage="friction",
    sentence="There is a tight spot on the way.",
    equation="friction level + amplitude exp(-((angle - center)/width)^2)",
    source=ARMSTRONG,
    elsewhere=Elsewhere(modelica={"friction_level": "{amplitude}*exp(-((angle - {center})/{width})^2)"}),
    shows_in="a band of angle, both directions",
    record="slow ramps over the whole travel in both directions",
    parameters=(
        Parameter(
            "amplitude",
            None,
            "additional friction at the tight spot",
            "N.m",
            0.0,
            LARGEST,
            plausible=(0.0075, 0.045),
        ),
        Parameter(
            "center",
            None,
            "angle of the tight spot",
            "rad",
            -LARGEST,
            LARGEST,
            plausible=(0.064, 0.955),
            searched=(-4.0, 4.0),
        ),
        Parameter(
            "width",
            None,
            "half width of the tight spot, to 1/e",
            "rad",
            0.0,
            LARGEST,
            plausible=(0.0255, 0.19),
            logarithmic=True,
        ),
    ),
    strength=("amplitude",),
    along=along,
    typical={"amplitude": 0.0224172, "center": 0.5092958, "width": 0.09549297},
    variants=(Variant(("amplitude", "center", "width"), _every_spot),),
)


@kernel
def level(p, angle):
    """Additional friction level [N.m] at `angle` [rad]."""
    if p.amplitude == 0.0 or p.width == 0.0:
        return 0.0
    distance = (angle - p.center) / p.width
    return p.amplitude * math.exp(-distance * distance)


@kernel
def bends_within(p, angle):
    """Travel [rad] from `angle` within which the friction turns no more than once: up to the spot, or its width there.

    A spot without amplitude or width is none.
    """
    if p.amplitude == 0.0 or p.width == 0.0:
        return math.inf
    return max(p.width, abs(angle - p.center) - FADED * p.width)


@kernel
def slope(p, angle, level):
    """Derivative of `level` [N.m] with respect to angle [N.m/rad]."""
    if level == 0.0:
        return 0.0
    return -2.0 * (angle - p.center) / (p.width * p.width) * level
