"""One body between its stops: held, sliding, and the events that end either.

A sliding step is an exponential Rosenbrock step (Hochbruck, Ostermann, Acta Numerica 19 (2010) 209-286): exact
where the balance is linear, and shortened until what the linear form leaves out moves the body by less than
`STEP_TOLERANCE` where it is not, which also finds kinks and jumps.
"""

from __future__ import annotations

import math

from pierburg_ros.effects import external_load, position_dependent_friction, presliding
from pierburg_ros.kernel import kernel
from pierburg_ros.plant.motion.body import (
    JOINED,
    PARTED,
    after,
    balance,
    curvature,
    error,
    piece,
    seen,
    share,
    torque_at,
    turn,
)
from pierburg_ros.plant.motion.watch import due
from pierburg_ros.plant.torques import friction
from pierburg_ros.plant.torques.drive import relaxed_current
from pierburg_ros.plant.torques.load import blurred, load, outside, ripple

STEP_TOLERANCE = 2e-7
"""Error that an internal step may make, as a share of the actuator's travel, plus `SHARE` of its own; of the valve's
Hall voltage it is 0.8 microvolt."""
SHARE = 1e-4
"""See `STEP_TOLERANCE`."""
FURTHEST = 0.01
"""Share of the actuator's travel above which a step may not be wrong by more."""
CORRECTED = 10.0
"""Error that a step may show before what its line missed is put right, as a multiple of `STEP_TOLERANCE` and `SHARE`.
Measured: with it 18 models of the valve, 60 s at 500 Hz each, are off by 0.2 mV at most from runs with a ten-thousandth
of the tolerance, as they were without putting right."""
FASTER = 3.0
"""Most by which a step may be longer than the one before."""
EASY = (0.8 / FASTER) ** 3
"""Error over the allowed one up to which the next step is `FASTER` times as long. Derived: errors go with the cube of a
step, and 0.8 of the longest one that would do is taken."""
SHORTEST_STEP = 1e-7
"""Internal steps are not shortened below this share of the actuator's own time; 10 ns for the valve."""
SAME_MOMENT = 1e-11
"""Share of the actuator's own time within which a moment is found."""
LOAD_STEP = 0.02
"""Longest step of a shaft that stands, as a share of the period of a pulsating load."""
GROWTH = 30.0
"""Largest exponent a step may grow by where friction falls with velocity."""


@kernel
def shortest(p):
    """Length [s] below which internal steps are not shortened."""
    return SHORTEST_STEP * p.own.time


@kernel
def least(p, line):
    """Length [s] below which a sliding step is not shortened: where the motion runs away, not beyond growth by e."""
    if line.slope >= 0.0 and line.stiffness >= 0.0:
        return shortest(p)
    half, stiffness = 0.5 * line.slope * p.agility, line.stiffness * p.agility
    square = half * half - stiffness
    if square <= 0.0:
        return min(shortest(p), -1.0 / half)
    root = math.sqrt(square)
    growth = root - half if half <= 0.0 else -stiffness / (root + half)
    return min(shortest(p), 1.0 / growth)


@kernel
def lower(p):
    """The rigid lower stop [rad]; none where stops are elastic."""
    return p.lower_stop if p.stop_compliance.stiffness == 0.0 else -math.inf


@kernel
def upper(p):
    """The rigid upper stop [rad]; none where stops are elastic."""
    return p.upper_stop if p.stop_compliance.stiffness == 0.0 else math.inf


@kernel
def onset(p, s, time, amperes):
    """Direction in which motor and shaft, standing as one, begin to move: +1, -1, or 0 where friction holds."""
    motor, net = _standing(p, s, time, amperes)
    return off_stops(p, friction.breakaway(p, 1.0, net, s.angle, motor, s.presliding.bristle), s.angle)


@kernel
def _standing(p, s, time, amperes):
    """Motor torque and net torque [N.m] on motor and shaft that stand as one."""
    motor = torque_at(p, s, 0.0, amperes)
    return motor, motor - load(p, s.angle, 0.0, outside(p, s, time))[0] - ripple(p, s.motor_angle)


