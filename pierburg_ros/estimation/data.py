"""All recordings of one actuator as a fit uses them: runs, noise, and training, validation and test samples."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from pierburg_ros.actuators import Actuator, Scales
from pierburg_ros.arrays import Flags, Signal
from pierburg_ros.effects import DECLARED, STEP
from pierburg_ros.errors import InputError
from pierburg_ros.estimation.batch import Batch, batches
from pierburg_ros.estimation.likelihood import coarse_step, lasting_rounding
from pierburg_ros.estimation.run import Run, Switch, parts_of, run_of
from pierburg_ros.estimation.stamp_noise import stamp_noise
from pierburg_ros.plant import Model
from pierburg_ros.plant.decode import angle_per_unit
from pierburg_ros.recording import Recording
from pierburg_ros.recording.loss import Span
from pierburg_ros.recording.noise import noise_of

BLOCK = 15.7
"""Length of the blocks that train, validate and test in turn, in the actuator's own time; less in a recording shorter
than 16 of them. Chosen: 1.5 s for the valve. Each part then has some movements and standstills, and a block is longer
than the 1.15 s in which the valve forgets; not varied."""
CYCLE = 8
"""Number of blocks in a cycle: the third validates, the seventh tests, and the others train. Chosen: an eighth each, as
far apart as possible; not varied."""
FIRST_PART = 2 * CYCLE * BLOCK
"""Length of the part of a recording that a first fit uses, in the actuator's own time. Derived: two cycles of eight
blocks, so that every kind of block occurs twice."""

WILD = 1e6
"""Largest error [noise]; larger ones are clipped to it. Derived: its square, summed over a day at 1 kHz, is 1e20. An
unstable simulation reaches values whose squares are no numbers."""
UNSIMULATED = 1e3
"""Error [noise] that is used where a model cannot be simulated. Chosen: more than any error, in noises, of a model that
can be simulated; not varied."""

UNKNOWN = "messages of the duty are missing"
"""The reason for leaving out spans without a known input."""


@dataclass(frozen=True)
class Omission:
    """A `span` [s] of recording `number` that is left out, or in which samples are left out, and the reason."""

    number: int
    span: Span
    why: str


@dataclass(frozen=True)
class Data:
    """All recordings of one actuator.

    `noise` is the standard deviation of the error that no model can explain. It comes from the sensor noise,
    `sensor_noise`, from missing messages of the duty, and from wrong stamps. `step` is that of the converter where it
    is coarse beside the noise, otherwise 0. These are in the measured unit. `left_out` are spans without a known input,
    and spans that say nothing of the actuator for other reasons. A summary begins with the `warnings` about recordings
    that lack messages and the `remarks` on those that are dirty. `disturbed`: a quantity that was not measured is taken
    to have wandered. `unlike` [measured unit, root mean square] is the part of the noise that moves whole stretches and
    not single samples, so that an error of this size is no evidence. It comes from missing messages of the duty, wrong
    stamps, and errors that are `kept_apart`. `rounding` is that of `lasting_rounding`.
    """

    actuator: Actuator
    runs: tuple[Run, ...]
    noise: float
    step: float = 0.0
    sensor_noise: float = 0.0
    left_out: tuple[Omission, ...] = ()
    warnings: tuple[str, ...] = ()
    remarks: tuple[str, ...] = ()
    disturbed: bool = False
    unlike: float = 0.0
    rounding: float = 0.0

    def kept_apart(self, size: float) -> Data:
        """The same with an error of this `size` [measured unit, root mean square] as noise that is no evidence."""
        return replace(self, noise=math.hypot(self.noise, size), unlike=math.hypot(self.unlike, size))

    @property
    def several(self) -> bool:
        """Whether there is more than one recording."""
        return self.runs[0].number != self.runs[-1].number

    def residual(self, model: Model, switch: Switch | None = None) -> Signal:
        """Measured minus simulated over all runs, shape (samples,), in units of the noise.

        Where a model cannot be simulated, the residual is very large but a number. Its sign alternates, so that no
        sample predicts the next.
        """
        simulated = np.concatenate([batch.simulated(model, switch) for batch in self._batches])
        whole = (self.measured - simulated) / self.noise
        missing = np.flatnonzero(~np.isfinite(whole))
        whole[missing] = UNSIMULATED * (1.0 - 2.0 * (missing % 2))
        return np.asarray(np.clip(whole, -WILD, WILD))

    @cached_property
    def _batches(self) -> tuple[Batch, ...]:
        return tuple(batches(self.runs))

    @cached_property
    def measured(self) -> Signal:
        """What was measured over all runs, shape (samples,), in its own unit."""
        return np.concatenate([run.measured for run in self.runs])

    @property
    def input_filtered(self) -> bool:
        """Whether an input was recorded behind a filter of known time constant: a delay may come from it."""
        return any(run.input_lag > 0.0 for run in self.runs)

    @property
    def in_stretches(self) -> bool:
        """Whether runs are simulated in stretches, since the actuator does not forget its initial state."""
        return any(run.shooting is not None for run in self.runs)

    @property
    def longest(self) -> Run:
        """The longest run of the first recording: the whole recording, unless messages are missing."""
        first = self.runs[0].number
        return max((run for run in self.runs if run.number == first), key=lambda run: run.time.size)

    @property
    def scales(self) -> Scales:
        """What is large for the actuator."""
        return self.actuator.scales

    @property
    def half_step(self) -> float:
        """Half a step of the converter in units of the noise, 0 where steps are fine."""
        return 0.5 * self.step / self.noise

    @property
    def duration(self) -> float:
        """Time of the last sample of the first recording [s]."""
        first = self.runs[0].number
        return max(float(run.time[-1]) for run in self.runs if run.number == first)

    @property
    def angle_per_unit(self) -> float:
        """Angle of one unit of the measured quantity [rad/V], or 1 where the angle itself is measured."""
        return angle_per_unit(Model.nominal(self.actuator))

    def cut(self, duration: float) -> Data:
        """The first `duration` [s] of each run."""
        return self.changed(lambda run: run.cut(duration))

    @property
    def first_part(self) -> Data:
        """The first part of each run: enough to tell what one more quantity promises, in a fraction of the time."""
        return self.cut(FIRST_PART * self.scales.time)

    def changed(self, run_of: Callable[[Run], Run]) -> Data:
        """The same with each run replaced by the result of `run_of`."""
        return replace(self, runs=tuple(map(run_of, self.runs)))

    def only(self, number: int) -> Data:
        """The recording `number` alone."""
        return replace(self, runs=tuple(run for run in self.runs if run.number == number))

    def without(self, number: int) -> Data:
        """All recordings except `number`."""
        return replace(self, runs=tuple(run for run in self.runs if run.number != number))

    @property
    def train(self) -> Flags:
        """Which samples of `residual` are for training."""
        return np.concatenate([run.train for run in self.runs])

    @property
    def validation(self) -> Flags:
        """Which samples of `residual` decide between explanations that fit the training samples alike."""
        return np.concatenate([run.validation for run in self.runs])

    @property
    def test(self) -> Flags:
        """Which samples of `residual` are used by neither fit nor choice."""
        return ~(self.train | self.validation)


def data_of(recordings: Sequence[Recording], model: Model, without: Sequence[Omission] = ()) -> Data:
    """The recordings `without` some spans, all for training; noise and converter are estimated from them.

    InputError where they cannot be fitted.
    """
    if not recordings:
        raise InputError("There is no recording to fit; expected one or more. Name a file.")
    if len({recording.quantity for recording in recordings}) > 1:
        raise InputError("The recordings hold Hall voltage and position; expected one quantity. Fit them one by one.")
    spans = [tuple(each.span for each in without if each.number == number) for number in range(len(recordings))]
    cut = [parts_of(recording, model, out) for recording, out in zip(recordings, spans, strict=True)]
    runs = tuple(
        run_of(part, model, number, whole)
        for number, (whole, (parts, _)) in enumerate(zip(recordings, cut, strict=True))
        for part in parts
    )
    noise = float(np.median([noise_of(run.time, run.measured) for run in runs]))
    lost = float(np.median([found.uncertainty for _, found in cut]))
    stamped = float(np.median([stamp_noise(part, model) for parts, _ in cut for part in parts]))
    unknown = (Omission(number, span, UNKNOWN) for number, (_, found) in enumerate(cut) for span in found.left_out)
    finest, _ = DECLARED[STEP].expected(model.scales)
    measured = [run.measured for run in runs]
    step, rounding = coarse_step(measured, noise, finest), lasting_rounding(measured, noise)
    warnings = tuple(f"{each.name}: {each.warning}" for each in recordings if each.warning)
    whole = Data(model.actuator, runs, noise, step, noise, (*unknown, *without), warnings, rounding=rounding)
    return whole.kept_apart(math.hypot(lost, stamped))


def in_parts(data: Data) -> Data:
    """`data` with its samples split into training, validation and test blocks."""

    def split(run: Run) -> Run:
        number = _block(data, run) % CYCLE
        kept = number % (CYCLE // 2) == CYCLE // 4
        return replace(run, train=~kept, validation=kept & (number < CYCLE // 2))

    return replace(data, runs=tuple(split(run) for run in data.runs))


def held_back(data: Data) -> Data:
    """`data` with a third of the training blocks held back from the fit as well, for a choice before the last one."""
    runs = (run.trained_on(run.train & (_block(data, run) % (CYCLE // 2) != 0)) for run in data.runs)
    return replace(data, runs=tuple(runs))


def with_validation(data: Data) -> Data:
    """`data` with its validation samples for training as well, for the last fit after the choice."""
    return replace(data, runs=tuple(run.trained_on(run.train | run.validation) for run in data.runs))


def all_training(data: Data) -> Data:
    """`data` with every sample for training."""
    return replace(data, runs=tuple(run.trained_on(np.ones_like(run.train)) for run in data.runs))


def rms(values: Signal) -> float:
    """Root mean square, in the unit of `values`."""
    return float(np.sqrt(np.mean(np.square(values))))


def _block(data: Data, run: Run) -> np.ndarray:
    """Block number of each sample of a run, from the start of its recording; a short recording has shorter blocks."""
    times = [each.time for each in data.runs if each.number == run.number]
    start, end = times[0][0], times[-1][-1]
    return np.asarray(
        np.floor((run.time - start) / min(BLOCK * data.scales.time, (end - start) / (2 * CYCLE))).astype(int)
    )
