"""From shaft angle to measured value: play of the magnet, lag, characteristic, converter."""

from __future__ import annotations

import math

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
def quantised(p, value):
    """`value` as the converter gives it, same unit."""
    return sensor_quantization.rounded(p.sensor_quantization, value)