@kernel
def settle(p, s):
    """Let gear and bristles lean as the torques in force have left them where the shaft stands or moves evenly.

    The gear is twisted by the motor, and off the stops the bristles of a standing shaft bear what is left, as far as
    they can. With play between the teeth both are left alone: which flank touches is not known.
    """
    if p.backlash.gap != 0.0:
        return
    if p.gear_compliance.stiffness != 0.0:
        twisting = torque_at(p, s, s.velocity, s.current) - ripple(p, s.motor_angle)
        s.motor_angle = s.angle + twisting / p.gear_compliance.stiffness
    motor, net = _standing(p, s, s.time, s.current)
    direction = math.copysign(1.0, net)
    if p.presliding.stiffness != 0.0 and s.velocity == 0.0 and off_stops(p, direction, s.angle) != 0.0:
        held = friction.level(p, direction, 0.0, s.angle, motor)[0]
        s.presliding.bristle = s.presliding.motor_bristle = min(max(net, -held), held) / p.presliding.stiffness


@kernel
def undisturbed(p, s):
    """How long [s] motor and shaft, standing as one, stand whatever the load from outside does by then.

    It takes a time to use up what friction, or a stop, has to spare.
    """
    if not loaded(p):
        return math.inf
    motor, net = _standing(p, s, s.time, s.current)
    push, held = friction.standing(p, 1.0, net, s.angle, motor, s.presliding.bristle)
    spare = held - abs(push) if abs(push) <= held else abs(push)
    until = external_load.next_switch(p.external_load, s.time) - s.time
    return min(until, external_load.taking(p.external_load, spare))


@kernel
def off_stops(p, direction, angle):
    """`direction`, or 0 where at this `angle` [rad] a rigid stop is in the way."""
    if (direction > 0.0 and angle >= upper(p)) or (direction < 0.0 and angle <= lower(p)):
        return 0.0
    return direction


@kernel
def motor_onset(p, s, tooth, amperes):
    """Direction in which the standing motor begins to move by itself, against `tooth` [N.m]; 0 where it is held."""
    motor = torque_at(p, s, 0.0, amperes)
    net = motor - tooth - ripple(p, s.motor_angle)
    return friction.breakaway(p, share(p, PARTED), net, s.motor_angle, motor, s.presliding.motor_bristle)


@kernel
def loaded(p):
    """Whether a load from outside changes with time."""
    return p.external_load.torque != 0.0 or p.external_load.amplitude != 0.0


@kernel
def even(p, s, remaining):
    """How much of `remaining` [s] a load from outside is looked at in one go while the shaft stands."""
    step = min(remaining, external_load.next_switch(p.external_load, s.time) - s.time)
    if p.external_load.frequency > 0.0:
        step = min(step, LOAD_STEP / p.external_load.frequency)
    return min(max(step, shortest(p)), remaining)


@kernel
def hold(p, s, remaining):
    """Stand still for `remaining` [s] or until something sets the shaft moving; gives the time used."""
    inductive = p.armature_inductance.inductance != 0.0
    step = even(p, s, remaining) if loaded(p) else remaining
    sure = 0.0 if inductive else min(undisturbed(p, s), remaining)
    step = sure if sure >= step else standing_time(p, s, JOINED, step)
    if inductive:
        s.current = relaxed_current(p, s, step)
    s.time += step
    return step


@kernel
def standing_time(p, s, kind, step):
    """How much of `step` [s] it stands: the current relaxes one way, so what does not move it at the end never did."""
    if _onset_after(p, s, kind, step) == 0.0:
        return step
    early, late = 0.0, step
    for _ in range(40):
        middle = 0.5 * (early + late)
        if _onset_after(p, s, kind, middle) == 0.0:
            early = middle
        else:
            late = middle
    return late


@kernel
def _onset_after(p, s, kind, step):
    amperes = relaxed_current(p, s, step) if p.armature_inductance.inductance != 0.0 else 0.0
    if kind == PARTED:
        return motor_onset(p, s, 0.0, amperes)
    return onset(p, s, s.time + step, amperes)


