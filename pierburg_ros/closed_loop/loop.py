"""Controller and plant in one compiled loop, tick by tick as section 2 of docs/contract.md orders them.

At t_k the plant samples the shaft and takes the newest duty, the one computed from the sample before; that
duty acts until t_(k+1). Meanwhile the controller answers sample k.
"""

from __future__ import annotations

from dataclasses import dataclass
from types import ModuleType
from typing import Any

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.control import Schedule, Settings, law, linear
from pierburg_ros.errors import InputError
from pierburg_ros.kernel import kernel
from pierburg_ros.plant import Model
from pierburg_ros.plant.signal_path import advance
from pierburg_ros.plant.simulate import refuse_unsimulated
from pierburg_ros.plant.state import new_state
from pierburg_ros.plant.torques.sensor import measured, quantised

TICK = [(name, np.float64) for name in ("setpoint", "noise", "hall_voltage", "duty", "angle")]


@dataclass(frozen=True)
class Run:
    """A simulated closed loop: `time` of shape (samples,), the rest too, or (runs, samples) for several runs."""

    time: Signal  # [s]
    setpoint: Signal  # [rad]
    hall_voltage: Signal  # as sampled, with noise [V]
    duty: Signal  # in force from this sample to the next [1]
    angle: Signal  # true shaft angle at the sample [rad]


def simulate_loop(
    model: Model,
    settings: Settings,
    schedule: Schedule,
    duration: float,
    rate: float = 500.0,
    noise: float = 0.0,
    seed: int = 0,
    initial_angle: float = 0.0,
    control: ModuleType = law,
) -> Run:
    """The closed loop over `duration` [s] at `rate` [Hz], with Gaussian sensor noise of `noise` [V] RMS.

    The shaft starts at rest at `initial_angle` [rad], the controller without a past. `control` is the `law` of the
    PIFLC, or `linear` for a plain PI or PID.
    """
    time = np.arange(round(duration * rate) + 1) / rate
    runs = simulate_runs(model, settings, schedule.sampled(time)[np.newaxis], rate, noise, seed, initial_angle, control)
    return Run(time, runs.setpoint[0], runs.hall_voltage[0], runs.duty[0], runs.angle[0])


def simulate_runs(
    model: Model,
    settings: Settings,
    setpoint: Signal,
    rate: float = 500.0,
    noise: float = 0.0,
    seed: int = 0,
    initial_angle: float = 0.0,
    control: ModuleType = law,
) -> Run:
    """Closed loops one after the other, one for each row of `setpoint` [rad], shape (runs, samples).

    Each starts anew, shaft and controller; see `simulate_loop`.
    """
    if model.actuator.drive != "voltage":
        raise InputError(
            f"Actuator {model.actuator.name} is driven by a {model.actuator.input}; the controller gives a duty. "
            "Choose one that is driven by a duty."
        )
    if model.actuator.quantity != "hall_voltage":
        raise InputError(
            f"Actuator {model.actuator.name} measures {model.actuator.quantity}; the controller needs "
            "hall_voltage. Choose an actuator with a Hall sensor."
        )
    ticks = np.zeros(setpoint.shape, TICK)
    ticks["setpoint"] = setpoint
    ticks["noise"] = noise * np.random.default_rng(seed).standard_normal(setpoint.shape)
    record = model.record()
    plants = np.repeat(new_state(record, initial_angle), len(ticks))
    close = close_linear if control is linear else close_piflc
    close(record[0], plants, settings.record(), law.new_state(), ticks, 1.0 / rate)
    time = np.arange(setpoint.shape[1]) / rate
    for angle in ticks["angle"]:
        refuse_unsimulated(model, angle, time)
    return Run(time, **{name: ticks[name].copy() for name in ("setpoint", "hall_voltage", "duty", "angle")})


@kernel
def close_piflc(parameters: Any, plants: Any, settings: Any, state: Any, runs: Any, period: float) -> None:
    """Run the PIFLC against the plant through the ticks of each run, `period` [s] apart."""
    for number in range(runs.shape[0]):
        plant = plants[number]
        law.forget(state)
        for tick in runs[number]:
            sample(parameters, plant, state, tick)
            law.step(settings, state, tick.setpoint, tick.hall_voltage, period)
            advance(parameters, plant, tick.duty, np.nan, True, period)


@kernel
def close_linear(parameters: Any, plants: Any, settings: Any, state: Any, runs: Any, period: float) -> None:
    """Run a PI or PID instead (a kernel that took the law as an argument could not be cached on disk)."""
    for number in range(runs.shape[0]):
        plant = plants[number]
        law.forget(state)
        for tick in runs[number]:
            sample(parameters, plant, state, tick)
            linear.step(settings, state, tick.setpoint, tick.hall_voltage, period)
            advance(parameters, plant, tick.duty, np.nan, True, period)


@kernel
def sample(parameters: Any, plant: Any, state: Any, tick: Any) -> None:
    """Sample the shaft and put the newest duty in force, the one of the sample before."""
    tick.angle = plant.angle
    tick.hall_voltage = quantised(parameters, measured(parameters, plant) + tick.noise)
    tick.duty = state.duty
