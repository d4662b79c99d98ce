"""Elastic end stops: a spring and a damper side by side, the contact of Kelvin and Voigt."""

from pierburg_ros.effects.effect import Effect, Elsewhere, Parameter, Variant, grid
from pierburg_ros.intake.bounds import LARGEST
from pierburg_ros.kernel import kernel

EFFECT = Effect(
    id="stop_compliance",
    stage="load",
    sentence="The end stops give a little and bounce instead of stopping dead.",
    equation="one-sided, both stops: torque = max(0, stiffness p + damping dp/dt) at penetration p",
    source="Johnson, Contact Mechanics (1985)",
    elsewhere=Elsewhere(
        modelica={"stop_stiffness": "{stiffness}", "stop_damping": "{damping}"},
        quantities={"contact_stiffness": "stiffness", "contact_damping": "damping"},
    ),
    shows_in="contact with a stop",
    record="duty that presses against each stop, more and less",
    parameters=(
        Parameter(
            "stiffness",
            None,
            "contact stiffness; 0: rigid",
            "N.m/rad",
            0.0,
            LARGEST,
            plausible=(2.9, 35.0),
            logarithmic=True,
            inverse=True,
        ),
        Parameter(
            "damping",
            0.0,
            "contact damping",
            "N.m.s/rad",
            0.0,
            LARGEST,
            plausible=(0.0061, 0.61),
            logarithmic=True,
        ),
    ),
    strength=("stiffness",),
    mark="stops",
    typical={"stiffness": 17.60643, "damping": 0.06146564},
    variants=(Variant(("stiffness", "damping"), grid(stiffness=(3.5, 11.7, 35.0), damping=(0.123,))),),
    stops=True,
)


@kernel
def torque(p, penetration, rate):
    """Torque [N.m] that pushes back, at `penetration` [rad] growing with `rate` [rad/s]."""
    if penetration <= 0.0:
        return 0.0
    return max(0.0, p.stiffness * penetration + p.damping * rate)