@kernel
def slide(p, s, kind, angle, velocity, direction, low, high, line, remaining):
    """Slide for `remaining` [s] or to the next event: time used, angle, velocity, whether at rest, whether at a limit.

    The event is the velocity passing zero, or the angle reaching `low` or `high` [rad], where it stays. `line` is the
    balance of torques now. What it is seen to miss at the end is added, as it grows with the square of time; the step
    is judged by what that leaves.
    """
    step, bend = min(_first_step(p, s, line.slope, remaining), turn(p, s, velocity, line)), 0.0
    furthest, enough = finest(p, angle, velocity), least(p, line)
    while True:
        travel, ended, amperes = piece(p, s, step, velocity, line)
        while ended == 0.0 and travel != 0.0 and step > shortest(p):  # died away: whether it turned round is not seen
            step *= 0.5
            travel, ended, amperes = piece(p, s, step, velocity, line)
        rests = False
        if ended * direction < 0.0:
            step = _moment(p, s, step, velocity, line, math.nan)
            travel, ended, amperes = piece(p, s, step, velocity, line)
            ended, rests = 0.0, True
        limit = high if direction > 0.0 else low
        stops = (angle + travel - limit) * direction >= 0.0
        if stops:
            step = _moment(p, s, step, velocity, line, limit - angle)
            travel, ended, amperes = piece(p, s, step, velocity, line)
        if p.plain:
            break
        if abs(travel) > furthest and step > enough:
            step = max(0.9 * step * furthest / abs(travel), enough)
            continue
        missed = _missed(p, s, kind, angle, velocity, direction, step, travel, ended, amperes, line)
        excess = beyond(p, error(p, s, line, step, missed), travel)
        grows = -line.slope * p.agility * step > 1.0
        if s.piece.order == 2 and not rests and not stops and not grows:
            curved = curvature(p, step, missed)
            more, faster = curved * s.piece.thrice, curved * s.piece.twice
            if (ended + faster) * direction > 0.0 and (angle + travel + more - limit) * direction < 0.0:
                if excess > EASY:
                    # whether it grew so is seen in the middle, where a quarter of it should be missed
                    bent = missed - 4.0 * _missed_midway(p, s, kind, angle, velocity, direction, step, line)
                    excess = max(excess / CORRECTED, beyond(p, error(p, s, line, step, bent), travel))
                travel, ended, bend = travel + more, ended + faster, curved
        if not excess > 1.0 or step <= enough:
            s.step = next_step(s.step, step, remaining, excess)
            break
        step, bend = max(shorter(step, excess), enough), 0.0
    _remember(p, s, kind, direction, angle, velocity, travel, ended, amperes)
    if kind == JOINED and due(p, s, s.time + step):
        seen(p, s, angle, velocity, line, bend, step)
    s.current = amperes
    s.time += step
    return step, (limit if stops else angle + travel), ended, rests, stops


@kernel
def _remember(p, s, kind, direction, angle, velocity, travel, ended, amperes):
    """Leave the bristles of the contact as the motion leaves them."""
    if p.presliding.stiffness == 0.0:
        return
    if kind == JOINED:
        s.presliding.bristle = _bristle(p, s, s.presliding.bristle, direction, angle, velocity, travel, ended, amperes)
        s.presliding.motor_bristle = s.presliding.bristle
    else:
        s.presliding.motor_bristle = _bristle(
            p, s, s.presliding.motor_bristle, direction, angle, velocity, travel, ended, amperes
        )


@kernel
def _first_step(p, s, slope, remaining):
    step = remaining
    if not p.plain:
        step = min(step, max(s.step, shortest(p)))
        if slope < 0.0:
            step = min(step, -GROWTH * p.total_inertia / slope)
        if loaded(p):
            ahead = external_load.next_switch(p.external_load, s.time) - s.time
            step = min(step, max(ahead, shortest(p)))
            if p.external_load.frequency > 0.0:
                step = min(step, 0.1 / p.external_load.frequency)
    return step


