"""What the diagnosis looks at: recordings as arrays, split into samples that train, that choose and that judge."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pierburg_ros.actuators import Actuator
from pierburg_ros.arrays import Signal
from pierburg_ros.diagnosis.evidence.resolution import coarse_step
from pierburg_ros.errors import InputError
from pierburg_ros.estimation.resimulation import inputs_in_force
from pierburg_ros.estimation.start import Start, from_standstill
from pierburg_ros.plant import Inputs, Model, simulate, simulate_switched
from pierburg_ros.plant.decode import angle_per_unit
from pierburg_ros.recording import Recording
from pierburg_ros.recording.noise import noise_of

BLOCK = 1.5
"""Length of the blocks [s] that train, choose and judge in turn: some movements and standstills in each part."""
CYCLE = 8
"""Of so many blocks one chooses between explanations that fit the others alike, and one judges: no fit uses either."""
CHOOSING, JUDGING = 2, 6
"""Which they are."""


@dataclass(frozen=True)
class Switch:
    """Another model that takes over at `time` [s]: a parameter that changed in the middle of a recording."""

    model: Model
    time: float


@dataclass(frozen=True)
class Run:
    """One recording, ready to be simulated: inputs, samples, start, and which samples train or choose; others judge."""

    name: str
    inputs: Inputs
    time: Signal
    measured: Signal
    initial_angle: float
    initial_velocity: float
    training: NDArray[np.bool_]
    choosing: NDArray[np.bool_]

    def simulated(self, model: Model, switch: Switch | None = None) -> Signal:
        """What `model` makes of the inputs, in the measured unit, shape (samples,).

        With a `switch` another model takes over in the middle, and the state goes on.
        """
        start = (self.initial_angle, self.initial_velocity)
        if switch is None:
            return simulate(model, self.inputs, self.time, *start)
        return simulate_switched(model, switch.model, switch.time, self.inputs, self.time, *start)

    def cut(self, duration: float) -> Run:
        """The first `duration` [s] of the run."""
        return self.part(slice(0, max(int(np.searchsorted(self.time, self.time[0] + duration)), 2)))

    def part(self, kept: slice) -> Run:
        """Some successive samples of the run."""
        return replace(
            self,
            time=self.time[kept],
            measured=self.measured[kept],
            training=self.training[kept],
            choosing=self.choosing[kept],
        )

    def trained_on(self, training: NDArray[np.bool_]) -> Run:
        """The run with other samples training, shape (samples,); what trains chooses no longer."""
        return replace(self, training=training, choosing=self.choosing & ~training)


@dataclass(frozen=True)
class EvidenceData:
    """All recordings of one actuator.

    `noise` is the standard deviation of the sensor noise, `step` that of the converter where it is coarse beside the
    noise, otherwise 0, both in the measured unit.
    """

    actuator: Actuator
    runs: tuple[Run, ...]
    noise: float
    step: float = 0.0

    def residual(self, model: Model, switch: Switch | None = None) -> Signal:
        """Measured minus simulated over all runs, shape (samples,), in units of the noise."""
        parts = [run.measured - run.simulated(model, switch) for run in self.runs]
        return np.concatenate(parts) / self.noise

    @property
    def half_step(self) -> float:
        """Half a step of the converter in units of the noise, 0 where steps are fine."""
        return 0.5 * self.step / self.noise

    def cut(self, duration: float) -> EvidenceData:
        """The first `duration` [s] of each run."""
        return replace(self, runs=tuple(run.cut(duration) for run in self.runs))

    @property
    def angle_per_unit(self) -> float:
        """Angle of one unit of the measured quantity [rad/V], or 1 where the angle itself is measured."""
        return angle_per_unit(Model.nominal(self.actuator))

    @property
    def training(self) -> NDArray[np.bool_]:
        """Which samples of `residual` train."""
        return np.concatenate([run.training for run in self.runs])

    @property
    def choosing(self) -> NDArray[np.bool_]:
        """Which samples of `residual` choose between explanations that fit those that train alike."""
        return np.concatenate([run.choosing for run in self.runs])

    @property
    def judging(self) -> NDArray[np.bool_]:
        """Which samples of `residual` neither fit nor choice has used."""
        return ~(self.training | self.choosing)

    @property
    def time(self) -> Signal:
        """Time of each sample of `residual`, from the first sample of its own run [s]."""
        return np.concatenate([run.time for run in self.runs])


def evidence_of(recordings: Sequence[Recording], actuator: Actuator) -> EvidenceData:
    """The recordings, ready for diagnosis; the noise is estimated from them. InputError where they do not fit."""
    for recording in recordings:
        if recording.quantity != actuator.quantity:
            raise InputError(
                f"{recording.name} holds {recording.quantity}, but actuator {actuator.name} measures "
                f"{actuator.quantity}. Choose the actuator that was recorded."
            )
    nominal = Model.nominal(actuator)
    runs = []
    for given in recordings:
        recording = from_standstill(given, nominal)
        start = Start.of(recording.time, recording.measured)
        angle, velocity = start.state(nominal, recording.quantity)
        inputs, time = inputs_in_force(recording, start, actuator), recording.time
        parts = training_blocks(time), choosing_blocks(time)
        runs.append(Run(recording.name, inputs, time, recording.measured, angle, velocity, *parts))
    noise = float(np.median([noise_of(run.time, run.measured) for run in runs]))
    return EvidenceData(actuator, tuple(runs), noise, coarse_step([run.measured for run in runs], noise))


def rms(values: Signal) -> float:
    """Root mean square, in the unit of `values`."""
    return float(np.sqrt(np.mean(np.square(values))))


def training_blocks(time: Signal) -> NDArray[np.bool_]:
    """True where a sample trains."""
    return ~np.isin(_block(time) % CYCLE, (CHOOSING, JUDGING))


def choosing_blocks(time: Signal) -> NDArray[np.bool_]:
    """True where a sample chooses between explanations."""
    return np.asarray(_block(time) % CYCLE == CHOOSING)


def held_back(data: EvidenceData) -> EvidenceData:
    """`data` with a third of the training blocks kept from the fit as well, for a choice before the last one."""
    runs = (run.trained_on(run.training & (_block(run.time) % (CYCLE // 2) != 0)) for run in data.runs)
    return replace(data, runs=tuple(runs))


def after_choice(data: EvidenceData) -> EvidenceData:
    """`data` with what has chosen training as well, for the last fit after the choice."""
    runs = (run.trained_on(run.training | run.choosing) for run in data.runs)
    return replace(data, runs=tuple(runs))


def _block(time: Signal) -> NDArray[np.int_]:
    """Number of the block of each sample; a short recording gets shorter blocks."""
    length = min(BLOCK, (time[-1] - time[0]) / (2 * CYCLE))
    return np.asarray(np.floor((time - time[0]) / length).astype(int))
