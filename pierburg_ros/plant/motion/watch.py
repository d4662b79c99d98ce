"""Samples read from within steps: a step is as long as the motion allows, however densely it is sampled.

`s.ahead` holds the times of the next samples and what the sensor is shown then; `s.sampled` of its `count` are put.
"""

from __future__ import annotations

from pierburg_ros.kernel import kernel
from pierburg_ros.plant.motion.linear_piece import alike, responses
from pierburg_ros.plant.torques.sensor import SPEED, shown


@kernel
def due(p, s, time):
    """Whether the next sample is within a step that ends at `time` [s]; what creeps beside it is sampled at its end."""
    return s.sampled < s.ahead.count and s.ahead.time[s.sampled] < time and not p.creeps


@kernel
def put(p, s, angle, velocity):
    """Put the next sample: a shaft at `angle` [rad] with `velocity` [rad/s], no part of the sensor moving."""
    s.ahead.shown[s.sampled] = velocity if p.sensor == SPEED else angle
    s.sampled += 1


@kernel
def stood(p, s, time):
    """Put the samples up to `time` [s]: the shaft stands where it is, or has just got there."""
    while s.sampled < s.ahead.count and s.ahead.time[s.sampled] <= time:
        s.ahead.shown[s.sampled] = shown(p, s)
        s.sampled += 1


@kernel
def slid(p, s, piece, angle, velocity, step):
    """Put the samples within a `step` [s] from now on that begins at `angle` with `velocity`, from one to the next.

    `piece` is x'' + damping x' + stiffness x = push + ramp t + curvature t^2 / 2 of the travel x [rad]: these five.
    """
    damping, stiffness, push, ramp, curvature = piece
    end, before, travel, last = s.time + step, s.time, 0.0, -1.0
    kept = pull = slope = impulse = integral = twice = thrice = 0.0
    first, shows_speed = s.sampled, p.sensor == SPEED
    for sample in range(first, s.ahead.count):
        time = s.ahead.time[sample]
        if not time < end:
            break
        if not alike(time - before, last):
            last = time - before
            slope, impulse, integral, twice, thrice = responses(damping, stiffness, last)
            kept, pull = 1.0 - stiffness * integral, stiffness * impulse
        elapsed = before - s.time
        steady, rising = push + elapsed * (ramp + 0.5 * elapsed * curvature), ramp + elapsed * curvature
        gone = steady * integral + rising * twice + curvature * thrice
        faster = steady * impulse + rising * integral + curvature * twice
        gone, faster = gone + impulse * velocity + kept * travel, faster + slope * velocity - pull * travel
        travel, velocity, before = gone, faster, time
        s.ahead.shown[sample] = velocity if shows_speed else angle + travel
        s.sampled += 1
