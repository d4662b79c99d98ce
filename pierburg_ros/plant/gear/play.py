"""Rigid teeth with play between them: on the opening flank, on the closing flank, or parted.

Nordin, Gutman, Automatica 38 (2002) 1633-1649. The inertia is on the motor side; flanks meet without a rebound
and the shaft, which has no inertia, takes up the velocity of the motor.
"""

from __future__ import annotations

import math

from pierburg_ros.kernel import kernel
from pierburg_ros.plant.gear import shaft
from pierburg_ros.plant.gear.rigid import joined, slide_joined
from pierburg_ros.plant.motion.body import PARTED, balance, piece, torque_at
from pierburg_ros.plant.motion.events import (
    even,
    hold,
    loaded,
    lower,
    motor_onset,
    onset,
    shortest,
    slide,
    standing_time,
    upper,
)
from pierburg_ros.plant.motion.watch import due, put
from pierburg_ros.plant.torques.drive import relaxed_current

PLAY_TURN = 1e-4
"""Motor and shaft that both move on their own do so in turns of this share of the actuator's own time; at no-load speed
that is a ten-thousandth of the travel a turn."""


@kernel
def move(p, s, remaining):
    """Move for at most `remaining` [s], up to the next event; gives the time used."""
    if s.flank == 0:
        return _move_parted(p, s, remaining)
    if s.direction == 0.0:
        leaving = _leaving(p, s, s.current)
        if leaving != 0.0:
            _part(s, leaving)
            return 0.0
        s.direction = onset(p, s, s.time, s.current)
        if s.direction == 0.0:
            return hold(p, s, _staying(p, s, remaining))
    pull, friction = _pull(p, s, s.angle, s.velocity, s.current, s.presliding.bristle, s.time)
    if pull * s.flank < 0.0:
        _part(s, s.direction if s.velocity != 0.0 else 0.0)
        return 0.0
    line = joined(p, s)
    return slide_joined(p, s, line, _tearing_time(p, s, line, friction, remaining))


@kernel
def _part(s, direction):
    """Let the motor go on alone, in `direction`."""
    s.flank = 0
    s.motor_direction = direction


@kernel
def _leaving(p, s, amperes):
    """Direction in which a standing motor leaves its flank while the shaft stays; 0 if it does not."""
    direction = motor_onset(p, s, 0.0, amperes)
    if direction * s.flank < 0.0 and shaft.onset(p, s, 0.0, s.angle, s.time) == 0.0:
        return direction
    return 0.0


@kernel
def _staying(p, s, remaining):
    """How much of `remaining` [s] a standing motor stays on its flank: its current relaxes one way."""
    if p.armature_inductance.inductance == 0.0 or _leaving(p, s, relaxed_current(p, s, remaining)) == 0.0:
        return remaining
    early, late = 0.0, remaining
    for _ in range(40):
        middle = 0.5 * (early + late)
        if _leaving(p, s, relaxed_current(p, s, middle)) == 0.0:
            early = middle
        else:
            late = middle
    return late


@kernel
def _pull(p, s, angle, velocity, amperes, bristle, time):
    """What a flank, which can only push, bears for the shaft to slide with the motor, and the friction level [N.m]."""
    motor = torque_at(p, s, velocity, amperes)
    torque, _, viscous, friction = shaft.resistance(p, s, angle, velocity, bristle, time, motor)
    return torque + viscous * velocity, friction


@kernel
def _tearing_time(p, s, line, friction, remaining):
    """How long [s] the flanks stay together: not longer than one internal step is good for."""
    late = remaining if p.plain else min(remaining, max(s.step, shortest(p)))
    if not _tears(p, s, line, friction, late):
        return late
    early = 0.0
    while late - early > shortest(p):
        middle = 0.5 * (early + late)
        if _tears(p, s, line, friction, middle):
            late = middle
        else:
            early = middle
    return late


@kernel
def _tears(p, s, line, friction, step):
    travel, velocity, amperes = piece(p, s, step, s.velocity, line)
    bristle = shaft.bristle_after(p, s, friction, travel, velocity, torque_at(p, s, velocity, amperes))
    return _pull(p, s, s.angle + travel, velocity, amperes, bristle, s.time + step)[0] * s.flank < 0.0


