"""Friction of a sliding or standing contact: its level, its damping, and what holds at rest.

Karnopp form (equations (7) and (8) of the paper): a standing shaft stays exactly where it is until the torque
on it exceeds the level at rest; a sliding one meets the level with the sign of its velocity.
"""

from __future__ import annotations

from pierburg_ros.effects import (
    direction_dependent_friction,
    drag,
    load_dependent_friction,
    position_dependent_friction,
    static_friction,
    viscous_friction,
)
from pierburg_ros.kernel import kernel

NO_PUSH = 4e-10
"""Share of the stall torque that is no push: bristles have come to rest when nothing more than this drives them."""
LEAST_LEAN = 1e-8
"""Share of the travel below which a sliding bristle has no lean of its own: a twentieth of the error that a step may
make. It would change its lean within any step, and be no number where the friction fades away."""


@kernel
def damping(p, direction, velocity):
    """What resists the `velocity` [rad/s] in `direction` (+1 opens, -1 closes) beyond the friction level.

    Torque over velocity, and its derivative with velocity [N.m.s/rad]: the same where it is a straight line.
    """
    viscous = viscous_friction.damping(p.viscous_friction)
    viscous += direction_dependent_friction.damping(p.direction_dependent_friction, direction)
    if p.plain:
        return viscous, viscous
    over, slope = drag.damping(p.drag, velocity)
    return viscous + over, viscous + slope


@kernel
def level(p, direction, velocity, angle, motor_torque):
    """Friction level [N.m], and its derivatives with velocity, angle and motor torque."""
    value = p.coulomb_friction + direction_dependent_friction.level(p.direction_dependent_friction, direction)
    by_velocity = by_angle = by_torque = 0.0
    if not p.plain:
        if p.static_friction.breakaway_torque != 0.0:
            excess = static_friction.excess(p.static_friction, p.coulomb_friction, velocity)
            value += excess
            by_velocity = static_friction.slope(p.static_friction, velocity, excess)
        if p.load_dependent_friction.coefficient != 0.0:
            value += load_dependent_friction.level(p.load_dependent_friction, motor_torque)
            by_torque = p.load_dependent_friction.coefficient * (1.0 if motor_torque >= 0.0 else -1.0)
        if p.position_dependent_friction.amplitude != 0.0:
            spot = position_dependent_friction.level(p.position_dependent_friction, angle)
            value += spot
            by_angle = position_dependent_friction.slope(p.position_dependent_friction, angle, spot)
    if value <= 0.0:
        return 0.0, 0.0, 0.0, 0.0
    return value, by_velocity, by_angle, by_torque


@kernel
def leans(p, level):
    """Whether a contact of this friction `level` [N.m], or of that the other way, gives before it slides."""
    if p.presliding.stiffness == 0.0:
        return False
    either = level + abs(p.direction_dependent_friction.coulomb_difference)
    return either > LEAST_LEAN * p.own.angle * p.presliding.stiffness


@kernel
def standing(p, share, net, angle, motor_torque, bristle):
    """What `net` torque pushes a standing contact with that carries this `share` of it, and what it holds [N.m].

    Bristles hold by leaning, so what they bear is part of the balance, and any push beyond it moves them.
    """
    held = level(p, 1.0 if net > 0.0 else -1.0, 0.0, angle, motor_torque)[0]
    if leans(p, held):
        return net - share * p.presliding.stiffness * bristle, NO_PUSH * p.own.torque
    return net, share * held


@kernel
def breakaway(p, share, net, angle, motor_torque, bristle):
    """Direction in which `net` torque [N.m] moves a standing contact that carries this `share` of friction, or 0."""
    push, held = standing(p, share, net, angle, motor_torque, bristle)
    if push > held:
        return 1.0
    return -1.0 if push < -held else 0.0
