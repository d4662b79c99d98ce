"""The control law of Fig. 6, compiled: setpoint and Hall voltage in, duty out, one call a sample.

The node and the simulation call this same code. `settings` is the record of `Settings`, `state` that of
`new_state`; everything the law remembers between samples is in the latter. Whatever finite numbers come in,
the state stays finite: `LARGEST_ERROR` and `LONGEST_SAMPLING` bound what enters it, far beyond what a sensor or a clock
gives.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from pierburg_ros.control import predictor
from pierburg_ros.control.fuzzy import duty_of, pi_output_for
from pierburg_ros.kernel import kernel

SHORTEST_SAMPLING = 1e-6  # samples closer than this [s] leave derivative and integrator as they are
LARGEST_ERROR = 1e6
"""Errors [V] beyond this count as this: 10,000 times the widest range of a sensor that can be set, and small
enough that its quotient by `SHORTEST_SAMPLING` and its product with every gain are finite."""
LONGEST_SAMPLING = 1e3
"""Longer times between two samples [s] count as this: a quarter of an hour is no sampling."""
STATE = [
    ("started", np.bool_),  # a first sample has been seen
    ("saturated", np.bool_),  # the PI output is past its support, or the duty at a limit
    ("setpoint", np.float64),  # of the last sample [rad]
    ("error", np.float64),  # setpoint minus measured [V]
    ("derivative", np.float64),  # filtered derivative of the error [V/s]
    ("integral", np.float64),  # the integrator's part of the PI output [V]
    ("pi_output", np.float64),  # [V]
    ("transfer", np.float64),  # still added to the duty after a start or a change of settings [1]
    ("duty", np.float64),  # last duty given out [1]
    *predictor.STATE,
]


def new_state() -> Any:
    """State of a controller that has seen no sample and gives duty 0."""
    return np.rec.array(np.zeros(1, dtype=STATE))[0]


@kernel
def forget(state: Any) -> None:
    """Bring a state back to that of `new_state`."""
    state.started = state.saturated = False
    state.setpoint = state.error = state.derivative = state.integral = state.pi_output = 0.0
    state.transfer = state.duty = 0.0
    predictor.forget(state)


@kernel
def step(settings: Any, state: Any, setpoint: float, hall_voltage: float, dt: float) -> float:
    """Duty [1] for one sample: setpoint [rad], Hall voltage [V], time since the previous sample [s].

    The first sample has no past: its derivative is 0, and the duty leaves from where it was.
    """
    follow(settings, state, setpoint, hall_voltage, dt)
    return give(settings, state, scheduled(settings, state) + duty_of(settings, state.pi_output, state.derivative), dt)


@kernel
def follow(settings: Any, state: Any, setpoint: float, hall_voltage: float, dt: float) -> None:
    """Bring error, derivative of the error and PI output up to a sample."""
    dt = min(dt, LONGEST_SAMPLING)
    if state.started and dt >= SHORTEST_SAMPLING:
        hall_voltage = predictor.predicted(settings, state, hall_voltage, state.duty, dt)
    error = min(max(voltage(settings, setpoint) - hall_voltage, -LARGEST_ERROR), LARGEST_ERROR)
    if state.started and dt >= SHORTEST_SAMPLING:
        slope = (error - state.error) / dt
        state.derivative += (slope - state.derivative) * dt / (dt + settings.derivative_time_constant)
        integrate(settings, state, error, dt)
    state.setpoint, state.error = setpoint, error
    state.pi_output = settings.proportional_gain * error + state.integral


@kernel
def voltage(settings: Any, angle: float) -> float:
    """Hall voltage [V] of a shaft angle [rad], by the line between the stops."""
    share = (angle - settings.angle_closed) / (settings.angle_open - settings.angle_closed)
    span = settings.hall_voltage_open - settings.hall_voltage_closed
    hall_voltage: float = settings.hall_voltage_closed + share * span
    return hall_voltage


@kernel
def integrate(settings: Any, state: Any, error: float, dt: float) -> None:
    """Advance the integrator, unless the error is in the dead zone or would push further into saturation."""
    pi_output = settings.proportional_gain * error + state.integral
    saturates = state.saturated or abs(pi_output) >= settings.pi_output_support
    winds_up = saturates and pi_output * error > 0.0
    if abs(error) > settings.integral_dead_zone and not winds_up:
        integral = state.integral + settings.integral_gain * error * dt
        state.integral = within_support(settings, integral)


@kernel
def within_support(settings: Any, integral: float) -> float:
    """An integrator value [V] limited to what the fuzzy stage can tell apart."""
    limited: float = min(max(integral, -settings.pi_output_support), settings.pi_output_support)
    return limited


@kernel
def scheduled(settings: Any, state: Any) -> float:
    """The part of the duty [1] that carries the load at the setpoint, which the integrator need not find."""
    share = (state.setpoint - settings.angle_closed) / (settings.angle_open - settings.angle_closed)
    load = settings.load_closed + min(max(share, 0.0), 1.0) * (settings.load_open - settings.load_closed)
    duty: float = settings.load_share * load
    return duty


@kernel
def give(settings: Any, state: Any, duty: float, dt: float) -> float:
    """The duty [1] in transition and within its limits; notes saturation for the integrator."""
    if not state.started:
        state.transfer = state.duty - duty
        state.started = True
    elif dt >= SHORTEST_SAMPLING:
        state.transfer *= math.exp(-dt / settings.transfer_time)
    limited: float = min(max(duty + state.transfer, settings.duty_minimum), settings.duty_maximum)
    at_limit = limited == settings.duty_minimum or limited == settings.duty_maximum
    state.saturated = at_limit or abs(state.pi_output) >= settings.pi_output_support
    state.duty = limited
    return limited


@kernel
def take_over(settings: Any, state: Any) -> None:
    """Take new settings into a running controller so that its duty goes on from where it is.

    The integrator moves so that the present error asks for the present duty. In saturation it stays, since
    there a wide range of it gives the same duty. What difference of duty this leaves over fades away.
    """
    if not state.saturated:
        pi_output = pi_output_for(settings, state.duty - scheduled(settings, state), state.derivative)
        state.integral = within_support(settings, pi_output - settings.proportional_gain * state.error)
    state.pi_output = settings.proportional_gain * state.error + state.integral
    given = scheduled(settings, state) + duty_of(settings, state.pi_output, state.derivative)
    state.transfer = state.duty - given
