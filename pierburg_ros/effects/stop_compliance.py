"""Elastic end stops: a spring and a damper side by side, the contact of Kelvin and Voigt."""

from pierburg_ros.effects.effect import Effect, Elsewhere, Parameter, Variant, grid
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
            100000.0,
            plausible=(5.0, 60.0),
            logarithmic=True,
        ),
        Parameter("damping", 0.0, "contact damping", "N.m.s/rad", 0.0, 5.0, plausible=(0.001, 0.1), logarithmic=True),
    ),
    strength=("stiffness",),
    typical={"stiffness": 30.0, "damping": 0.01},
    variants=(Variant(("stiffness", "damping"), grid(stiffness=(6.0, 20.0, 60.0), damping=(0.02,))),),
    stops=True,
)


@kernel
def torque(p, penetration, rate):
    """Torque [N.m] that pushes back, at `penetration` [rad] growing with `rate` [rad/s]."""
    if penetration <= 0.0:
        return 0.0
    return max(0.0, p.stiffness * penetration + p.damping * rate)