@kernel
def finest(p, angle, velocity):
    """Travel [rad] from `angle` at `velocity` [rad/s] within which no torque turns more than once."""
    turns = min(p.finest, position_dependent_friction.bends_within(p.position_dependent_friction, angle))
    return turns if blurred(p, velocity) else min(turns, p.ripple)


@kernel
def allowed(p, travel):
    """Error [rad] that a step of this `travel` [rad] may make, so that samples within it are as good as at its end."""
    return STEP_TOLERANCE * p.own.angle + SHARE * min(abs(travel), FURTHEST * p.own.angle)


@kernel
def beyond(p, wrong, travel):
    """Error of a step over the one that it may make; infinite where the step led beyond all numbers."""
    excess = wrong / allowed(p, travel)
    return math.inf if math.isnan(excess) else excess


@kernel
def next_step(before, step, remaining, excess):
    """Length [s] to try next after an accepted `step`, `excess` being its error over the allowed one."""
    if step == remaining and before >= FASTER * step:
        return before
    grown = FASTER * step
    if not excess < EASY:
        grown = 0.8 * step * excess ** (-1.0 / 3.0)
    return max(grown, before) if step == remaining else grown


@kernel
def shorter(step, excess):
    """Length [s] to try instead of a `step` whose error is `excess` times the allowed one."""
    return step * max(0.05, 0.8 * excess ** (-1.0 / 3.0))


@kernel
def _missed(p, s, kind, angle, velocity, direction, step, travel, ended, amperes, line):
    """Torque [N.m] that the straight line misses at the end of the step."""
    bristle = 0.0
    if p.presliding.stiffness != 0.0:
        bristle = s.presliding.bristle if kind == JOINED else s.presliding.motor_bristle
        bristle = _bristle(p, s, bristle, direction, angle, velocity, travel, ended, amperes)
    actual = balance(p, s, kind, angle + travel, ended, direction, s.time + step, amperes, bristle).force
    return actual - after(p, line, step, travel, ended - velocity, amperes - s.current)


@kernel
def _missed_midway(p, s, kind, angle, velocity, direction, step, line):
    """Torque [N.m] that the straight line misses in the middle of the step.

    After a jump of the voltage the motor settles within a small part of a step, and what is missed is there at once.
    """
    travel, ended, amperes = piece(p, s, 0.5 * step, velocity, line)
    return _missed(p, s, kind, angle, velocity, direction, 0.5 * step, travel, ended, amperes, line)


@kernel
def _bristle(p, s, bristle, direction, angle, velocity, travel, ended, amperes):
    before = friction.level(p, direction, velocity, angle, torque_at(p, s, velocity, s.current))[0]
    after = friction.level(p, direction, ended, angle + travel, torque_at(p, s, ended, amperes))[0]
    return presliding.moved(p.presliding, bristle, before, after, travel)


@kernel
def _moment(p, s, step, velocity, line, target):
    """When, within `step`, the travel reaches `target` [rad], or (target not a number) the velocity zero.

    Illinois variant of the secant method (Dowell, Jarratt, BIT 11 (1971) 168-174).
    """
    early, late = 0.0, step
    at_late = _miss(p, s, late, velocity, line, target)
    at_early = velocity if math.isnan(target) else -target
    if at_early == 0.0:
        if not math.isnan(target):
            return 0.0
        at_early = -at_late
    kept = 0
    for _ in range(80):
        if late - early <= SAME_MOMENT * p.own.time or at_late == 0.0:
            break
        middle = late - at_late * (late - early) / (at_late - at_early)
        if not early < middle < late:
            middle = 0.5 * (early + late)
        at_middle = _miss(p, s, middle, velocity, line, target)
        if (at_middle > 0.0) == (at_late > 0.0):
            late, at_late = middle, at_middle
            at_early *= 0.5 if kept == -1 else 1.0
            kept = -1
        else:
            early, at_early = middle, at_middle
            at_late *= 0.5 if kept == 1 else 1.0
            kept = 1
    return late


@kernel
def _miss(p, s, step, velocity, line, target):
    travel, ended, _ = piece(p, s, step, velocity, line)
    return ended if math.isnan(target) else travel - target
