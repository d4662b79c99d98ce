"""A closed loop in service: the supply wanders, and from some moment on the actuator is another."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.closed_loop.loop import TICK, sample
from pierburg_ros.control import Settings, law
from pierburg_ros.errors import InputError
from pierburg_ros.kernel import kernel
from pierburg_ros.plant import Model
from pierburg_ros.plant.signal_path import advance
from pierburg_ros.plant.state import new_state


@dataclass(frozen=True)
class Stretch:
    """Part of a loop that runs on: all of shape (samples,)."""

    time: Signal  # [s]
    hall_voltage: Signal  # as sampled, with noise [V]
    duty: Signal  # in force from this sample to the next [1]
    angle: Signal  # true shaft angle at the sample [rad]


class Service:
    """A loop that goes on from stretch to stretch; `model` may be replaced between two, and the shaft stays."""

    def __init__(
        self, model: Model, settings: Settings, rate: float = 500.0, noise: float = 0.0, seed: int = 0
    ) -> None:
        """The shaft rests at the closed stop; `rate` [Hz], `noise` [V] RMS of the sensor."""
        self.model = model
        self._settings = settings.record()
        self._rate, self._noise = rate, noise
        self._random = np.random.default_rng(seed)
        self._plant = new_state(model.record(), 0.0)
        self._law = law.new_state()
        self._ticks = 0

    def run(self, setpoint: Signal, supply_voltage: Signal) -> Stretch:
        """The next stretch, one tick for each setpoint [rad] and supply voltage [V]."""
        ticks = np.zeros(setpoint.shape, TICK)
        ticks["setpoint"] = setpoint
        ticks["noise"] = self._noise * self._random.standard_normal(setpoint.shape)
        record = self.model.record()
        close_supplied(record[0], self._plant[0], self._settings, self._law, ticks, supply_voltage, 1.0 / self._rate)
        if not np.all(np.isfinite(ticks["angle"])):
            raise InputError("The model cannot be simulated with these values; bring them closer to nominal.")
        time = (self._ticks + np.arange(setpoint.size)) / self._rate
        self._ticks += setpoint.size
        return Stretch(time, ticks["hall_voltage"].copy(), ticks["duty"].copy(), ticks["angle"].copy())


@kernel
def close_supplied(
    parameters: Any, plant: Any, settings: Any, state: Any, ticks: Any, supply_voltage: Any, period: float
) -> None:
    """Run the PIFLC against the plant on from where they are, `period` [s] apart, on a supply [V] of each tick."""
    for index in range(ticks.size):
        tick = ticks[index]
        sample(parameters, plant, state, tick)
        law.step(settings, state, tick.setpoint, tick.hall_voltage, period)
        advance(parameters, plant, tick.duty, supply_voltage[index], True, period)


def wandering_supply(
    seconds: int, low: float, high: float, time_constant: float, random: np.random.Generator
) -> Signal:
    """A supply [V] that wanders between `low` and `high`, second by second, shape (seconds,).

    A first-order Gauss-Markov process that forgets within `time_constant` [s]; `low` and `high` lie two standard
    deviations from its middle, and it is reflected there.
    """
    keep = np.exp(-1.0 / time_constant)
    shocks = np.sqrt(1.0 - keep**2) * random.standard_normal(seconds)
    course = np.empty(seconds)
    course[0] = np.clip(random.standard_normal(), -2.0, 2.0)
    for second in range(1, seconds):
        reached = keep * course[second - 1] + shocks[second]
        course[second] = 2.0 * np.clip(reached, -2.0, 2.0) - reached
    return 0.5 * (low + high) + 0.25 * (high - low) * course
