"""The shaft on its own, behind teeth that have parted or give: without inertia, its torques balance at any moment.

Held, or sliding at the velocity at which damping takes up what is left. The inertia is the motor's.
"""

from __future__ import annotations

import math

from pierburg_ros.effects import presliding
from pierburg_ros.kernel import kernel
from pierburg_ros.plant.motion.body import PARTED, share, torque_at
from pierburg_ros.plant.motion.events import lower, off_stops, upper
from pierburg_ros.plant.torques.friction import breakaway, damping, level
from pierburg_ros.plant.torques.load import load, outside

LEAST_DAMPING = 6e-5
"""Damping of a shaft that nothing damps, as a share of stall torque over no-load speed: a hundredth of the one moves it
at a hundred times the other, at once for all purposes."""


@kernel
def least_damping(p):
    """Damping [N.m.s/rad] of a shaft that nothing damps."""
    return LEAST_DAMPING * p.own.torque * p.own.time / p.own.angle


@kernel
def own_share(p):
    """Share of the friction that the shaft carries."""
    return 1.0 - share(p, PARTED)


@kernel
def onset(p, s, tooth, angle, time):
    """Direction in which the standing shaft begins to move under the `tooth` torque [N.m]; 0 where it is held."""
    own = own_share(p)
    motor = torque_at(p, s, s.motor_velocity, s.current)
    net = tooth - load(p, angle, 0.0, outside(p, s, time))[0]
    return off_stops(p, breakaway(p, own, net, angle, motor, s.presliding.bristle), angle)


@kernel
def resistance(p, s, angle, velocity, bristle, time, motor):
    """What resists the sliding shaft: torque at rest [N.m], stiffness [N.m/rad], damping [N.m.s/rad], friction level.

    Under the `motor` torque [N.m]; how friction falls with velocity is not followed within a step.
    """
    own = own_share(p)
    torque, stiffness, by_velocity, _ = load(p, angle, velocity, outside(p, s, time))
    friction, _, by_angle, _ = level(p, s.direction, velocity, angle, motor)
    resisting = own * damping(p, s.direction) + by_velocity
    torque -= by_velocity * velocity
    if p.presliding.stiffness != 0.0:
        free = own * presliding.freedom(p.presliding, bristle, friction, s.direction)
        torque += own * p.presliding.stiffness * bristle
        return torque, stiffness + p.presliding.stiffness * free, resisting + p.presliding.damping * free, friction
    return torque + own * s.direction * friction, stiffness + own * s.direction * by_angle, resisting, friction


@kernel
def bristle_after(p, s, friction, travel):
    """Bristle deflection [rad] after the shaft has gone `travel` [rad] against this `friction` [N.m]."""
    if p.presliding.stiffness == 0.0:
        return 0.0
    return presliding.moved(p.presliding, s.presliding.bristle, friction, travel)


@kernel
def leaned(p, s, friction, bristle, travel):
    """Deflection [rad] of a `bristle` after a very short `travel` [rad] against this `friction` [N.m]."""
    if p.presliding.stiffness == 0.0:
        return 0.0
    return bristle + presliding.freedom(p.presliding, bristle, friction, s.direction) * travel


@kernel
def drift(p, s, step):
    """Let the shaft go on its own for a short `step` [s], up to a rigid stop; it rests where nothing drives it on."""
    motor = torque_at(p, s, s.motor_velocity, s.current)
    torque, stiffness, viscous, friction = resistance(p, s, s.angle, s.velocity, s.presliding.bristle, s.time, motor)
    slack = max(viscous, least_damping(p))
    velocity = -torque / slack
    if velocity * s.direction <= 0.0:
        s.velocity = s.direction = 0.0
        return
    rate = stiffness / slack
    travel = velocity * (step if abs(rate) * step < 1e-9 else -math.expm1(-rate * step) / rate)
    s.presliding.bristle = bristle_after(p, s, friction, travel)
    s.velocity = velocity
    s.angle += travel
    if s.angle <= lower(p) or s.angle >= upper(p):
        s.angle = min(max(s.angle, lower(p)), upper(p))
        s.velocity = s.direction = 0.0
