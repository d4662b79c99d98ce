"""Elastic bristles under the friction contact (LuGre form)."""

import math

from pierburg_ros.effects.effect import Effect, Elsewhere, Parameter, Variant, grid
from pierburg_ros.intake.bounds import LARGEST
from pierburg_ros.kernel import kernel

EFFECT = Effect(
    id="presliding",
    stage="friction",
    sentence="Before it slides it gives a little, like standing on a brush.",
    equation="bristle z: friction = stiffness z + damping dz/dt, dz/dt = w - abs(w) z stiffness / (friction level)",
    source="Canudas de Wit, Olsson, Astrom, Lischinsky, A new model for control of systems with friction (1995)",
    elsewhere=Elsewhere(
        modelica={"bristle_stiffness": "{stiffness}", "bristle_damping": "{damping}"},
        quantities={"bristle_stiffness": "stiffness", "bristle_damping": "damping"},
    ),
    shows_in="the first milliradians after each reversal",
    record="small reversals about several angles",
    parameters=(
        Parameter(
            "stiffness",
            None,
            "bristle stiffness; 0: rigid",
            "N.m/rad",
            0.0,
            LARGEST,
            plausible=(2.35, 35.0),
            logarithmic=True,
            inverse=True,
        ),
        Parameter(
            "damping",
            0.0,
            "bristle damping",
            "N.m.s/rad",
            0.0,
            LARGEST,
            plausible=(0.0061, 0.61),
            logarithmic=True,
        ),
    ),
    strength=("stiffness",),
    mark="reversals",
    typical={"stiffness": 23.47524, "damping": 0.1843969},
    variants=(Variant(("stiffness", "damping"), grid(stiffness=(2.9, 8.8, 29.3), damping=(0.123,))),),
    # rad: of the friction contact, at the shaft where the teeth have parted; and of the motor side then
    state=("bristle", "motor_bristle"),
)


@kernel
def freedom(p, bristle, level, direction):
    """Share of the motion that goes into the bristle: dz/dt = freedom w, 1 relaxed, 0 sliding."""
    if level <= 0.0:
        return 0.0
    return 1.0 - direction * bristle * p.stiffness / level


@kernel
def bearing(p, bristle, level, direction, velocity):
    """What bristles bear [N.m], and how that changes: with velocity, along the path, and with the friction level.

    The torque of the lean and the damping [N.m.s/rad] of the part of the motion that goes into it; the sum of both over
    the travel [N.m/rad], in which the lean grows and its freedom fades; over the level [1].
    """
    free = freedom(p, bristle, level, direction)
    damping = p.damping * free
    if level <= 0.0:
        return p.stiffness * bristle, damping, 0.0, 0.0
    rubbed = p.damping * abs(velocity) / level
    return p.stiffness * bristle, damping, p.stiffness * free * (1.0 - rubbed), direction * rubbed * (1.0 - free)


@kernel
def moved(p, bristle, before, after, travel):
    """Bristle deflection [rad] after the shaft has gone `travel` [rad] one way, its level going over evenly [N.m].

    The law depends on the path alone, and this is its exact solution but that the path over which bristles forget is
    that of the mean level. However short it is beside the travel, they end behind the level by what it changes in it.
    """
    level = 0.5 * (before + after)
    if level <= 0.0:
        return bristle if travel == 0.0 else 0.0
    reach = abs(travel) * p.stiffness / level
    if reach == 0.0:
        return bristle
    first, last = math.copysign(before / p.stiffness, travel), math.copysign(after / p.stiffness, travel)
    faded = math.expm1(-reach)
    return last + (bristle - first) * (1.0 + faded) + (last - first) * faded / reach
