"""The balance of torques on one inertia, and its motion over one linear piece."""

from __future__ import annotations

import math
from typing import NamedTuple

from pierburg_ros.effects import presliding
from pierburg_ros.kernel import kernel
from pierburg_ros.plant.motion.linear_piece import alike, responses, turning_time
from pierburg_ros.plant.motion.third_order import third_responses
from pierburg_ros.plant.motion.watch import due, put, slid
from pierburg_ros.plant.torques.drive import motor_torque
from pierburg_ros.plant.torques.friction import damping, leans, level
from pierburg_ros.plant.torques.load import blurred, load, outside, ripple, ripple_slope

JOINED = 0
"""Motor and shaft move as one."""
PARTED = 1
"""The motor alone, its teeth between the flanks or elastic."""


STILL_VELOCITY = 6e-11
"""Swings of the velocity smaller than this share of the no-load speed are none."""
UNMOVED = 1e-11
"""Swings of the angle smaller than this share of the travel are none: the rounding of an angle is only a thousand times
smaller, and a stiff gear that swings within it never comes to an end. A step may be wrong by far more."""


class Line(NamedTuple):
    """Net torque on a body as a straight line: force - slope dw - stiffness dangle + rate dt + gain dT_m.

    N.m, N.m.s/rad, N.m/rad, N.m/s, 1.
    """

    force: float
    slope: float
    stiffness: float
    rate: float
    gain: float


@kernel
def torque_at(p, s, velocity, amperes):
    """Motor torque [N.m] at motor-side `velocity` [rad/s], or with `amperes` [A] where the winding is inductive."""
    if p.armature_inductance.inductance != 0.0:
        return p.gear_ratio * p.torque_constant * amperes
    return motor_torque(p, s, velocity)


@kernel
def electrical_slope(p, s):
    """How the motor torque falls with velocity at once [N.m.s/rad]: the back-EMF, 0 behind an inductance."""
    return 0.0 if p.armature_inductance.inductance != 0.0 else s.braking


@kernel
def share(p, kind):
    """Share of the friction that the body of this kind carries."""
    if kind == JOINED:
        return 1.0
    return p.backlash.motor_friction_share if p.backlash.gap > 0.0 else 0.0


@kernel
def balance(p, s, kind, angle, velocity, direction, time, amperes, bristle):
    """Net torque on the sliding body, as the straight line that touches it here.

    Equation (6) of the paper, J d2(angle)/dt2 = k_g k_m i - k_s angle - preload - friction.
    """
    motor = torque_at(p, s, velocity, amperes)
    part = share(p, kind)
    friction = by_velocity = by_angle = by_torque = 0.0
    if part > 0.0:
        friction, by_velocity, by_angle, by_torque = level(p, direction, velocity, angle, motor)
    over, by_speed = damping(p, direction, velocity)
    viscous, steeper = part * over, part * by_speed
    pulled = stiffness = by_load_velocity = rate = 0.0
    if kind == JOINED:
        pulled, stiffness, by_load_velocity, rate = load(p, angle, velocity, outside(p, s, time))
    if p.cogging_torque.amplitude != 0.0 and not blurred(p, velocity):
        lead = s.motor_angle - s.angle if kind == JOINED else 0.0
        pulled += ripple(p, angle + lead)
        stiffness += ripple_slope(p, angle + lead)
    if leans(p, friction):
        held, viscous_too, by_path, by_level = presliding.bearing(p.presliding, bristle, friction, direction, velocity)
        force = motor - pulled - part * held - (part * viscous_too + viscous) * velocity
        steeper += part * (viscous_too + by_level * by_velocity)
        stiffness += part * (by_path + by_level * by_angle)
        gain = 1.0 - part * by_level * by_torque
        return Line(force, electrical_slope(p, s) * gain + steeper + by_load_velocity, stiffness, -rate, gain)
    gain = 1.0 - direction * part * by_torque
    force = motor - pulled - part * direction * friction - viscous * velocity
    slope = electrical_slope(p, s) * gain + by_load_velocity + steeper + part * direction * by_velocity
    return Line(force, slope, stiffness + part * direction * by_angle, -rate, gain)


@kernel
def piece(p, s, step, velocity, line):
    """Travel [rad], velocity [rad/s] and current [A] after `step` [s] on the straight line."""
    if p.armature_inductance.inductance != 0.0 and s.closed_bridge:
        return _inductive_piece(p, s, step, velocity, line)
    slope, impulse, integral, twice, _ = _second(s, line.slope * p.agility, line.stiffness * p.agility, step)
    push = (line.force + line.slope * velocity) * p.agility
    ramp = line.rate * p.agility
    travel = velocity * impulse + push * integral + ramp * twice
    return travel, velocity * slope + push * impulse + ramp * integral, s.current


@kernel
def _second(s, damping, stiffness, step):
    """Responses of x'' + damping x' + stiffness x, from the state where they are those of the last step."""
    piece = s.piece
    if piece.order != 2 or piece.damping != damping or piece.stiffness != stiffness or not alike(step, piece.step):
        piece.order, piece.damping, piece.stiffness, piece.step = 2, damping, stiffness, step
        slope, impulse, integral, twice, thrice = responses(damping, stiffness, step)
        piece.slope, piece.impulse, piece.integral = slope, impulse, integral
        piece.twice, piece.thrice = twice, thrice
    return piece.slope, piece.impulse, piece.integral, piece.twice, piece.thrice


