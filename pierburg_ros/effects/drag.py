"""Drag: a torque that grows faster than the velocity."""

from collections.abc import Mapping

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.effects.effect import Effect, Elsewhere, Motion, Parameter, Variant, grid
from pierburg_ros.intake.bounds import LARGEST
from pierburg_ros.kernel import kernel


def along(motion: Motion, values: Mapping[str, float]) -> Signal:
    """What resists the velocity."""
    quadratic, cubic = (values[f"drag.{name}"] for name in EFFECT.names)
    return (quadratic * np.abs(motion.velocity) + cubic * motion.velocity**2) * motion.velocity


EFFECT = Effect(
    id="drag",
    stage="friction",
    sentence="What it turns in, air or oil, resists fast travel far more than slow.",
    equation="friction + quadratic w abs(w) + cubic w^3",
    source=(
        "Fox, McDonald, Introduction to Fluid Mechanics (1973), drag coefficient; "
        "cubic as in the grey-box model of the CE109 bench in github.com/helonayala/sysid"
    ),
    elsewhere=Elsewhere(modelica={"damping": "({quadratic}*abs(velocity) + {cubic}*velocity^2)"}),
    shows_in="fast travel, and much less at half the speed",
    record="steady travel at several speeds up to the fastest, both directions",
    parameters=(
        Parameter(
            "quadratic",
            0.0,
            "torque per square of the velocity",
            "N.m.s^2/rad^2",
            0.0,
            LARGEST,
            plausible=(0.1, 3.0),
            stride=5.0,
        ),
        Parameter(
            "cubic",
            0.0,
            "torque per cube of the velocity",
            "N.m.s^3/rad^3",
            0.0,
            LARGEST,
            plausible=(0.1, 6.0),
            stride=5.0,
        ),
    ),
    strength=("quadratic", "cubic"),
    along=along,
    typical={"quadratic": 0.3033583},
    variants=(
        Variant(("cubic",), grid(cubic=(0.5,))),
        Variant(("quadratic",), grid(quadratic=(0.5,))),
        Variant(("quadratic", "cubic"), grid(quadratic=(0.25,), cubic=(0.25,))),
    ),
)


@kernel
def damping(p, velocity):
    """Torque over `velocity` [rad/s], and its derivative with it, both [N.m.s/rad]."""
    speed = abs(velocity)
    return (p.quadratic + p.cubic * speed) * speed, (2.0 * p.quadratic + 3.0 * p.cubic * speed) * speed
