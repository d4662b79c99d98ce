"""Elastic bristles under the friction contact (LuGre form)."""

import math

from pierburg_ros.effects.effect import LUGRE, Effect, Parameter
from pierburg_ros.kernel import kernel

EFFECT = Effect(
    id="presliding",
    stage="friction",
    sentence="Before it slides it gives a little, like standing on a brush.",
    equation="bristle z: friction = stiffness z + damping dz/dt, dz/dt = w - abs(w) z stiffness / (friction level)",
    origin=LUGRE,
    shows_in="the first milliradians after each reversal",
    record="small reversals about several angles",
    parameters=(
        Parameter("stiffness", "N.m/rad", 0.0, 100000.0, (4.0, 60.0), "bristle stiffness; 0: rigid"),
        Parameter("damping", "N.m.s/rad", 0.0, 5.0, (0.001, 0.1), "bristle damping", default=0.0),
    ),
    strength=("stiffness",),
)


@kernel
def freedom(p, bristle, level, direction):
    """Share of the motion that goes into the bristle: dz/dt = freedom w, 1 relaxed, 0 sliding."""
    if level <= 0.0:
        return 0.0
    return 1.0 - direction * bristle * p.stiffness / level


@kernel
def moved(p, bristle, level, travel):
    """Bristle deflection [rad] after the shaft has gone `travel` [rad] one way, at constant `level` [N.m].

    With constant level the law depends on the path alone, so this is its exact solution.
    """
    if level <= 0.0:
        return 0.0
    limit = math.copysign(level / p.stiffness, travel)
    return limit + (bristle - limit) * math.exp(-abs(travel) * p.stiffness / level)
