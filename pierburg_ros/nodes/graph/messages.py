"""Messages made from numbers."""

from __future__ import annotations

from builtin_interfaces.msg import Time
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64

SECOND = 1_000_000_000
"""Nanoseconds in a second."""


def stamp(time: int) -> Time:
    """`time` [ns] as a message."""
    return Time(sec=time // SECOND, nanosec=time % SECOND)


def nanoseconds(time: Time) -> int:
    """A message's time [ns]."""
    return int(time.sec) * SECOND + int(time.nanosec)


def clock(time: int) -> Clock:
    """`time` [ns] for `/clock`."""
    return Clock(clock=stamp(time))


def number(value: float) -> Float64:
    """One number."""
    return Float64(data=value)


def joint_state(joint: str, time: int, angle: float, velocity: float) -> JointState:
    """Angle [rad] and velocity [rad/s] of the shaft at `time` [ns], under the name of its `joint`."""
    message = JointState(name=[joint], position=[angle], velocity=[velocity])
    message.header.stamp = stamp(time)
    return message
