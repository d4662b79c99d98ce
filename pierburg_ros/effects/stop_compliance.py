"""Elastic end stops."""

from pierburg_ros.effects.effect import Effect, Parameter
from pierburg_ros.kernel import kernel

EFFECT = Effect(
    id="stop_compliance",
    stage="load",
    sentence="The end stops give a little and bounce instead of stopping dead.",
    equation="one-sided, both stops: torque = max(0, stiffness p + damping dp/dt) at penetration p",
    origin="Kelvin-Voigt contact; Johnson, Contact Mechanics (1985), section 11.4",
    shows_in="contact with a stop",
    record="duty that presses against each stop, more and less",
    parameters=(
        Parameter("stiffness", "N.m/rad", 0.0, 100000.0, (5.0, 60.0), "contact stiffness; 0: rigid"),
        Parameter("damping", "N.m.s/rad", 0.0, 5.0, (0.001, 0.1), "contact damping", default=0.0),
    ),
    strength=("stiffness",),
)


@kernel
def torque(p, penetration, rate):
    """Torque [N.m] that pushes back, at `penetration` [rad] growing with `rate` [rad/s]."""
    if penetration <= 0.0:
        return 0.0
    return max(0.0, p.stiffness * penetration + p.damping * rate)
