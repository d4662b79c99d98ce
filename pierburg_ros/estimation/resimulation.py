"""A recording simulated again: its inputs, where the shaft stood at the start, and the model's answer."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from pierburg_ros.actuators import Actuator
from pierburg_ros.errors import InputError
from pierburg_ros.estimation.start import Start, scale_of
from pierburg_ros.plant import Inputs, Model, simulate_many
from pierburg_ros.recording.recording import Recording

Signal = NDArray[np.float64]


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


def inputs_in_force(recording: Recording, start: Start, actuator: Actuator) -> Inputs:
    """`inputs_of` a recording of a running `actuator`, seen to begin at `start`.

    Away from the closed stop only a duty holds the shaft against its spring: there the first one has been in force
    before the recording began.
    """
    inputs = inputs_of(recording)
    angle, _ = start.state(Model.nominal(actuator), recording.quantity)
    return inputs.held_before() if angle > actuator.lower_stop else inputs


class Resimulation:
    """One recording made ready to be simulated many times."""

    def __init__(self, recording: Recording, actuator: Actuator) -> None:
        if recording.quantity == "hall_voltage" and actuator.quantity == "position":
            raise InputError(
                f"{recording.name} holds a Hall voltage and actuator {actuator.name} measures its angle;"
                " expected a recorded position. Choose another --actuator."
            )
        self.recording = recording
        self.start = Start.of(recording.time, recording.measured)
        self.inputs = inputs_in_force(recording, self.start, actuator)
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
            output[chosen] = simulate_many(group, self.inputs, times, *state, jobs=threads)
        if self._decodes:
            closed, per_radian = self._nominal_scale
            output = (output - closed) / per_radian
        return output


def resimulate(model: Model, recording: Recording) -> Signal:
    """What `model` would have measured over `recording`, in its unit, shape (samples,)."""
    return np.asarray(Resimulation(recording, model.actuator).simulated([model])[0])
