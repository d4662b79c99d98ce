"""The state record of one simulated actuator, and how it starts."""

from __future__ import annotations

import math

import numpy as np

from pierburg_ros.effects import EFFECTS
from pierburg_ros.kernel import kernel
from pierburg_ros.plant.torques.friction import level
from pierburg_ros.plant.torques.sensor import SPEED, sensed, trail

QUEUE = 1024
"""Changes of the command that may be under way at once when the input is delayed."""

LOOKAHEAD = 1024
"""Samples that the plant looks ahead: at the last of them a step ends."""

SAMPLES = np.dtype(
    [
        ("count", np.int64),
        ("time", np.float64, (LOOKAHEAD,)),  # s
        ("shown", np.float64, (LOOKAHEAD,)),  # rad or rad/s
    ],
    align=True,
)

PIECE = np.dtype(
    [
        ("order", np.int64),  # 2, or 3 behind an inductance; 0: none yet
        ("damping", np.float64),  # coefficients, see linear_piece and third_order
        ("stiffness", np.float64),
        ("pull", np.float64),
        ("step", np.float64),  # s
        ("slope", np.float64),  # responses after `step`
        ("impulse", np.float64),
        ("integral", np.float64),
        ("twice", np.float64),
        ("thrice", np.float64),
    ],
    align=True,
)

OUTSIDE = np.dtype([("serial", np.int64), ("time", np.float64), ("torque", np.float64), ("rate", np.float64)])
"""A load from outside at one moment: of which parameters, s, N.m, N.m/s."""

_REMEMBERED = [(effect.id, [(name, np.float64) for name in effect.state]) for effect in EFFECTS if effect.state]
STATE = np.dtype(
    [
        ("time", np.float64),  # s, as loads and samples count it
        ("angle", np.float64),  # rad, of the shaft
        ("velocity", np.float64),  # rad/s, of the shaft
        ("direction", np.float64),  # +1 opening, -1 closing, 0 held: of the shaft
        ("motor_angle", np.float64),  # rad, of the motor side seen from the shaft
        ("motor_velocity", np.float64),  # rad/s
        ("motor_direction", np.float64),
        ("flank", np.int64),  # touching: +1 the opening one, -1 the closing one, 0 none
        ("current", np.float64),  # A
        ("arrived", np.float64),  # command that has arrived at the driver
        ("command", np.float64),  # in force at the motor, before the dead band
        ("supply", np.float64),  # V
        ("closed_bridge", np.bool_),
        ("serial", np.int64),  # of the parameters last used
        ("voltage", np.float64),  # V, applied to armature and source
        ("resistance", np.float64),  # ohm, of armature and source
        ("drive", np.float64),  # N.m, motor torque at rest, at the shaft
        ("braking", np.float64),  # N.m.s/rad, by the back-EMF
        ("step", np.float64),  # s, internal step that was last accepted
        ("events", np.float64),  # of late, beyond those that may go on
        ("ahead", SAMPLES),
        ("sampled", np.int64),  # of the samples ahead that are put
        ("piece", PIECE),  # the linear piece last computed
        ("outside", OUTSIDE),  # the load last computed
        ("waiting", np.int64),  # changes under way
        ("first", np.int64),
        ("queue_time", np.float64, (QUEUE,)),  # s
        ("queue_command", np.float64, (QUEUE,)),
        *_REMEMBERED,
    ],
    align=True,
)
"""What a plant remembers; `s.<effect>.<name>` are the states that effects declare, all 0 at the start."""


def new_state(record: np.ndarray, angle: float = 0.0, velocity: float = 0.0) -> np.ndarray:
    """State record, shape (1,), of a cold actuator at `angle` [rad] with `velocity` [rad/s], no current.

    Its sensor is as after motion that has ended: see `place`.
    """
    state = blank_state()
    place(record[0], state[0], angle, velocity, 0.0, 0.0)
    return state


def blank_state() -> np.ndarray:
    """State record, shape (1,), all zeros."""
    return np.zeros(1, STATE)


@kernel
def place(p, s, angle, velocity, acceleration, came):
    """Put an actuator at `angle` [rad] with `velocity` [rad/s], transmission relaxed.

    Its sensor is as after motion with an even `acceleration` [rad/s^2]; if it stands, as after motion that `came`
    opening (+1) or closing (-1), 0 where that is not known. `s` is all zeros but for what lasts, such as heat.

    On the lower stop the bristles of the friction contact lean as closing onto the stop has left them, and while the
    shaft slides as far as that bends them.
    """
    if p.stop_compliance.stiffness == 0.0:
        angle = min(max(angle, p.lower_stop), p.upper_stop)
    s.angle = s.motor_angle = angle
    s.velocity = s.motor_velocity = velocity
    s.sensor_hysteresis.followed = sensed(p, s)
    lag, play = trail(p)
    s.sensor_hysteresis.magnet = sensed(p, s) - 0.5 * play * np.sign(velocity if velocity != 0.0 else came)
    s.sensor_lag.lagged = s.sensor_hysteresis.magnet - lag * (velocity - lag * acceleration)
    s.direction = s.motor_direction = np.sign(velocity)
    s.flank = 1
    s.supply = np.nan
    s.closed_bridge = True
    s.step = math.inf
    if p.presliding.stiffness != 0.0 and angle <= p.lower_stop:
        s.presliding.bristle = -level(p, -1.0, -math.inf, angle, 0.0)[0] / p.presliding.stiffness
    elif p.presliding.stiffness != 0.0 and velocity != 0.0:
        s.presliding.bristle = s.direction * level(p, s.direction, velocity, angle, 0.0)[0] / p.presliding.stiffness
    s.presliding.motor_bristle = s.presliding.bristle


@kernel
def displace(p, s, by):
    """Move the shaft `by` so far [rad], and with it all that moves along, within its stops."""
    to = s.angle + by
    if p.stop_compliance.stiffness == 0.0:
        to = min(max(to, p.lower_stop), p.upper_stop)
    by = to - s.angle
    s.angle = to
    s.motor_angle += by
    if p.sensor != SPEED:
        s.sensor_hysteresis.followed += by
        s.sensor_hysteresis.magnet += by
        s.sensor_lag.lagged += by


@kernel
def turn(s, by):
    """Let the shaft turn faster `by` so much [rad/s]."""
    if by == 0.0:
        return
    s.velocity += by
    s.motor_velocity += by
    s.direction = np.sign(s.velocity)
    s.motor_direction = np.sign(s.motor_velocity)
