"""From shaft angle to measured value: play of the magnet, lag, characteristic, converter."""

from __future__ import annotations

import math

import numpy as np

from pierburg_ros.effects import sensor_hysteresis, sensor_lag, sensor_nonlinearity, sensor_quantization
from pierburg_ros.kernel import kernel

SPAN = math.pi / 2
"""Angle between the two Hall end voltages [rad]."""


@kernel
def follow(p, s, duration):
    """Let the moving parts of the sensor follow the shaft, which has gone one way for `duration` [s]."""
    start = s.sensor_hysteresis.magnet
    s.sensor_hysteresis.magnet = sensor_hysteresis.dragged(p.sensor_hysteresis, start, s.angle)
    moving = duration
    if p.sensor_hysteresis.width != 0.0 and s.sensor_hysteresis.magnet != start:
        moving = duration * min(
            abs(s.sensor_hysteresis.magnet - start) / max(abs(s.angle - s.sensor_hysteresis.followed), 1e-300), 1.0
        )
    lagged = sensor_lag.followed(p.sensor_lag, s.sensor_lag.lagged, start, start, duration - moving)
    s.sensor_lag.lagged = sensor_lag.followed(p.sensor_lag, lagged, start, s.sensor_hysteresis.magnet, moving)
    s.sensor_hysteresis.followed = s.angle


@kernel
def measured(p, s):
    """Measured quantity before noise and converter: Hall voltage [V], or angle [rad] where that is measured."""
    angle = s.sensor_lag.lagged if p.sensor_moves else s.angle
    fraction = sensor_nonlinearity.bent(p.sensor_nonlinearity, angle / SPAN)
    if p.measures_position:
        return fraction * SPAN
    return p.hall_voltage_closed + (p.hall_voltage_open - p.hall_voltage_closed) * fraction


@kernel
def decode(p, value, is_angle):
    """Angle [rad] that a measured `value` shows: a Hall voltage [V], or an angle [rad] as the sensor gives it."""
    indicated = value if is_angle else (value - p.hall_voltage_closed) / per_radian(p)
    if p.sensor_nonlinearity.amplitude == 0.0:
        return indicated
    return sensor_nonlinearity.unbent(p.sensor_nonlinearity, indicated / SPAN) * SPAN


@kernel
def decode_all(p, values, is_angle):
    """`decode` of each of `values`, shape (values,)."""
    angles = np.empty(values.size)
    for index in range(values.size):
        angles[index] = decode(p, values[index], is_angle)
    return angles


@kernel
def sensitivity(p, angle, is_angle):
    """Change of the measured value at `angle` [rad] per rad."""
    return (1.0 if is_angle else per_radian(p)) * sensor_nonlinearity.slope(p.sensor_nonlinearity, angle / SPAN)


@kernel
def per_radian(p):
    """Mean change of the Hall voltage over the span [V/rad]."""
    return (p.hall_voltage_open - p.hall_voltage_closed) / SPAN


@kernel
def quantised(p, value):
    """`value` as the converter gives it, same unit."""
    return sensor_quantization.rounded(p.sensor_quantization, value)
