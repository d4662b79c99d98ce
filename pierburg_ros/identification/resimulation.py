"""A recording simulated again: its inputs, where the shaft stood at the start, and the model's answer."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pierburg_ros.actuators import Actuator
from pierburg_ros.errors import InputError
from pierburg_ros.plant import Inputs, Model, simulate_many
from pierburg_ros.recording.noise import noise_of
from pierburg_ros.recording.recording import Recording

Signal = NDArray[np.float64]
RIGHT_ANGLE = math.pi / 2
LONGEST_START = 250
"""Most samples at the start of a recording that say where the shaft stood."""


def inputs_of(recording: Recording) -> Inputs:
    """What drove the actuator in `recording`: duty, and supply voltage and bridge state where recorded.

    Each channel holds its value until its next one. Before its first value duty is 0, the bridge enabled, the
    supply voltage the first one recorded.
    """
    channels = [recording.duty, recording.supply_voltage, recording.enabled]
    times = np.unique(np.concatenate([channel.time for channel in channels if channel is not None]))
    duty = np.clip(recording.duty.at(times, before=0.0), -1.0, 1.0)
    supply = recording.supply_voltage.at(times) if recording.supply_voltage is not None else None
    enabled = recording.enabled.at(times, before=1.0) > 0.5 if recording.enabled is not None else None
    return Inputs(times, duty, supply, enabled)


@dataclass(frozen=True)
class Start:
    """What the first samples of a recording say: level, rate [1/s] and noise, in the measured unit."""

    level: float
    rate: float
    noise: float

    @staticmethod
    def of(recording: Recording) -> Start:
        """Mean of the samples before the first movement, or a line where the shaft moves at once."""
        measured, noise = recording.measured, noise_of(recording.time, recording.measured)
        still = np.abs(measured[:LONGEST_START] - np.median(measured[:5])) <= 5.0 * noise + 1e-12
        length = int(np.argmin(still)) if not still.all() else still.size
        if length >= 10:
            return Start(float(np.mean(measured[:length])), 0.0, noise)
        few = min(8, measured.size)
        rate, level = np.polyfit(recording.time[:few], measured[:few], 1)
        return Start(float(level), float(rate), noise)

    def state(self, model: Model, quantity: str) -> tuple[float, float]:
        """Angle [rad] and velocity [rad/s] at the first sample; exactly on a stop where noise allows it."""
        closed, per_radian = scale_of(model, quantity)
        angle = _unbent(model, (self.level - closed) / per_radian)
        margin = 3.0 * self.noise / abs(per_radian)
        lower, upper = model.actuator.lower_stop, model.actuator.upper_stop
        if angle <= lower + margin:
            return lower, 0.0
        if angle >= upper - margin:
            return upper, 0.0
        return angle, self.rate / per_radian


def scale_of(model: Model, quantity: str) -> tuple[float, float]:
    """Measured value at angle 0 and its change per rad, for a recorded `quantity`."""
    if quantity == "position":
        return 0.0, 1.0
    closed, opened = model.values["hall_voltage_closed"], model.values["hall_voltage_open"]
    return closed, (opened - closed) / RIGHT_ANGLE


def _unbent(model: Model, indicated: float) -> float:
    """Angle [rad] that a bent sensor characteristic shows as `indicated` [rad]."""
    amplitude, waves = (model.values[f"sensor_nonlinearity.{name}"] for name in ("amplitude", "half_waves"))
    angle = indicated
    for _ in range(20 if amplitude else 0):
        angle = indicated - RIGHT_ANGLE * amplitude * math.sin(2.0 * waves * angle)
    return angle


class Resimulation:
    """One recording made ready to be simulated many times."""

    def __init__(self, recording: Recording, actuator: Actuator) -> None:
        if recording.quantity == "hall_voltage" and actuator.quantity == "position":
            raise InputError(
                f"{recording.name} holds a Hall voltage and actuator {actuator.name} measures its angle;"
                " expected a recorded position. Choose another --actuator."
            )
        self.recording = recording
        self.inputs = inputs_of(recording)
        self.start = Start.of(recording)
        self._decodes = recording.quantity == "position" and actuator.quantity == "hall_voltage"
        self._nominal_scale = scale_of(Model.nominal(actuator), actuator.quantity)

    def simulated(self, models: Sequence[Model], threads: int | None = None) -> Signal:
        """What each of `models` would have measured, in the recording's unit, shape (models, samples).

        A position recorded from a Hall sensor is its voltage decoded with the nominal ends.
        """
        quantity, times = self.recording.quantity, self.recording.time
        states = [self.start.state(model, quantity) for model in models]
        output = np.empty((len(models), times.size))
        for state in sorted(set(states)):
            chosen = [index for index, other in enumerate(states) if other == state]
            group = [models[index] for index in chosen]
            output[chosen] = simulate_many(group, self.inputs, times, *state, threads=threads)
        if self._decodes:
            closed, per_radian = self._nominal_scale
            output = (output - closed) / per_radian
        return output


def resimulate(model: Model, recording: Recording) -> Signal:
    """What `model` would have measured over `recording`, in its unit, shape (samples,)."""
    return np.asarray(Resimulation(recording, model.actuator).simulated([model])[0])
