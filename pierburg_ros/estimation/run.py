"""A recording ready to be simulated many times: its inputs, its samples and its initial state."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from pierburg_ros.arrays import Flags, Signal
from pierburg_ros.errors import InputError
from pierburg_ros.estimation.initial_state import EVEN, InitialState, first_rest, from_standstill
from pierburg_ros.estimation.pieces import Pieces, pieces
from pierburg_ros.estimation.shooting import Shooting, forgets, stretch_length
from pierburg_ros.estimation.torque_balance import ahead, goes_round, recorded_lag
from pierburg_ros.inference.data import inputs_of
from pierburg_ros.plant import Inputs, Model, lasting_state, simulate, simulate_switched
from pierburg_ros.plant.decode import decoded
from pierburg_ros.plant.simulate import refuse_unsimulated
from pierburg_ros.recording import Recording
from pierburg_ros.recording.loss import Span
from pierburg_ros.recording.noise import noise_of


@dataclass(frozen=True)
class Switch:
    """Another model that takes over at `time` [s]: a parameter that changed in the middle of a recording."""

    model: Model
    time: float


@dataclass(frozen=True)
class Run:
    """One recording, ready to be simulated.

    `time` [s] and `measured` (in the recording's unit) have shape (samples,); `start` is the state at the first
    samples. `train` and `validation`, shape (samples,), mark the samples for fits, and those that choose between
    explanations that fit alike. The rest is for tests: neither fit nor choice uses it. `decoder` is the model by whose
    sensor a Hall voltage was turned into the recorded position, None where it was not. `number` counts recordings: a
    recording that lacks messages makes several runs. With a `shooting`, the run is simulated in stretches. `input_lag`
    [s] is that of a filter behind which the input was recorded; it is removed from `inputs`. `since` is the start time
    of the whole recording and its initial state if this is a later part of it, otherwise None.
    """

    name: str
    inputs: Inputs
    time: Signal
    measured: Signal
    quantity: str
    start: InitialState
    train: Flags
    validation: Flags
    decoder: Model | None = None
    number: int = 0
    shooting: Shooting | None = None
    input_lag: float = 0.0
    since: tuple[float, InitialState] | None = None

    def simulated(self, model: Model, switch: Switch | None = None) -> Signal:
        """The response of `model` to the inputs, in the measured unit, shape (samples,).

        With a `switch` another model takes over in the middle, and the state continues.
        """
        if self.shooting is not None:
            return self._shot(self.shooting, model, switch)
        start, lasting = self.start.state(model, self.quantity), self._lasting(model)
        if switch is None:
            output = simulate(model, self.inputs, self.time, *start, lasting)
        else:
            output = simulate_switched(model, switch.model, switch.time, self.inputs, self.time, *start, lasting)
        return output if self.decoder is None else decoded(self.decoder, output)

    def _lasting(self, model: Model) -> np.ndarray | None:
        """The lasting state, such as heat, from before the first sample; None where nothing was before."""
        if self.since is None:
            return None
        time, start = self.since
        return lasting_state(model, self.inputs, time, self.time[0], *start.state(model, self.quantity))

    def _shot(self, shooting: Shooting, model: Model, switch: Switch | None) -> Signal:
        """The simulation in stretches; at a switch it changes from that of one model to that of the other."""
        output = shooting.simulated(model, self.inputs, self.time, self.measured, self.quantity)
        if switch is None:
            return output
        after = shooting.simulated(switch.model, self.inputs, self.time, self.measured, self.quantity)
        return np.where(self.time < switch.time, output, after)

    def cut(self, duration: float) -> Run:
        """The first `duration` [s] of the run."""
        return self.part(slice(0, max(int(np.searchsorted(self.time, self.time[0] + duration)), 2)))

    def part(self, kept: slice) -> Run:
        """The run with the successive samples `kept` only."""
        time, measured = self.time[kept], self.measured[kept]
        again = self.shooting and Shooting.of(time, measured, self.shooting.length, self.quantity)
        return replace(
            self,
            time=time,
            measured=measured,
            train=self.train[kept],
            validation=self.validation[kept],
            shooting=again,
        )

    def trained_on(self, train: Flags) -> Run:
        """The run with other samples for training, shape (samples,); these no longer validate."""
        return replace(self, train=train, validation=self.validation & ~train)


def parts_of(recording: Recording, model: Model, without: tuple[Span, ...] = ()) -> tuple[list[Recording], Pieces]:
    """The parts of `recording` that can be simulated, `without` some spans, and how it was cut.

    Each part starts from a standstill if the actuator forgets its initial state. There is one part where nothing is
    missing. Of several parts, each has at least twice the samples that determine where the shaft stands. InputError
    where no part can be simulated.
    """
    fewest = 2 * EVEN
    still = forgets(model.actuator)
    cut = pieces(from_standstill(recording, model) if still else recording, model, without)
    begun = _from_standstills(cut.parts) if still else cut.parts
    parts = [part for part in begun if part.time.size >= fewest or len(cut.parts) == 1]
    if not parts:
        raise InputError(
            f"{recording.name} has no stretch of {fewest} samples with a known duty that begins at a standstill"
            " (messages are missing). Record again with fewer processes beside."
        )
    return parts, cut


def _from_standstills(parts: list[Recording]) -> Iterator[Recording]:
    """The first part, and the others from where the shaft first rests.

    If the shaft moves after a gap, a simulation that begins with a small error would rest elsewhere.
    """
    yield parts[0]
    for part in parts[1:]:
        sample = first_rest(part.measured, noise_of(part.time, part.measured))
        if sample is not None:
            yield replace(part, time=part.time[sample:], measured=part.measured[sample:])


def run_of(recording: Recording, model: Model, number: int = 0, whole: Recording | None = None) -> Run:
    """`recording` from where the shaft first stands still, all of it for training; InputError where it does not fit.

    It may be a part of a `whole` recording, which shows how the shaft came to its place and how warm it is.
    """
    actuator, whole = model.actuator, whole or recording
    if recording.input != actuator.input:
        raise InputError(
            f"{recording.name} holds a {recording.input} and actuator {actuator.name} is driven by a {actuator.input};"
            f" expected a recorded {actuator.input}. Name it with --topic {actuator.input}=..., or choose another"
            " --actuator."
        )
    if "speed" in {recording.quantity, actuator.quantity} and recording.quantity != actuator.quantity:
        raise InputError(
            f"{recording.name} holds a {recording.quantity} and actuator {actuator.name} measures its"
            f" {actuator.quantity}; expected a recorded {actuator.quantity}. Choose another --actuator."
        )
    if recording.quantity == "hall_voltage" and actuator.quantity == "position":
        raise InputError(
            f"{recording.name} holds a Hall voltage and actuator {actuator.name} measures its angle;"
            " expected a recorded position. Choose another --actuator."
        )
    shooting = None
    if forgets(actuator):
        recording = from_standstill(recording, model)
    else:
        length = stretch_length(recording.time, recording.measured, recording.quantity)
        shooting = Shooting.of(recording.time, recording.measured, length, recording.quantity)
    before = whole.measured[whole.time < recording.time[0]]
    since = (whole.time[0], InitialState.of(whole.time, whole.measured)) if before.size else None
    start = InitialState.of(recording.time, recording.measured, before)
    decodes = recording.quantity == "position" and actuator.quantity == "hall_voltage"
    inputs, lag = inputs_in_force(recording, start, model), 0.0
    if shooting is not None and goes_round(model, recording.measured, recording.quantity):
        lag = recorded_lag(model, inputs, recording.time, recording.measured)
    return Run(
        recording.name,
        ahead(inputs, lag),
        recording.time,
        recording.measured,
        recording.quantity,
        start,
        np.ones(recording.time.size, dtype=bool),
        np.zeros(recording.time.size, dtype=bool),
        Model.nominal(actuator) if decodes else None,
        number,
        shooting,
        lag,
        since,
    )


def inputs_in_force(recording: Recording, start: InitialState, model: Model) -> Inputs:
    """`inputs_of` a recording that may begin while the actuator runs, with the initial state `start`.

    Away from the closed stop, only a duty holds the shaft against its spring. The first duty was then in force before
    the recording began.
    """
    inputs = inputs_of(recording)
    angle, *_ = start.state(model, recording.quantity)
    return inputs.held_before() if angle > model.actuator.lower_stop else inputs


def resimulated(model: Model, recording: Recording) -> tuple[Recording, Signal]:
    """The samples of `recording` that can be simulated, and their simulation by `model`, shape (samples,).

    InputError where none can be simulated.
    """
    parts, _ = parts_of(recording, Model.nominal(model.actuator))
    simulated = np.concatenate([run_of(part, model, whole=recording).simulated(model) for part in parts])
    time, measured = (np.concatenate([getattr(part, name) for part in parts]) for name in ("time", "measured"))
    refuse_unsimulated(model, simulated, time)
    return replace(parts[0], time=time, measured=measured), simulated
