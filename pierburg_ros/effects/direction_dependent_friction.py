"""Friction that differs between opening and closing."""

from collections.abc import Mapping

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.effects.effect import ARMSTRONG, Effect, Elsewhere, Motion, Parameter, Variant, grid
from pierburg_ros.intake.bounds import LARGEST
from pierburg_ros.kernel import kernel


def along(motion: Motion, values: Mapping[str, float]) -> Signal:
    """What closing meets beyond opening."""
    viscous, coulomb = (values[f"direction_dependent_friction.{name}"] for name in EFFECT.names)
    return np.where(motion.velocity < 0.0, viscous * motion.velocity - coulomb, 0.0)


EFFECT = Effect(
    id="direction_dependent_friction",
    stage="friction",
    sentence="It runs easier one way than the other.",
    equation="viscous coefficient + viscous_difference and friction level + coulomb_difference when closing",
    source=ARMSTRONG,
    elsewhere=Elsewhere(
        modelica={
            "friction_level": "(if velocity < 0 then {coulomb_difference} else 0)",
            "damping": "(if velocity < 0 then {viscous_difference} else 0)",
        }
    ),
    shows_in="closing movements",
    record="slow and fast travel in both directions",
    parameters=(
        Parameter(
            "viscous_difference",
            0.0,
            "additional damping when closing; cancels at most that of both directions",
            "N.m.s/rad",
            -LARGEST,
            LARGEST,
            plausible=(0.061, 0.92),
            searched=(-6.1, 6.1),
            added_to="viscous_damping",
        ),
        Parameter(
            "coulomb_difference",
            0.0,
            "additional friction level when closing",
            "N.m",
            -LARGEST,
            LARGEST,
            plausible=(0.0037, 0.0374),
            searched=(-0.374, 0.374),
        ),
    ),
    strength=("viscous_difference", "coulomb_difference"),
    along=along,
    typical={"viscous_difference": 0.1843969, "coulomb_difference": 0.0112086},
    variants=(
        Variant(("viscous_difference",), grid(viscous_difference=(-0.184, 0.31))),
        Variant(("coulomb_difference",), grid(coulomb_difference=(-0.0112, 0.0112))),
        Variant(
            ("viscous_difference", "coulomb_difference"),
            grid(viscous_difference=(-0.184, 0.31), coulomb_difference=(-0.0112, 0.0112)),
        ),
    ),
    linear=True,
)


@kernel
def damping(p, direction):
    """Additional damping [N.m.s/rad] in `direction` (+1 opens, -1 closes)."""
    return p.viscous_difference if direction < 0.0 else 0.0


@kernel
def level(p, direction):
    """Additional friction level [N.m] in `direction` (+1 opens, -1 closes)."""
    return p.coulomb_difference if direction < 0.0 else 0.0
