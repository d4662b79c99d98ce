"""A return spring that gets stiffer with its travel."""

from collections.abc import Mapping

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.effects.effect import Effect, Elsewhere, Motion, Parameter, Variant, grid
from pierburg_ros.intake.bounds import LARGEST
from pierburg_ros.kernel import kernel


def along(motion: Motion, values: Mapping[str, float]) -> Signal:
    """What the spring adds at the measured angle."""
    cubic, stiffness, knee = (values[f"nonlinear_spring.{name}"] for name in EFFECT.names)
    return cubic * motion.angle**3 + stiffness * np.maximum(motion.angle - knee, 0.0)


EFFECT = Effect(
    id="nonlinear_spring",
    stage="load",
    sentence="The spring pulls harder towards the end than its rate says.",
    equation="spring torque + cubic_stiffness angle^3, + knee_stiffness (angle - knee_angle) beyond the knee",
    source="Nayfeh, Mook, Nonlinear Oscillations (1979)",
    elsewhere=Elsewhere(
        modelica={"load": "{cubic_stiffness}*angle^3 + {knee_stiffness}*max(angle - {knee_angle}, 0)"},
        quantities={"spring_cubic_stiffness": "cubic_stiffness"},
    ),
    shows_in="large angles",
    record="standstills and slow ramps at small and large angles",
    parameters=(
        Parameter("cubic_stiffness", 0.0, "cubic stiffness", "N.m/rad^3", 0.0, LARGEST, plausible=(0.0145, 0.217)),
        Parameter(
            "knee_stiffness",
            0.0,
            "additional stiffness beyond the knee",
            "N.m/rad",
            0.0,
            LARGEST,
            plausible=(0.0117, 0.176),
        ),
        Parameter(
            "knee_angle",
            0.0,
            "angle at which the additional stiffness starts",
            "rad",
            -LARGEST,
            LARGEST,
            plausible=(0.19, 0.83),
            # an earlier knee is a stiffer spring
            searched=(0.064, 4.0),
        ),
    ),
    strength=("cubic_stiffness", "knee_stiffness"),
    along=along,
    typical={"cubic_stiffness": 0.07240354},
    variants=(
        Variant(("cubic_stiffness",), grid(cubic_stiffness=(0.0434,))),
        Variant(("knee_stiffness", "knee_angle"), grid(knee_stiffness=(0.0587,), knee_angle=(0.19, 0.38, 0.57, 0.76))),
    ),
    loads=("spring",),
)


@kernel
def torque(p, angle):
    """Additional spring torque [N.m] at `angle` [rad]."""
    return p.cubic_stiffness * angle * angle * angle + p.knee_stiffness * max(angle - p.knee_angle, 0.0)


@kernel
def slope(p, angle):
    """Derivative of `torque` with respect to angle [N.m/rad]."""
    beyond = p.knee_stiffness if angle > p.knee_angle else 0.0
    return 3.0 * p.cubic_stiffness * angle * angle + beyond
