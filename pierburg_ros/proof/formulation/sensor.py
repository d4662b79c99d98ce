"""From the shaft's angle to the Hall voltage: magnet play, lag, curvature, resolution, in this order."""

from __future__ import annotations

from math import floor, pi, sin
from typing import Any

from pierburg_ros.kernel import kernel


@kernel
def sense(state: Any, p: Any, h: float) -> None:
    """Carry magnet and lag over one step."""
    play = 0.5 * p.sensor_hysteresis.width
    state.magnet_angle = min(max(state.magnet_angle, state.angle - play), state.angle + play)
    share = h / (p.sensor_lag.time_constant + h)
    state.sensed_angle += share * (state.magnet_angle - state.sensed_angle)


@kernel
def hall_voltage(state: Any, p: Any) -> float:
    """Hall voltage before noise and resolution [V]."""
    x = state.sensed_angle / (0.5 * pi)
    if p.sensor_nonlinearity.amplitude != 0.0:
        x += p.sensor_nonlinearity.amplitude * sin(p.sensor_nonlinearity.half_waves * pi * x)
    voltage: float = p.hall_voltage_closed + (p.hall_voltage_open - p.hall_voltage_closed) * x
    return voltage


@kernel
def resolved(voltage: float, p: Any) -> float:
    """Voltage rounded to the converter's steps [V]."""
    step: float = p.sensor_quantization.step
    if step == 0.0:
        return voltage
    return step * floor(voltage / step + 0.5)
