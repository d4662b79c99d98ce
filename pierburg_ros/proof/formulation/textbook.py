"""The textbook valve over time: constant fine steps between the instants where duty or supply change.

The step is 5 us, a third of the fastest pole (J R / k^2 = 15 us), which it damps rather than follows. With an armature
inductance the motor swings against it (some 800 Hz, for a few milliseconds), and an implicit step h damps that too
much, by the share h / 15 us: then the step is 2 us. With static friction a creeping shaft may stop or go on by a
thousandth of its speed: then the step is 1 us, which leaves 0.02 mV where 5 us were wrong by 11 mV (n = 1, in closed
loop). Halving any changes the Hall voltage by less than 0.2 mV (tested for every effect).
"""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from math import ceil
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pierburg_ros.kernel import kernel
from pierburg_ros.proof.formulation.electrics import drive, heat, motor_constant
from pierburg_ros.proof.formulation.loads import remember
from pierburg_ros.proof.formulation.motion import move
from pierburg_ros.proof.formulation.sensor import hall_voltage, resolved, sense
from pierburg_ros.proof.formulation.state import initial_state
from pierburg_ros.proof.formulation.values import record, textbook_values

STEP, INDUCTIVE_STEP, CREEPING_STEP = 5e-6, 2e-6, 1e-6  # s


@kernel
def step(state: Any, p: Any, duty: float, supply: float, enabled: bool, h: float) -> None:
    """Advance everything by `h` [s], in the order of the signal path."""
    torque, damping = drive(state, p, duty, supply, enabled, h)
    move(state, p, torque, damping, h)
    state.current = (torque - damping * state.motor_velocity) / motor_constant(state, p)
    heat(state, p, h)
    remember(state, p, h)
    sense(state, p, h)
    state.time += h


@kernel
def run(
    states: Any,
    values: Any,
    durations: Any,
    duties: Any,
    supplies: Any,
    enabled: Any,
    longest: float,
    voltage: Any,
) -> None:
    """March through the intervals; `voltage[k]` is the Hall voltage [V] at the start of interval k."""
    state = states[0]
    p = values[0]
    for k in range(durations.size):
        voltage[k] = resolved(hall_voltage(state, p), p)
        if durations[k] <= 0.0:
            continue
        count = ceil(durations[k] / longest - 1e-9)
        h = durations[k] / count
        for _ in range(count):
            step(state, p, duties[k], supplies[k], enabled[k], h)


def simulate_textbook(
    values: Mapping[str, float],
    time: ArrayLike,
    duty: ArrayLike,
    sample_times: ArrayLike | None = None,
    *,
    supply_voltage: ArrayLike | None = None,
    enabled: ArrayLike | None = None,
    initial_angle: float = 0.0,
    longest_step: float | None = None,
) -> NDArray[np.float64]:
    """Noise-free Hall voltage [V] at `sample_times` [s] (default `time`); `duty` [1] holds from each `time`.

    `values` are flat dotted names of section 7 of docs/contract.md; before the first (delayed) duty arrives, duty is 0.
    `supply_voltage` [V] and `enabled` [0/1], where given, are held like duty; `longest_step` [s] is the usual one.
    """
    complete = textbook_values(values)
    times = np.asarray(time, float)
    samples = times if sample_times is None else np.asarray(sample_times, float)
    acting = times + complete["input_delay.delay"]
    edges = np.unique(np.concatenate([samples, acting, times]))
    edges = edges[(edges >= samples[0]) & (edges <= samples[-1])]

    def held(signal: ArrayLike, since: NDArray[np.float64], before: float) -> NDArray[np.float64]:
        at = np.searchsorted(since, edges, side="right") - 1
        return np.where(at >= 0, np.asarray(signal, float)[at], before)

    supply = np.full(times.size, complete["supply_voltage"]) if supply_voltage is None else supply_voltage
    bridge = held(np.ones(times.size) if enabled is None else enabled, times, 1.0) > 0.5
    voltage = np.empty(edges.size)
    parameters = record(complete)
    run(
        initial_state(parameters, initial_angle),
        parameters,
        np.append(np.diff(edges), 0.0),
        held(duty, acting, 0.0),
        held(supply, times, complete["supply_voltage"]),
        bridge,
        usual_step(complete) if longest_step is None else longest_step,
        voltage,
    )
    chosen: NDArray[np.float64] = voltage[np.searchsorted(edges, samples)]
    return chosen


def usual_step(values: Mapping[str, float]) -> float:
    """Step [s] for a valve with these flat values."""
    if values["static_friction.breakaway_torque"] > values["coulomb_friction"]:
        return CREEPING_STEP
    return INDUCTIVE_STEP if values["armature_inductance.inductance"] > 0.0 else STEP


class TextbookPlant:
    """The textbook valve, stepped by its caller: same methods as `pierburg_ros.plant.Plant`."""

    def __init__(self, values: Mapping[str, float], noise: float = 0.0, seed: int = 0) -> None:
        self.noise = noise
        self._seed = seed
        self.values = values
        self.reset()

    @property
    def values(self) -> dict[str, float]:
        """Flat values in force; setting them keeps the state."""
        return dict(self._values)

    @values.setter
    def values(self, values: Mapping[str, float]) -> None:
        self._record = record(values)
        self._values = textbook_values(values)

    def reset(self, angle: float = 0.0) -> None:
        """Stand still at `angle` [rad], cold, with no duty under way and the noise from its start."""
        self._random = np.random.default_rng(self._seed)
        self._state = initial_state(self._record, angle)
        self._under_way: deque[tuple[float, float]] = deque()
        self._duty = 0.0

    @property
    def angle(self) -> float:
        """True shaft angle [rad]."""
        return float(self._state["angle"][0])

    @property
    def velocity(self) -> float:
        """True shaft velocity [rad/s]."""
        return float(self._state["velocity"][0])

    @property
    def time(self) -> float:
        """Time since the reset [s]."""
        return float(self._state["time"][0])

    def advance(self, duty: float, duration: float, supply_voltage: float | None = None, enabled: bool = True) -> None:
        """Hold `duty` [1] for `duration` [s]; with `input_delay` it acts that much later."""
        start = self.time
        self._under_way.append((start + self._values["input_delay.delay"], duty))
        supply = self._values["supply_voltage"] if supply_voltage is None else supply_voltage
        now, end = start, start + duration
        while self._under_way and self._under_way[0][0] < end - 1e-12:
            arrival, arriving = self._under_way.popleft()
            self._hold(max(arrival - now, 0.0), supply, enabled)
            now, self._duty = max(arrival, now), arriving
        self._hold(end - now, supply, enabled)

    def _hold(self, duration: float, supply: float, enabled: bool) -> None:
        durations = np.array([duration])
        signals = np.array([self._duty]), np.array([supply]), np.array([enabled])
        run(self._state, self._record, durations, *signals, usual_step(self._values), np.empty(1))

    def measure(self) -> float:
        """Hall voltage with noise, then resolution [V]."""
        ideal = hall_voltage(self._state[0], self._record[0])
        noisy = ideal + self.noise * self._random.standard_normal() if self.noise > 0 else ideal
        return float(resolved(noisy, self._record[0]))
