"""Motor and shaft as one: held or sliding, with rigid teeth that always touch."""

from __future__ import annotations

from pierburg_ros.kernel import kernel
from pierburg_ros.plant.motion.body import JOINED, balance
from pierburg_ros.plant.motion.events import hold, lower, onset, slide, upper


@kernel
def move(p, s, remaining):
    """Move for at most `remaining` [s], up to the next event; gives the time used."""
    if s.direction == 0.0:
        s.direction = onset(p, s, s.time, s.current)
        if s.direction == 0.0:
            return hold(p, s, remaining)
    return slide_joined(p, s, joined(p, s), remaining)


@kernel
def joined(p, s):
    """Net torque on motor and shaft as one, as a straight line."""
    return balance(p, s, JOINED, s.angle, s.velocity, s.direction, s.time, s.current, s.presliding.bristle)


@kernel
def slide_joined(p, s, line, remaining):
    """Slide as one body for at most `remaining` [s], up to the next event; gives the time used."""
    twist = s.motor_angle - s.angle
    used, angle, velocity, rests, stops = slide(
        p, s, JOINED, s.angle, s.velocity, s.direction, lower(p), upper(p), line, remaining
    )
    s.angle, s.motor_angle = angle, angle + twist
    if rests or stops:
        s.direction = velocity = 0.0
    s.velocity = s.motor_velocity = velocity
    return used
