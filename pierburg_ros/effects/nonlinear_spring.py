"""A return spring that gets stiffer with its travel."""

from pierburg_ros.effects.effect import CONTRACT, Effect, Parameter
from pierburg_ros.kernel import kernel

EFFECT = Effect(
    id="nonlinear_spring",
    stage="load",
    sentence="The spring pulls harder towards the end than its rate says.",
    equation="spring torque + cubic_stiffness angle^3, + knee_stiffness (angle - knee_angle) beyond the knee",
    origin=CONTRACT,
    shows_in="large angles",
    record="standstills and slow ramps at small and large angles",
    parameters=(
        Parameter("cubic_stiffness", "N.m/rad^3", 0.0, 5.0, (0.01, 0.15), "cubic stiffness", default=0.0),
        Parameter(
            "knee_stiffness",
            "N.m/rad",
            0.0,
            50.0,
            (0.02, 0.3),
            "additional stiffness beyond the knee",
            default=0.0,
        ),
        Parameter(
            "knee_angle",
            "rad",
            -6.3,
            6.3,
            (0.3, 1.3),
            "angle at which the additional stiffness starts",
            default=0.0,
        ),
    ),
    strength=("cubic_stiffness", "knee_stiffness"),
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
