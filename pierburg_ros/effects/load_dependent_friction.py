"""Friction that grows with the torque the gear transmits."""

from collections.abc import Mapping

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.effects.effect import ARMSTRONG, Effect, Elsewhere, Motion, Parameter, Variant, grid
from pierburg_ros.kernel import kernel


def along(motion: Motion, values: Mapping[str, float]) -> Signal:
    """What rubs under the torque that the load needs of the motor, this friction included.

    Not of the motor torque that was recorded: where nearly all of that is friction, it would explain itself.
    """
    coefficient, needed = values["load_dependent_friction.coefficient"], motion.load(values)
    helps = needed * motion.direction < 0.0
    return coefficient * motion.direction * np.abs(needed) / np.where(helps, 1.0 + coefficient, 1.0 - coefficient)


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
    along=along,
    typical={"coefficient": 0.1},
    variants=(Variant(("coefficient",), grid(coefficient=(0.03, 0.1))),),
)


@kernel
def level(p, motor_torque):
    """Additional friction level [N.m]."""
    return p.coefficient * abs(motor_torque)
