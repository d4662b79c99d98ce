"""Teeth that give: the motor with its inertia on one side of a spring and damper, the shaft without on the other.

The motor is one linear piece under the torque of the teeth; the shaft, of first order, follows its travel. The
step is shortened until what the linear piece leaves out at its end misleads the motor by less than is allowed.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from pierburg_ros.effects import presliding
from pierburg_ros.kernel import kernel
from pierburg_ros.plant.gear import shaft
from pierburg_ros.plant.gear.teeth import felt, given_way, holding, push, shaft_velocity
from pierburg_ros.plant.motion.body import PARTED, UNMOVED, Line, after, balance, error, piece, share, torque_at, turn
from pierburg_ros.plant.motion.events import (
    CORRECTED,
    LOAD_STEP,
    SAME_MOMENT,
    beyond,
    finest,
    least,
    lower,
    motor_onset,
    next_step,
    shorter,
    shortest,
    upper,
)
from pierburg_ros.plant.motion.watch import due, put
from pierburg_ros.plant.torques.drive import relaxed_current
from pierburg_ros.plant.torques.friction import level

UNTOUCHED = 1e-3
"""Share of the time in which teeth and back-EMF stop the motor within which it counts as no faster."""
TINY = 1e-300
"""Damping [N.m.s/rad] in place of none."""
END_FOUND = 1e-6
"""Share of a travel within which its end is found where no straight line holds."""
DOUBLINGS = 60
"""Steps of the search for such an end outwards."""


class Sides(NamedTuple):
    """Where a step has brought the two sides: travel [rad], velocity [rad/s], current [A], teeth [N.m].

    And what it missed of the resistance [N.m], by which angle it may be wrong, and how far their bristles lean [rad].
    """

    motor_travel: float
    motor_velocity: float
    current: float
    travel: float
    velocity: float
    teeth: float
    missed: float
    wrong: float
    bristle: float
    motor_bristle: float


@kernel
def _follow(s, grip, step, motor_velocity, rate, faded):
    """Travel of the shaft [rad] and its velocity [rad/s] after `step` [s] of the motor turning evenly.

    It follows at `rate` [1/s], by which its start has `faded`.
    """
    start = shaft_velocity(s, grip, motor_velocity)
    if s.direction == 0.0 or abs(rate) * step < 1e-9:
        return start * step, start
    even = grip.stiffness * motor_velocity / (grip.stiffness + grip.bending)
    return even * step - (start - even) * faded / rate, start + (start - even) * faded


@kernel
def _missed(grip, reached, moved, velocity):
    """Resistance [N.m] of the shaft that the straight line misses at the end of a step."""
    missed = reached.resisting - grip.resisting - grip.bending * moved
    return missed + (reached.viscous - grip.viscous) * velocity


@kernel
def grown(reach, faded):
    """Mean over a step of exp(-reach (1 - t)) t^2, t from 0 to 1; `faded` is exp(-reach) - 1.

    So much of the travel does a resistance add that has come up with the square of time.
    """
    if abs(reach) < 0.03:
        return 1.0 / 3.0 - reach * (1.0 / 12.0 - reach / 60.0)
    return (reach - 2.0 * (faded + reach) / reach) / (reach * reach)


@kernel
def _astray(grip, rate, step, missed):
    """Angle [rad] by which the shaft may be wrong that has `missed` this resistance [N.m] at the end."""
    memory = min(step, 1.0 / rate) if rate > 0.0 else step
    return 0.5 * abs(missed) * grip.mobility * memory


@kernel
def _motor(p, s, angle, velocity, time, amperes, bristle):
    """Net torque on the motor but for the teeth, as a straight line."""
    return balance(p, s, PARTED, angle, velocity, s.motor_direction, time, amperes, bristle)


@kernel
def _motor_stands(p, s):
    return share(p, PARTED) > 0.0 and s.motor_direction == 0.0


@kernel
def _motor_bristle(p, s, travel):
    if p.presliding.stiffness == 0.0 or travel == 0.0 or share(p, PARTED) == 0.0:
        return s.presliding.motor_bristle
    motor = torque_at(p, s, s.motor_velocity, s.current)
    friction = level(p, s.motor_direction, s.motor_velocity, s.motor_angle, motor)[0]
    return presliding.moved(p.presliding, s.presliding.motor_bristle, friction, friction, travel)


@kernel
def _line(p, s):
    """The grip on the shaft now, and the net torque on the motor as a straight line, shaft following."""
    twist = s.motor_angle - s.angle
    motor = torque_at(p, s, s.motor_velocity, s.current)
    grip = holding(p, s, twist, s.motor_velocity, s.angle, s.velocity, s.presliding.bristle, s.time, motor)
    free = _motor(p, s, s.motor_angle, s.motor_velocity, s.time, s.current, s.presliding.motor_bristle)
    stiffness, damping = felt(s, grip)
    force = free.force - push(grip, s.motor_velocity, shaft_velocity(s, grip, s.motor_velocity))
    return grip, Line(force, free.slope + damping, free.stiffness + stiffness, free.rate, free.gain)


@kernel
def _motor_piece(p, s, line, step):
    """Travel [rad], velocity [rad/s] and current [A] of the motor after `step` [s]."""
    if not _motor_stands(p, s):
        return piece(p, s, step, s.motor_velocity, line)
    if p.armature_inductance.inductance == 0.0:
        return 0.0, 0.0, s.current
    return 0.0, 0.0, relaxed_current(p, s, step)


@kernel
def _trial(p, s, grip, line, step):
    """Where `step` [s] would bring the two sides."""
    travel, ended, amperes = _motor_piece(p, s, line, step)
    rate, faded = 0.0, 0.0
    if s.direction != 0.0:
        rate = (grip.stiffness + grip.bending) * grip.mobility
        faded = math.expm1(-rate * step)
    moved, velocity = _follow(s, grip, step, travel / step, rate, faded)
    time = s.time + step
    twist = s.motor_angle + travel - s.angle - moved
    motor = torque_at(p, s, ended, amperes)
    bristle = shaft.bristle_after(p, s, grip.friction, moved, velocity, motor)
    reached = holding(p, s, twist, ended, s.angle + moved, velocity, bristle, time, motor)
    missed, turned = 0.0, False
    if s.direction != 0.0:
        missed = _missed(grip, reached, moved, velocity)
        more = -missed * grip.mobility * step * grown(rate * step, faded)
        turned = moved * (moved + more) < 0.0
        moved += more
        bristle = shaft.leaned(p, s, reached.friction, bristle, more)
        reached = given_way(reached, more)
    velocity = shaft_velocity(s, reached, ended)
    teeth = push(reached, ended, velocity)
    motor_bristle = _motor_bristle(p, s, travel)
    wrong = 0.0
    if not _motor_stands(p, s):
        actual = _motor(p, s, s.motor_angle + travel, ended, time, amperes, motor_bristle).force - teeth
        expected = after(p, line, step, travel, ended - s.motor_velocity, amperes - s.current)
        wrong = error(p, s, line, step, actual - expected)
    if s.direction != 0.0:
        wrong += math.inf if turned else _astray(grip, rate, step, missed) / CORRECTED
    return Sides(travel, ended, amperes, moved, velocity, teeth, missed, wrong, bristle, motor_bristle)


@kernel
def _enough(p, s, grip, line):
    """Length [s] below which a step is not shortened: where either side runs away, not beyond growth by e."""
    rate = (grip.stiffness + grip.bending) * grip.mobility
    enough = least(p, line)
    return min(enough, -1.0 / rate) if s.direction != 0.0 and rate < 0.0 else enough


@kernel
def _bent(p, s, grip, sides, step):
    """The same where no straight line holds in the shortest step: the shaft by Euler's implicit rule, however stiff.

    The travel is that at whose end the torques balance at the velocity which leads there.
    """
    _, start = _arrived(p, s, grip, sides, step, 0.0, s.velocity)
    early, late = 0.0, step * start
    for _ in range(DOUBLINGS):
        _, velocity = _arrived(p, s, grip, sides, step, late, start)
        if (step * velocity - late) * late <= 0.0:
            break
        early, late = late, 2.0 * late
    while abs(late - early) > max(UNMOVED * p.own.angle, END_FOUND * abs(late)):
        middle = 0.5 * (early + late)
        _, velocity = _arrived(p, s, grip, sides, step, middle, start)
        if (step * velocity - middle) * late > 0.0:
            early = middle
        else:
            late = middle
    reached, velocity = _arrived(p, s, grip, sides, step, late, start)
    teeth, motor = push(reached, sides.motor_velocity, velocity), torque_at(p, s, sides.motor_velocity, sides.current)
    bristle = shaft.bristle_after(p, s, grip.friction, late, velocity, motor)
    ended = sides.motor_travel, sides.motor_velocity, sides.current
    return Sides(*ended, late, velocity, teeth, 0.0, sides.wrong, bristle, sides.motor_bristle)


@kernel
def _arrived(p, s, grip, sides, step, moved, velocity):
    """The grip on a shaft that has `moved` [rad] in a step, last at this `velocity` [rad/s], and its velocity then."""
    motor = torque_at(p, s, sides.motor_velocity, sides.current)
    bristle = shaft.bristle_after(p, s, grip.friction, moved, velocity, motor)
    twist, angle, time = s.motor_angle + sides.motor_travel - s.angle - moved, s.angle + moved, s.time + step
    reached = holding(p, s, twist, sides.motor_velocity, angle, velocity, bristle, time, motor)
    return reached, shaft_velocity(s, reached, sides.motor_velocity)


@kernel
def _between(p, s, grip, line, elapsed, step, missed):
    """Angle [rad] and velocity [rad/s] of the shaft when some of a step has `elapsed` [s] that missed so much [N.m]."""
    if s.direction == 0.0:
        return s.angle, 0.0
    travel, now, _ = _motor_piece(p, s, line, elapsed)
    rate = (grip.stiffness + grip.bending) * grip.mobility
    faded = math.expm1(-rate * elapsed)
    moved, _ = _follow(s, grip, elapsed, travel / elapsed, rate, faded)
    missed *= (elapsed / step) ** 2
    moved -= missed * grip.mobility * elapsed * grown(rate * elapsed, faded)
    push = grip.stiffness * (grip.deflection + travel - moved) + grip.damping * now
    return s.angle + moved, grip.mobility * (push - grip.resisting - grip.bending * moved - missed)


@kernel
def _breaks(p, s, sides, step):
    """Whether, `step` [s] on, a held side has broken loose or a sliding one has passed rest or a stop."""
    if sides.motor_velocity * s.motor_direction < 0.0:
        return True
    if _motor_stands(p, s) and motor_onset(p, s, sides.teeth, sides.current) != 0.0:
        return True
    if s.direction == 0.0:
        return shaft.onset(p, s, sides.teeth, s.angle, s.time + step) != 0.0
    angle = s.angle + sides.travel
    return sides.velocity * s.direction < 0.0 or angle > upper(p) or angle < lower(p)


@kernel
def move(p, s, remaining):
    """Move for at most `remaining` [s], up to the next event; gives the time used."""
    _set_directions(p, s)
    grip, line = _line(p, s)
    enough = _enough(p, s, grip, line)
    step = min(remaining, max(s.step, enough), turn(p, s, s.motor_velocity, line))
    if p.external_load.frequency > 0.0:
        step = max(min(step, LOAD_STEP / p.external_load.frequency), enough)
    while True:
        sides = _trial(p, s, grip, line, step)
        excess = max(
            beyond(p, sides.wrong, sides.motor_travel),
            abs(sides.motor_travel) / finest(p, s.motor_angle, s.motor_velocity),
            abs(sides.travel) / finest(p, s.angle, s.motor_velocity),
        )
        if not excess > 1.0 or step <= enough:
            break
        step = max(shorter(step, excess), enough)
    s.step = next_step(s.step, step, remaining, excess)
    bends = excess > 1.0 and s.direction != 0.0
    if bends:
        sides = _bent(p, s, grip, sides, step)
    breaks = _breaks(p, s, sides, step)
    if breaks and not bends:
        step = _breaking_time(p, s, grip, line, step)
        sides = _trial(p, s, grip, line, step)
    while due(p, s, s.time + step):
        elapsed = s.ahead.time[s.sampled] - s.time
        angle, velocity = s.angle + sides.travel * elapsed / step, sides.velocity
        if not bends:
            angle, velocity = _between(p, s, grip, line, elapsed, step, sides.missed)
        put(p, s, angle, velocity)
    _take(p, s, sides, step, breaks)
    return step


@kernel
def _set_directions(p, s):
    """Decide whether the standing sides begin to move."""
    if s.direction != 0.0 and not _motor_stands(p, s):
        return
    twist = s.motor_angle - s.angle
    motor = torque_at(p, s, s.motor_velocity, s.current)
    grip = holding(p, s, twist, s.motor_velocity, s.angle, s.velocity, s.presliding.bristle, s.time, motor)
    if s.direction == 0.0:
        s.direction = shaft.onset(p, s, push(grip, s.motor_velocity, 0.0), s.angle, s.time)
    if _motor_stands(p, s):
        s.motor_direction = motor_onset(p, s, push(grip, 0.0, s.velocity), s.current)


@kernel
def _breaking_time(p, s, grip, line, step):
    """When within a `step` [s] a side breaks loose or rests: so well that the motor is no faster for it."""
    early, late = 0.0, step
    settling = p.total_inertia / max(line.slope + grip.damping, TINY)
    found = max(min(shortest(p), UNTOUCHED * settling), SAME_MOMENT * p.own.time)
    while late - early > found:
        middle = 0.5 * (early + late)
        if _breaks(p, s, _trial(p, s, grip, line, middle), middle):
            late = middle
        else:
            early = middle
    return late


@kernel
def _take(p, s, sides, step, breaks):
    """Accept a step."""
    s.presliding.bristle, s.presliding.motor_bristle = sides.bristle, sides.motor_bristle
    s.motor_angle += sides.motor_travel
    s.motor_velocity, s.current = sides.motor_velocity, sides.current
    if sides.motor_velocity * s.motor_direction < 0.0:
        s.motor_velocity = s.motor_direction = 0.0
    angle = s.angle + sides.travel
    s.angle = min(max(angle, lower(p)), upper(p))
    rests = breaks and (sides.velocity * s.direction <= 0.0 or s.angle != angle)
    s.velocity = sides.velocity
    if rests:
        s.direction = s.velocity = 0.0
    s.time += step