@kernel
def _third(s, damping, stiffness, pull, step):
    """Responses of x''' + damping x'' + stiffness x' + pull x, from the state likewise."""
    piece = s.piece
    same = piece.order == 3 and piece.damping == damping and piece.stiffness == stiffness and piece.pull == pull
    if not same or not alike(step, piece.step):
        piece.order, piece.damping, piece.stiffness, piece.pull, piece.step = 3, damping, stiffness, pull, step
        bend, slope, value, once, twice = third_responses(damping, stiffness, pull, step)
        piece.slope, piece.impulse, piece.integral = bend, slope, value
        piece.twice, piece.thrice = once, twice
    return piece.slope, piece.impulse, piece.integral, piece.twice, piece.thrice


@kernel
def _inductive(p, s, velocity, line):
    """Body and winding as one, x''' + damping x'' + stiffness x' + pull x = push + ramp t: these five.

    From J w' = gain K i - slope w - stiffness x + rate t - rest and L i' = u - R i - K w.
    """
    both = p.total_inertia * p.armature_inductance.inductance
    constant = p.gear_ratio * p.torque_constant
    damping = s.resistance / p.armature_inductance.inductance + line.slope * p.agility
    stiffness = (s.resistance * line.slope + line.gain * constant * constant) / both
    stiffness += line.stiffness * p.agility
    rest = line.gain * constant * s.current - line.slope * velocity - line.force
    push = (line.gain * constant * s.voltage - s.resistance * rest) / both + line.rate * p.agility
    return damping, stiffness, s.resistance * line.stiffness / both, push, s.resistance * line.rate / both


@kernel
def _inductive_piece(p, s, step, velocity, line):
    """The same with a current that lags: one piece of third order."""
    damping, stiffness, pull, push, ramp = _inductive(p, s, velocity, line)
    bend, slope, value, once, twice = _third(s, damping, stiffness, pull, step)
    started = line.force * p.agility
    travel = velocity * (slope + damping * value) + started * value + push * once + ramp * twice
    ended = velocity * (bend + damping * slope) + started * slope + push * value + ramp * once
    swinging = -velocity * (stiffness * slope + pull * value)
    acceleration = swinging + started * bend + push * slope + ramp * value
    change = p.total_inertia * acceleration - after(p, line, step, travel, ended - velocity, 0.0)
    return travel, ended, s.current + change / (line.gain * p.gear_ratio * p.torque_constant)


@kernel
def turn(p, s, velocity, line):
    """Longest step [s] within which the velocity on the straight line passes zero once at most."""
    acceleration = line.force * p.agility
    if p.armature_inductance.inductance == 0.0 or not s.closed_bridge:
        damping, stiffness = line.slope * p.agility, line.stiffness * p.agility
        if stiffness <= 0.25 * damping * damping:
            return math.inf
        jerk = line.rate * p.agility - damping * acceleration - stiffness * velocity
        return _turn(p, damping, stiffness, acceleration, jerk)
    damping, stiffness, _, push, _ = _inductive(p, s, velocity, line)
    square = stiffness - 0.25 * damping * damping
    if square <= 0.0:
        return math.inf
    settling = push / stiffness - velocity
    swing = acceleration - 0.5 * damping * settling
    if settling * settling + swing * swing / square < (velocity + settling) ** 2:
        return math.inf
    return _turn(p, damping, stiffness, acceleration, push - stiffness * velocity - damping * acceleration)


@kernel
def _turn(p, damping, stiffness, acceleration, jerk):
    """Time [s] to the next turn of a velocity that swings; infinite where it hardly does."""
    square = stiffness - 0.25 * damping * damping
    least = max(STILL_VELOCITY / p.own.time, UNMOVED * math.sqrt(square)) * p.own.angle * square
    if abs(acceleration) * math.sqrt(square) + abs(jerk) < least:
        return math.inf
    return turning_time(damping, stiffness, acceleration, jerk)


@kernel
def after(p, line, step, travel, change, amperes):
    """Net torque [N.m] on the line after `step` [s], `travel` [rad], and `change` [rad/s] and `amperes` [A] more."""
    electric = line.gain * p.gear_ratio * p.torque_constant * amperes
    return line.force + electric - line.slope * change - line.stiffness * travel + line.rate * step


@kernel
def curvature(p, step, missed):
    """How the push bends [rad/s^4] that has come up to `missed` [N.m] over a `step` [s].

    What a touching line misses grows with the square of time (the second stage of exprb32, Hochbruck, Ostermann, Acta
    Numerica 19 (2010) 209-286).
    """
    return 2.0 * missed * p.agility / (step * step)


@kernel
def seen(p, s, angle, velocity, line, bend, step):
    """Put the samples within a `step` [s] on the straight line, which bends by `bend` [rad/s^4]."""
    if p.armature_inductance.inductance == 0.0 or not s.closed_bridge:
        push = (line.force + line.slope * velocity) * p.agility
        linear = line.slope * p.agility, line.stiffness * p.agility, push, line.rate * p.agility, bend
        slid(p, s, linear, angle, velocity, step)
        return
    while due(p, s, s.time + step):
        travel, now, _ = piece(p, s, s.ahead.time[s.sampled] - s.time, velocity, line)
        put(p, s, angle + travel, now)


@kernel
def error(p, s, line, step, missed):
    """Angle [rad] by which a step may be wrong that has `missed` this torque [N.m] at its end."""
    resisting = line.slope
    if p.armature_inductance.inductance != 0.0:
        resisting += line.gain * s.braking
    response = step * p.agility
    if abs(resisting) * response > 1.0:
        response = 1.0 / abs(resisting)
    return 0.5 * abs(missed) * response * step
