"""The shaft on its own, behind teeth that have parted or give: without inertia, its torques balance at any moment.

Held, or sliding at the velocity at which damping takes up what is left. The inertia is the motor's.
"""

from __future__ import annotations

import math

from pierburg_ros.effects import presliding
from pierburg_ros.kernel import kernel
from pierburg_ros.plant.motion.body import PARTED, share, torque_at
from pierburg_ros.plant.motion.events import lower, off_stops, upper
from pierburg_ros.plant.torques.friction import NO_PUSH, breakaway, damping, leans, level
from pierburg_ros.plant.torques.load import load, outside

LEAST_DAMPING = 6e-5
"""Damping of a shaft that nothing damps, as a share of stall torque over no-load speed: a hundredth of the one moves it
at a hundred times the other, at once for all purposes."""
FOLD = 0.01
"""Share of the teeth's damping below which what damps the shaft does not fall with the friction: where a balance ends,
its velocity would change without bound."""
NEWTON = 6
"""Tangents tried for a velocity; each doubles the digits of one that is near."""
STRIDE = 0.25
"""Share of the Stribeck velocity in which the friction's fall turns once at most."""
STRIBECK_FADED = 3.0
"""Multiple of the Stribeck velocity at which the friction above the sliding one has faded to 1e-4 of it."""
STRIDES, SECANTS = 50, 60
"""Most steps of a search, first outwards, then between two velocities by secants, whose far end loses half its say.
Work: fifty doublings go 1e15 strides out, beyond which rounding hides a stride; with 200 a set took over 100 s."""


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

    Under the `motor` torque [N.m], as the straight line that touches it at this `velocity` [rad/s]. Bristles come to
    another level by their travel, so that how it falls with velocity is not followed within a step.
    """
    own = own_share(p)
    torque, stiffness, by_velocity, _ = load(p, angle, velocity, outside(p, s, time))
    friction, by_speed, by_angle, _ = level(p, s.direction, velocity, angle, motor)
    over, by_drag = damping(p, s.direction, velocity)
    resisting = own * by_drag
    torque += own * (over - by_drag) * velocity
    if leans(p, friction):
        free = own * presliding.freedom(p.presliding, bristle, friction, s.direction)
        torque += own * p.presliding.stiffness * bristle
        stiffness += p.presliding.stiffness * free
        resisting += p.presliding.damping * free
    else:
        torque += own * s.direction * friction
        stiffness += own * s.direction * by_angle
        by_velocity += own * s.direction * by_speed
    return torque - by_velocity * velocity, stiffness, resisting + by_velocity, friction


@kernel
def settled(p, s, push, slack, angle, velocity, bristle, time, motor):
    """Velocity [rad/s] of the sliding shaft under a `push` [N.m] that falls by `slack` [N.m.s/rad], and its resistance.

    Where friction falls with velocity the torques may balance at several: a shaft whose inertia vanishes keeps to the
    velocity that it has, and where that balance ends it jumps to the next on the way it is driven. Bristles that the
    friction has fallen below, and that drive the shaft more than anything damps it, spring back at once.
    """
    bends = _bends(p, angle)
    if bends:
        found = slack if slack > 0.0 else least_damping(p)
        velocity = _balanced(p, s, push, found, angle, velocity, bristle, time, motor)
    line = resistance(p, s, angle, velocity, bristle, time, motor)
    least = FOLD * slack if slack > 0.0 else least_damping(p)
    if slack + line[2] < least and leans(p, line[3]):
        line = resistance(p, s, angle, velocity, s.direction * line[3] / p.presliding.stiffness, time, motor)
    torque, stiffness, viscous, friction = line
    if slack + viscous < least:
        viscous = least - slack
        if bends:
            torque = push - least * velocity
    return (push - torque) / (slack + viscous), torque, stiffness, viscous, friction


@kernel
def _bends(p, angle):
    """Whether what resists the shaft is no straight line of its velocity."""
    touches = p.stop_compliance.stiffness != 0.0 and (angle < p.lower_stop or angle > p.upper_stop)
    falls = p.static_friction.breakaway_torque != 0.0 and p.presliding.stiffness == 0.0
    grows = p.drag.quadratic != 0.0 or p.drag.cubic != 0.0
    return touches or falls or grows or p.residual.velocities > 1


@kernel
def _balanced(p, s, push, slack, angle, velocity, bristle, time, motor):
    """The velocity [rad/s] at which the torques balance: by tangents where it is near, else by a search."""
    stride, faded = STRIDE * p.static_friction.stribeck_velocity, STRIBECK_FADED * p.static_friction.stribeck_velocity
    now = velocity
    for _ in range(NEWTON):
        torque, _, viscous, _ = resistance(p, s, angle, now, bristle, time, motor)
        left = push - torque - (slack + viscous) * now
        if abs(left) <= NO_PUSH * p.own.torque:
            return now
        if not slack + viscous > 0.0:
            break
        after = now + left / (slack + viscous)
        if abs(after - velocity) > stride and min(abs(after), abs(velocity)) < faded:
            break
        now = after
    return _next_balance(p, s, push, slack, angle, velocity, bristle, time, motor)


@kernel
def _left_over(p, s, push, slack, angle, velocity, bristle, time, motor):
    """What no resistance takes up of the `push` at this `velocity` [N.m]."""
    torque, _, viscous, _ = resistance(p, s, angle, velocity, bristle, time, motor)
    return push - torque - (slack + viscous) * velocity


@kernel
def _next_balance(p, s, push, slack, angle, velocity, bristle, time, motor):
    """The velocity [rad/s] next to `velocity`, on the way it is driven, at which nothing is left over."""
    left = _left_over(p, s, push, slack, angle, velocity, bristle, time, motor)
    way, stride = math.copysign(1.0, left), abs(left) / slack
    faded = STRIBECK_FADED * p.static_friction.stribeck_velocity
    early = late = velocity
    at_early = at_late = left
    for _ in range(STRIDES):
        early, at_early = late, at_late
        if late * way < -faded:
            late = -way * faded
        elif late * way < faded:
            late += way * STRIDE * p.static_friction.stribeck_velocity
        else:
            late += way * stride
            stride *= 2.0
        at_late = _left_over(p, s, push, slack, angle, late, bristle, time, motor)
        if at_late * way <= 0.0:
            break
    for _ in range(SECANTS):
        middle = late - at_late * (late - early) / (at_late - at_early)
        if not min(early, late) < middle < max(early, late):
            middle = 0.5 * (early + late)
        left = _left_over(p, s, push, slack, angle, middle, bristle, time, motor)
        if abs(left) <= NO_PUSH * p.own.torque:
            return middle
        if left * way > 0.0:
            early, at_early, at_late = middle, left, 0.5 * at_late
        else:
            late, at_late, at_early = middle, left, 0.5 * at_early
    return late


@kernel
def bristle_after(p, s, friction, travel, velocity, motor):
    """Bristle deflection [rad] after the shaft has gone `travel` [rad] against `friction` [N.m] at first.

    At the end it has this `velocity` [rad/s], under the `motor` torque [N.m].
    """
    if p.presliding.stiffness == 0.0 or s.direction == 0.0:
        return s.presliding.bristle
    last = level(p, s.direction, velocity, s.angle + travel, motor)[0]
    return presliding.moved(p.presliding, s.presliding.bristle, friction, last, travel)


@kernel
def leaned(p, s, friction, bristle, travel):
    """Deflection [rad] of a `bristle` after a very short `travel` [rad] against this `friction` [N.m]."""
    if not leans(p, friction):
        return bristle
    return bristle + presliding.freedom(p.presliding, bristle, friction, s.direction) * travel


@kernel
def drift(p, s, step):
    """Let the shaft go on its own for a short `step` [s], up to a rigid stop; it rests where nothing drives it on."""
    motor = torque_at(p, s, s.motor_velocity, s.current)
    bristle = s.presliding.bristle
    velocity, _, stiffness, viscous, friction = settled(p, s, 0.0, 0.0, s.angle, s.velocity, bristle, s.time, motor)
    if velocity * s.direction <= 0.0:
        s.velocity = s.direction = 0.0
        return
    rate = stiffness / viscous
    travel = velocity * (step if abs(rate) * step < 1e-9 else -math.expm1(-rate * step) / rate)
    s.presliding.bristle = bristle_after(p, s, friction, travel, velocity, motor)
    s.velocity = velocity
    s.angle += travel
    if s.angle <= lower(p) or s.angle >= upper(p):
        s.angle = min(max(s.angle, lower(p)), upper(p))
        s.velocity = s.direction = 0.0
