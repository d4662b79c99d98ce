"""Whole runs: one parameter set, or many in parallel, over the same inputs."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pierburg_ros.arrays import Signal
from pierburg_ros.errors import InputError
from pierburg_ros.kernel import kernel
from pierburg_ros.plant.model import Model
from pierburg_ros.plant.motion.events import settle
from pierburg_ros.plant.motion.watch import stood
from pierburg_ros.plant.parameters import NEUTRAL
from pierburg_ros.plant.signal_path import advance, recall
from pierburg_ros.plant.state import LOOKAHEAD, blank_state, place
from pierburg_ros.plant.torques.sensor import read_all
from pierburg_ros.workers import workers

LONG_BEFORE = 1e9
"""Time [s] after which neither a delayed command nor a current is still on its way: longer than any accepted one."""


@dataclass(frozen=True)
class Inputs:
    """What drives the plant: each row holds from its time until the next one.

    time [s], shape (changes,), increasing; the command is a duty in [-1, 1], a current [A] or a torque [N.m], as the
    actuator's drive asks; supply_voltage [V] or None for the model's; enabled, or None for always. Before the first row
    the command is 0.
    """

    time: Signal
    command: Signal
    supply_voltage: Signal | None = None
    enabled: NDArray[np.bool_] | None = None

    def __post_init__(self) -> None:
        time = np.ascontiguousarray(self.time, dtype=float)
        object.__setattr__(self, "time", time)
        for name, kind in (("command", float), ("supply_voltage", float), ("enabled", bool)):
            values = getattr(self, name)
            if values is not None:
                object.__setattr__(self, name, np.ascontiguousarray(values, dtype=kind))
                if np.shape(values) != time.shape:
                    raise InputError(
                        f"The input has {time.size} times and {np.size(values)} values of {name}; "
                        "expected one each. Give arrays of the same length."
                    )
        if not np.all(np.isfinite(self.command)):
            raise InputError("The command is not finite throughout; expected finite numbers. Remove what is missing.")
        if time.size == 0 or not np.all(np.isfinite(time)) or not np.all(np.diff(time) > 0):
            raise InputError("The input times are empty or do not increase; expected increasing times. Sort them.")

    def at(self, time: Signal) -> Inputs:
        """The same told at each `time` [s], increasing, shape (times,): what is in force then, 0 for no command yet."""
        place = np.searchsorted(self.time, time, side="right") - 1
        row = np.maximum(place, 0)
        supply = None if self.supply_voltage is None else self.supply_voltage[row]
        enabled = None if self.enabled is None else self.enabled[row]
        return Inputs(time, np.where(place < 0, 0.0, self.command[row]), supply, enabled)

    def held_before(self) -> Inputs:
        """The same, but for a first row that has been in force long before."""
        return replace(self, time=np.concatenate([self.time[:1] - LONG_BEFORE, self.time[1:]]))


def simulate(
    model: Model,
    inputs: Inputs,
    sample_times: ArrayLike,
    initial_angle: float = 0.0,
    initial_velocity: float = 0.0,
    initial_acceleration: float = 0.0,
    came: float = 0.0,
) -> Signal:
    """Measured quantity (V, or rad where the angle is measured) at `sample_times` [s], shape (samples,).

    No noise. The run starts at the first sample, at `initial_angle` [rad] with `initial_velocity` [rad/s], a sensor
    with a lag as after an even `initial_acceleration` [rad/s^2], one with play as after motion that `came` opening (+1)
    or closing (-1) where the shaft stands. It starts cold. Loads go by the time of the samples, and a command from
    before the first one is under way. Not a number from where a parameter set cannot be simulated.
    """
    times = _increasing(sample_times)
    output = np.empty(times.size)
    _run_into(output, model, inputs, times, initial_angle, initial_velocity, initial_acceleration, came)
    return output


def motor_torque(model: Model, inputs: Inputs, time: ArrayLike, velocity: ArrayLike = 0.0) -> Signal:
    """Torque [N.m] at the shaft that the inputs make at each `time` [s].

    Under a voltage at a `velocity` [rad/s], by equations (1) and (2) of the paper: at the model's own resistance, cold
    and without inductance or sag.
    """
    value = {**NEUTRAL, **model.values}
    place = np.searchsorted(inputs.time, np.asarray(time, dtype=float), side="right") - 1

    def held(values: Signal, before: float) -> Signal:
        return np.where(place < 0, before, values[np.maximum(place, 0)])

    enabled = np.ones(inputs.time.size) if inputs.enabled is None else inputs.enabled.astype(float)
    command = held(inputs.command * enabled, 0.0)
    drive = model.actuator.drive
    if drive == "torque":
        return np.asarray(value["torque_scale"] * command)
    constant = value["gear_ratio"] * value["torque_constant"]
    if drive == "current":
        return np.asarray(constant * command)
    supply = (
        np.full(inputs.time.size, value["supply_voltage"]) if inputs.supply_voltage is None else inputs.supply_voltage
    )
    generated = constant * np.asarray(velocity, dtype=float) * held(enabled, enabled[0])
    return np.asarray(constant / value["armature_resistance"] * (command * held(supply, supply[0]) - generated))


def refuse_unsimulated(model: Model, simulated: Signal, times: Signal) -> None:
    """Say that and from when on a run is not a number: InputError."""
    missing = np.flatnonzero(~np.isfinite(simulated))
    if missing.size:
        effects = ", ".join(model.active_effects) or "no effects"
        raise InputError(
            f"The model of {model.actuator.name} cannot be simulated with these values (from {times[missing[0]]:g} s"
            f" on; {effects}), expected a motion that the simulator can follow. Bring them closer to nominal."
        )


def simulate_many(
    models: Sequence[Model],
    inputs: Inputs,
    sample_times: ArrayLike,
    initial_angle: float = 0.0,
    initial_velocity: float = 0.0,
    jobs: int | None = None,
) -> Signal:
    """`simulate` for each of `models`, shape (sets, samples), `jobs` of them at a time (default: one for each core)."""
    times = _increasing(sample_times)
    output = np.empty((len(models), times.size))

    def run(index: int) -> None:
        _run_into(output[index], models[index], inputs, times, initial_angle, initial_velocity)

    with workers(jobs) as pool:
        list(pool.map(run, range(len(models))))
    return output


def _run_into(
    output: Signal,
    model: Model,
    inputs: Inputs,
    times: Signal,
    angle: float,
    velocity: float,
    acceleration: float = 0.0,
    came: float = 0.0,
) -> None:
    state = blank_state()
    start = float(angle), float(velocity), float(acceleration), float(came)
    run_from(model.record()[0], state[0], *channels(inputs), times, *start, output)


def channels(inputs: Inputs) -> tuple[Signal, Signal, Signal, NDArray[np.bool_]]:
    """The inputs as kernels take them: time [s], command, supply voltage [V] and enabled, empty where there is none."""
    supply = inputs.supply_voltage if inputs.supply_voltage is not None else _NOTHING
    enabled = inputs.enabled if inputs.enabled is not None else _ALWAYS
    return inputs.time, inputs.command, supply, enabled


def _increasing(sample_times: ArrayLike) -> Signal:
    """The sample times, if they increase; InputError otherwise."""
    times = np.ascontiguousarray(sample_times, dtype=float)
    if times.ndim != 1 or times.size == 0 or not _increase(times):
        raise InputError("The sample times are empty or do not increase; expected increasing times. Sort them.")
    return times


_NOTHING = np.empty(0)
_ALWAYS = np.empty(0, dtype=bool)


@kernel
def _increase(times):
    """Whether `times`, one or more, are finite and each later than the one before."""
    for index in range(1, times.size):
        if not times[index] > times[index - 1]:
            return False
    return np.isfinite(times[0]) and np.isfinite(times[-1])


@kernel
def begin(p, s, input_times, command, supply_voltage, enabled, time):
    """Begin at `time` [s], with the inputs from before it under way."""
    s.time = time
    earlier = np.searchsorted(input_times, time)
    if earlier > 0:
        supply = supply_voltage[earlier - 1] if supply_voltage.size > 0 else np.nan
        closed = enabled[earlier - 1] if enabled.size > 0 else True
        recall(p, s, input_times[:earlier], command[:earlier], supply, closed)
        settle(p, s)


@kernel
def run_from(
    p, s, input_times, command, supply_voltage, enabled, sample_times, angle, velocity, acceleration, came, output
):
    """`run` from where `place` puts `s` at the first sample; `s` is all zeros."""
    place(p, s, angle, velocity, acceleration, came)
    begin(p, s, input_times, command, supply_voltage, enabled, sample_times[0])
    run(p, s, input_times, command, supply_voltage, enabled, sample_times, output)


@kernel
def run(p, s, input_times, command, supply_voltage, enabled, sample_times, output):
    """Sample the plant at `sample_times` [s] into `output` while the inputs drive it; NaN from where it fails.

    What creeps beside the mechanics meets them at each sample; without it, samples are read from within the steps.
    """
    changes = input_times.size
    now = sample_times[0]
    index = np.searchsorted(input_times, now, side="right") - 1
    put = 0
    while put < sample_times.size:
        _look_ahead(s, sample_times, put)
        last = s.ahead.time[s.ahead.count - 1]
        stood(p, s, now)
        while s.sampled < s.ahead.count:
            in_force = command[index] if index >= 0 else 0.0
            supply = supply_voltage[index] if supply_voltage.size > 0 and index >= 0 else p.supply_voltage
            closed = enabled[index] if enabled.size > 0 and index >= 0 else True
            change = input_times[index + 1] if index + 1 < changes else math.inf
            until = min(s.ahead.time[s.sampled] if p.creeps else last, change)
            advance(p, s, in_force, supply, closed, until - now)
            now = until
            while index + 1 < changes and input_times[index + 1] <= now:
                index += 1
            if not math.isfinite(s.angle):
                break
            stood(p, s, now)
        read_all(p, s.ahead.shown[: s.sampled], output[put:])
        put += s.sampled
        if not math.isfinite(s.angle):
            output[put:] = np.nan
            break
    s.ahead.count = 0


@kernel
def _look_ahead(s, sample_times, put):
    """Have the samples after those `put` read next."""
    s.ahead.count, s.sampled = min(sample_times.size - put, LOOKAHEAD), 0
    for sample in range(s.ahead.count):
        s.ahead.time[sample] = sample_times[put + sample]
