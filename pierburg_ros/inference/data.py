"""Recordings as a fit uses them: in one unit, with the samples that count, and blocks that are held out."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pierburg_ros.actuators import Actuator, Scales
from pierburg_ros.arrays import Flags, Signal
from pierburg_ros.effects import DECLARED, STEP
from pierburg_ros.effects.effect import Effect
from pierburg_ros.errors import InputError
from pierburg_ros.inference.evidence import coarse_step, lasting_rounding
from pierburg_ros.plant import Inputs, Model
from pierburg_ros.plant.decode import angle_per_unit, encoded
from pierburg_ros.recording import Recording
from pierburg_ros.recording.loss import Span
from pierburg_ros.recording.noise import noise_of

BLOCK = 15.7
"""Length of the blocks that are fitted, choose and judge in turn, in the actuator's own time; less where there would be
fewer than 16. Chosen: 1.5 s for the valve, longer than the 1.15 s in which it forgets; not varied."""
CYCLE = 8
"""Blocks in a cycle: one chooses, one judges, the others are fitted. Chosen: an eighth each; not varied."""
CHOOSES, JUDGES = 2, 6
"""Which of a cycle choose and judge, from 0 on. Chosen: as far apart as possible."""
GAP = 3.0
"""Median intervals from which an interval is a gap. Given: `gaps` is defined so in diagnosis.json."""
FIRST = 8
"""Samples that tell where a shaft starts and how fast it moves. Chosen: more would bend, fewer say nothing; a pulled
simulation forgets their error."""
SETTLING_TIMES = 8.0
"""The actuator's own times after which a simulation counts that does not begin on a stop: nothing else tells
its velocity, and how its gear is wound up. Derived: with both poles of its error there a pulled simulation keeps
(1 + 8) exp(-8) of it, 0.3 %."""
RESTING = 5.0
"""Noises within which the first samples are those of a shaft at rest. Derived: eight samples of white noise span more
in 1 of 500 recordings."""
BENT = 12.6
"""Squared noises that a line leaves of the first samples, above which a shaft accelerates. Derived: the 95 % quantile
of chi squared with the six degrees of freedom of a line through eight samples."""
STOP = 3.0
"""Noises within which a shaft starts on a stop. Derived: white noise stays within with 99.7 %."""
FORMULATION = 7.3e-5
"""Root mean square difference, as a share of the reading over the travel, between simulations of one effect that are
all correct. Derived: 0.3 mV of the valve's Hall voltage, the largest change over all effects if steps of 5 us replace
10 in the textbook form."""
FEWEST_SAMPLES = 200
"""Least number of samples of all recordings together. Chosen: ten for each quantity of a large explanation."""


@dataclass(frozen=True, eq=False)
class Run:
    """One recording, ready to be simulated, `measured` in the unit of the actuator's sensor.

    `shown` is where it begins, as `plant.decode.begun` reads it. `block` is the number of the block of each sample,
    `counts` whether its input is known, and `settled` whether a pulled simulation has forgotten what was not known at
    the beginning, or after an unknown input, all shape (samples,). `number` counts recordings.
    """

    name: str
    number: int
    inputs: Inputs
    time: Signal
    measured: Signal
    shown: Signal
    settled: Flags
    block: NDArray[np.int64]
    counts: Flags
    quantity: str

    @property
    def in_force(self) -> Signal:
        """The command in force at each sample, shape (samples,)."""
        return self.inputs.at(self.time).command


@dataclass(frozen=True, eq=False)
class Data:
    """All recordings of one actuator.

    `noise` is the standard deviation of the error that no model can explain, and `step` that of the converter where it
    is coarse beside the noise, otherwise 0, both in the measured unit. `rounding` is that of `lasting_rounding`. In
    each cycle of blocks the one that `chooses`, if any, and the one that `judges` are not fitted.
    """

    actuator: Actuator
    runs: tuple[Run, ...]
    noise: float
    step: float = 0.0
    rounding: float = 0.0
    warnings: tuple[str, ...] = ()
    chooses: int | None = CHOOSES
    judges: int = JUDGES

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
        """Time of the last sample of the longest recording [s]."""
        return max(float(run.time[-1]) for run in self.runs)

    @property
    def period(self) -> float:
        """Median time between samples [s]."""
        return float(np.median(np.concatenate([np.diff(run.time) for run in self.runs])))

    def obstacle(self, effect: Effect) -> str:
        """Why `effect` cannot act beside these recordings, in words; nothing where it can."""
        signal = effect.recorded_in
        if signal and all(getattr(run.inputs, signal) is not None for run in self.runs):
            return f"the recorded {signal.replace('_', ' ')} holds it already"
        return self.actuator.obstacle(effect)

    @cached_property
    def per_unit(self) -> float:
        """Angle [rad], or velocity [rad/s], of one measured unit."""
        return angle_per_unit(Model.nominal(self.actuator))

    @cached_property
    def block(self) -> NDArray[np.int64]:
        """Block number of each sample of all runs, shape (samples,)."""
        return np.concatenate([run.block for run in self.runs])

    @cached_property
    def counts(self) -> Flags:
        """Whether each sample of all runs counts: not before a simulation has settled."""
        return np.concatenate([run.counts & run.settled for run in self.runs])

    @cached_property
    def shown(self) -> tuple[float, float]:
        """Times [s] of the first and the last sample of a run that counts."""
        time = np.concatenate([run.time for run in self.runs])[self.counts]
        return float(np.min(time, initial=np.inf)), float(np.max(time, initial=0.0))

    def by_run(self, values: NDArray[Any]) -> list[NDArray[Any]]:
        """Values of all samples, shape (samples,), one array for each run."""
        return np.split(values, np.cumsum([run.time.size for run in self.runs])[:-1])

    @cached_property
    def train(self) -> Flags:
        """Which samples are fitted, shape (samples,)."""
        return np.asarray(self.counts & ~self.validation & ~self.test)

    @cached_property
    def validation(self) -> Flags:
        """Which samples choose between explanations."""
        return np.asarray(self.counts & (self.block % CYCLE == self.chooses))

    @cached_property
    def test(self) -> Flags:
        """Which samples neither fit nor choice uses."""
        return np.asarray(self.counts & (self.block % CYCLE == self.judges))


def data_of(recordings: Sequence[Recording], nominal: Model) -> Data:
    """The recordings as a fit uses them; InputError where they cannot be used."""
    refuse_unusable(recordings, nominal.actuator)
    actuator = nominal.actuator
    whole = sum(recording.duration for recording in recordings)
    length = min(BLOCK * actuator.scales.time, whole / (2 * CYCLE))
    runs, before = [], 0.0
    for number, recording in enumerate(recordings):
        block = np.floor((before + recording.time) / length).astype(np.int64)
        runs.append(run_of(recording, nominal, number, block))
        before += recording.duration
    data = _of_runs(recordings, tuple(runs), nominal)
    if (counted := int(np.count_nonzero(data.train))) < FIRST * CYCLE:
        names = ", ".join(recording.name for recording in recordings)
        raise InputError(
            f"{names} leaves {counted} samples to fit, expected {FIRST * CYCLE} at least: in the rest its"
            f" {actuator.input} is not known, or was not shortly before. Record again with fewer processes beside."
        )
    return data


def all_fitted(recordings: Sequence[Recording], nominal: Model) -> Data:
    """The recordings, of any length, with every sample fitted; InputError where they do not fit the actuator."""
    if not recordings:
        raise InputError("There is no recording to fit; expected one or more. Name a file.")
    none = (np.zeros(recording.time.size, dtype=np.int64) for recording in recordings)
    runs = (
        run_of(each, nominal, number, block) for number, (each, block) in enumerate(zip(recordings, none, strict=True))
    )
    return _of_runs(recordings, tuple(runs), nominal)


def _of_runs(recordings: Sequence[Recording], runs: tuple[Run, ...], nominal: Model) -> Data:
    """The runs of recordings, and what is known of their noise."""
    # no model is held to less than what two correct ones differ by
    least = FORMULATION * nominal.scales.reading
    noise = max(float(np.median([noise_of(run.time, run.measured) for run in runs])), least)
    measured = [run.measured for run in runs]
    finest, _ = DECLARED[STEP].expected(nominal.scales)
    step = coarse_step(measured, noise, finest)
    warnings = tuple(f"{each.name}: {each.warning}" for each in recordings if each.warning)
    return Data(nominal.actuator, runs, noise, step, lasting_rounding(measured, noise), warnings)


def run_of(recording: Recording, nominal: Model, number: int, block: NDArray[np.int64]) -> Run:
    """One recording as a run, with the block of each sample; InputError where it does not fit the actuator."""
    actuator = nominal.actuator
    refuse_others(recording, actuator)
    measured = recording.measured
    if recording.quantity == "position" and actuator.quantity == "hall_voltage":
        measured = encoded(nominal, measured)
    shown = start_of(recording.time, measured)
    inputs = inputs_of(recording)
    away = nominal.actuator.lower_stop + STOP * noise_of(recording.time, measured) * abs(angle_per_unit(nominal))
    first = (measured[0] - float(encoded(nominal, 0.0))) * angle_per_unit(nominal)
    on_stop = actuator.quantity == "hall_voltage" and first <= away
    if not on_stop and actuator.load != "none":
        # away from its stop only a command holds a shaft: the first one was in force before
        inputs = inputs.held_before()
    own, settling = actuator.scales.time, min(SETTLING_TIMES * actuator.scales.time, recording.duration / CYCLE)
    counts = np.ones(recording.time.size, dtype=bool)
    settled = recording.time >= recording.time[0] + (0.0 if on_stop else settling)
    for start, end in unknown_spans(recording, actuator):
        counts &= (recording.time < start) | (recording.time > end + own)
        # after longer than the shaft remembers no more is known of it than at a beginning
        lost = settling if end - start > own else own
        settled &= (recording.time < start) | (recording.time > end + lost)
    return Run(
        recording.name,
        number,
        inputs,
        recording.time,
        measured,
        shown,
        settled,
        block,
        counts,
        actuator.quantity,
    )


def unknown_spans(recording: Recording, actuator: Actuator) -> list[Span]:
    """Spans [s] in which messages of the input are missing, and it may have moved the shaft by more than the noise.

    Not those that are shorter than the actuator's own time, if a step between the inputs before and after one, at any
    moment in it, moves the shaft less.
    """
    if not recording.unknown_input:
        return []
    scales, command = actuator.scales, recording.command
    largest = float(np.max(np.abs(command.values), initial=0.0)) or 1.0
    speed = scales.reading / scales.time if recording.quantity != "position" else scales.angle / scales.time
    noise, found = noise_of(recording.time, recording.measured), []
    for start, end in recording.unknown_input:
        before, after = command.at(np.array([start, end]), before=0.0)
        # a step at any moment: its mean is off by its size over the square root of 12
        moved = speed * (end - start) * abs(after - before) / (math.sqrt(12.0) * largest)
        if end - start > scales.time or moved > noise:
            found.append((start, end))
    return found


def inputs_of(recording: Recording) -> Inputs:
    """The inputs of the actuator in `recording`: the command, and supply voltage and bridge state where recorded.

    Each channel holds its value until its next one. Before its first value the command is 0, the bridge enabled, the
    supply voltage the first one recorded.
    """
    channels = [recording.command, recording.supply_voltage, recording.enabled]
    times = np.unique(np.concatenate([channel.time for channel in channels if channel is not None]))
    command = recording.command.at(times, before=0.0)
    if recording.input == "duty":
        command = np.clip(command, -1.0, 1.0)
    supply = recording.supply_voltage.at(times) if recording.supply_voltage is not None else None
    enabled = recording.enabled.at(times, before=1.0) > 0.5 if recording.enabled is not None else None
    return Inputs(times, command, supply, enabled)


def start_of(time: Signal, measured: Signal) -> Signal:
    """Level, rate [1/s], curvature, margin of a stop, and way of coming at the first sample, shape (5,)."""
    noise, first = noise_of(time, measured), measured[:FIRST]
    if np.ptp(first) <= RESTING * noise:
        return np.array([np.mean(first), 0.0, 0.0, STOP * noise, 0.0])
    since = time[:FIRST] - time[0]
    line = np.polyfit(since, first, 1)
    missed = np.sum(np.square(first - np.polyval(line, since)))
    bend, rate, level = np.polyfit(since, first, 2) if missed > BENT * noise**2 else (0.0, *line)
    return np.array([level, rate, 2.0 * bend, STOP * noise, 0.0])


def refuse_others(recording: Recording, actuator: Actuator) -> None:
    """InputError where a recording holds another input or quantity than the actuator has."""
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


def refuse_unusable(recordings: Sequence[Recording], actuator: Actuator) -> None:
    """InputError where the recordings together are too short to be fitted and judged."""
    if not recordings:
        raise InputError("There is no recording to fit; expected one or more. Name a file.")
    samples = sum(recording.time.size for recording in recordings)
    duration, shortest = sum(recording.duration for recording in recordings), 2 * CYCLE * actuator.scales.time
    if samples < FEWEST_SAMPLES or duration < shortest:
        names = ", ".join(recording.name for recording in recordings)
        raise InputError(
            f"{names} is too short ({samples} samples over {duration:#.3g} s); expected at least {FEWEST_SAMPLES}"
            f" samples over {shortest:.2g} s. Record longer: a minute with movements in both directions tells most."
        )
