"""Friction that grows with the torque the gear transmits."""

from pierburg_ros.effects.effect import ARMSTRONG, Effect, Elsewhere, Parameter, Variant, grid
from pierburg_ros.kernel import kernel

EFFECT = Effect(
    id="load_dependent_friction",
    stage="friction",
    sentence="The harder the motor pushes, the more the gear rubs.",
    equation="friction level + coefficient abs(T_m)",
    source=ARMSTRONG,
    elsewhere=Elsewhere(modelica={"friction_level": "{coefficient}*abs(motor_torque)"}),
    shows_in="large duty, breaking loose under load",
    record="steps to large and small duty at the same angle",
    parameters=(
        Parameter(
            "coefficient",
            None,
            "share of the motor torque lost to friction",
            "1",
            0.0,
            0.9,
            plausible=(0.02, 0.3),
            stride=5.0,
        ),
    ),
    strength=("coefficient",),
    typical={"coefficient": 0.1},
    variants=(Variant(("coefficient",), grid(coefficient=(0.03, 0.1))),),
)


@kernel
def level(p, motor_torque):
    """Additional friction level [N.m]."""
    return p.coefficient * abs(motor_torque)