@kernel
def _move_parted(p, s, remaining):
    if s.direction == 0.0:
        s.direction = shaft.onset(p, s, 0.0, s.angle, s.time)
    if s.motor_direction == 0.0:
        s.motor_direction = motor_onset(p, s, 0.0, s.current)
    if s.direction != 0.0:
        return _take_turns(p, s, min(remaining, PLAY_TURN * p.own.time))
    if loaded(p):
        remaining = _standing_shaft(p, s, remaining)
    if s.motor_direction == 0.0:
        return _wait(p, s, remaining)
    used, meets = _turn_motor(p, s, s.angle - p.backlash.gap, s.angle, remaining)
    if meets:
        _meet(p, s, 1 if s.motor_direction > 0.0 else -1)
    return used


@kernel
def _standing_shaft(p, s, remaining):
    """How much of `remaining` [s] the shaft stands under a load that changes, as its motor turns now."""
    step = even(p, s, remaining)
    if shaft.onset(p, s, 0.0, s.angle, s.time + step) == 0.0:
        return step
    early, late = 0.0, step
    while late - early > shortest(p):
        middle = 0.5 * (early + late)
        if shaft.onset(p, s, 0.0, s.angle, s.time + middle) == 0.0:
            early = middle
        else:
            late = middle
    return late


@kernel
def _turn_motor(p, s, low, high, remaining):
    """Turn the motor alone between `low` and `high` [rad]; gives the time used and whether it got to either."""
    angle, velocity, direction = s.motor_angle, s.motor_velocity, s.motor_direction
    line = balance(p, s, PARTED, angle, velocity, direction, s.time, s.current, s.presliding.motor_bristle)
    used, s.motor_angle, velocity, rests, meets = slide(
        p, s, PARTED, angle, velocity, direction, low, high, line, remaining
    )
    s.motor_velocity = velocity
    if rests:
        s.motor_direction = 0.0
    return used, meets


@kernel
def _take_turns(p, s, step):
    """Motor and shaft on their own for a short `step` [s]; the shaft gives way to the flanks. Gives the time used."""
    began, angle = s.time, s.angle
    if s.motor_direction == 0.0:
        used = _wait(p, s, step)
    else:
        used, _ = _turn_motor(p, s, -math.inf, math.inf, step)
    shaft.drift(p, s, used)
    apart = s.angle - s.motor_angle
    if apart <= 0.0:
        _bring_together(p, s, s.motor_angle, 1)
    elif apart >= p.backlash.gap:
        _bring_together(p, s, s.motor_angle + p.backlash.gap, -1)
    while due(p, s, s.time):
        put(p, s, angle + (s.angle - angle) * (s.ahead.time[s.sampled] - began) / used, s.velocity)
    return used


@kernel
def _bring_together(p, s, angle, flank):
    """Put the shaft on the flank that it has reached, at `angle` [rad], or the motor there if a stop is in the way."""
    s.angle = min(max(angle, lower(p)), upper(p))
    s.motor_angle += s.angle - angle
    _meet(p, s, flank)


@kernel
def _wait(p, s, remaining):
    """Let the motor stand with its teeth parted, until the current sets it moving: only that and the time change."""
    step = remaining
    if p.armature_inductance.inductance != 0.0:
        step = standing_time(p, s, PARTED, remaining)
        s.current = relaxed_current(p, s, step)
    s.time += step
    return step


@kernel
def _meet(p, s, flank):
    """The motor is on a flank: the shaft takes up its velocity unless a stop is in the way."""
    s.flank = flank
    blocked = (s.angle >= upper(p) and flank > 0) or (s.angle <= lower(p) and flank < 0)
    s.velocity = 0.0 if blocked else s.motor_velocity
    s.motor_velocity = s.velocity
    s.direction = math.copysign(1.0, s.velocity) if s.velocity != 0.0 else 0.0
    s.motor_direction = 0.0
