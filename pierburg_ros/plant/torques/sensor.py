"""From shaft to measured value: play of the magnet, lag, characteristic, converter."""

from __future__ import annotations

import numpy as np

from pierburg_ros.effects import sensor_hysteresis, sensor_lag, sensor_nonlinearity, sensor_quantization
from pierburg_ros.effects.effect import SENSORS
from pierburg_ros.kernel import kernel

POSITION = SENSORS.index("position")
"""The sensor gives the angle itself [rad]; else, a Hall voltage [V]."""
SPEED = SENSORS.index("speed")
"""The sensor gives the velocity [rad/s]."""


@kernel
def sensed(p, s):
    """What the sensor looks at: the shaft's angle [rad], or its velocity [rad/s]."""
    return s.velocity if p.sensor == SPEED else s.angle


@kernel
def trail(p):
    """Lag [s] and play [rad] by which the sensor is behind a shaft that moves evenly; none where it senses velocity."""
    if p.sensor == SPEED:
        return 0.0, 0.0
    return p.sensor_lag.time_constant, p.sensor_hysteresis.width


@kernel
def follow(p, s, duration):
    """Let the moving parts of the sensor follow the shaft, which has gone one way for `duration` [s]."""
    true = sensed(p, s)
    start = s.sensor_hysteresis.magnet
    s.sensor_hysteresis.magnet = sensor_hysteresis.dragged(p.sensor_hysteresis, start, true)
    moving = duration
    if p.sensor_hysteresis.width != 0.0 and s.sensor_hysteresis.magnet != start:
        moving = duration * min(
            abs(s.sensor_hysteresis.magnet - start) / max(abs(true - s.sensor_hysteresis.followed), 1e-300), 1.0
        )
    lagged = sensor_lag.followed(p.sensor_lag, s.sensor_lag.lagged, start, start, duration - moving)
    s.sensor_lag.lagged = sensor_lag.followed(p.sensor_lag, lagged, start, s.sensor_hysteresis.magnet, moving)
    s.sensor_hysteresis.followed = true


@kernel
def measured(p, s):
    """Measured quantity before noise and converter: Hall voltage [V], angle [rad] or velocity [rad/s]."""
    return read(p, shown(p, s))


@kernel
def shown(p, s):
    """Angle [rad] or velocity [rad/s] at which the sensor's moving parts stand."""
    return s.sensor_lag.lagged if p.sensor_moves else sensed(p, s)


@kernel
def read_all(p, values, measured):
    """Put into `measured` what each of the `values` shown [rad or rad/s] is, as the converter gives it."""
    for index in range(values.size):
        measured[index] = quantised(p, read(p, values[index]))


@kernel
def read(p, shown):
    """Measured quantity before noise and converter of a value `shown` [rad or rad/s]."""
    if p.sensor == SPEED:
        return p.sensor_scale * shown + p.sensor_offset
    fraction = sensor_nonlinearity.bent(p.sensor_nonlinearity, shown / p.sensor_span)
    if p.sensor == POSITION:
        return p.sensor_scale * (fraction * p.sensor_span) + p.sensor_offset
    return p.hall_voltage_closed + (p.hall_voltage_open - p.hall_voltage_closed) * fraction


@kernel
def decode(p, value, is_angle):
    """Angle [rad] that a measured `value` shows: a Hall voltage [V], or an angle [rad] as the sensor gives it.

    The velocity [rad/s] where the sensor gives that.
    """
    zero, slope = (p.sensor_offset, p.sensor_scale) if is_angle else (p.hall_voltage_closed, per_radian(p))
    indicated = (value - zero) / slope
    if p.sensor_nonlinearity.amplitude == 0.0:
        return indicated
    return sensor_nonlinearity.unbent(p.sensor_nonlinearity, indicated / p.sensor_span) * p.sensor_span


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
    straight = p.sensor_scale if is_angle else per_radian(p)
    return straight * sensor_nonlinearity.slope(p.sensor_nonlinearity, angle / p.sensor_span)


@kernel
def begun(p, shown, is_angle):
    """Angle [rad], velocity [rad/s], acceleration [rad/s^2] and way of coming at each start: `plant.decode.begun`."""
    starts = np.zeros((shown.shape[0], 4))
    lag, play = trail(p)
    for start in range(shown.shape[0]):
        level, rate, curvature, margin, came = shown[start]
        angle = decode(p, level, is_angle)
        slope = sensitivity(p, angle, is_angle)
        near = margin / abs(slope)
        if angle <= p.lower_stop + near:
            starts[start, 0] = p.lower_stop
        elif angle >= p.upper_stop - near:
            starts[start, 0] = p.upper_stop
        elif rate == 0.0:
            came *= np.sign(slope)
            starts[start, 0], starts[start, 3] = angle + 0.5 * play * came, came
        else:
            moves, acceleration = rate / slope, curvature / slope
            velocity = moves + lag * acceleration
            starts[start, 0] = angle + lag * moves + 0.5 * play * np.sign(velocity)
            starts[start, 1], starts[start, 2] = velocity, acceleration
    return starts


@kernel
def per_radian(p):
    """Mean change of the Hall voltage over the span [V/rad]."""
    return (p.hall_voltage_open - p.hall_voltage_closed) / p.sensor_span


@kernel
def quantised(p, value):
    """`value` as the converter gives it, same unit."""
    return sensor_quantization.rounded(p.sensor_quantization, value)
