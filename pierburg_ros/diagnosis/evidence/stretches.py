"""Recordings cut into stretches, each simulated from the measured state."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

import numpy as np

from pierburg_ros.diagnosis.evidence.motion import Motion, motion_of
from pierburg_ros.effects import EFFECT
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.initial_state import InitialState
from pierburg_ros.estimation.run import Run

SETTLED = 5
"""Samples on either side of a restart over which the angle is averaged; also the shortest length of a stretch. Derived:
the mean of eleven is known to 0.3 of the noise."""


def forgotten(effects: Iterable[str]) -> bool:
    """Whether no effect remembers longer than a stretch: an effect that does cannot be restarted."""
    return all(EFFECT[effect].memory != "lasting" for effect in effects)


def in_stretches(data: Data, length: float) -> Data:
    """`data` in stretches of `length` [s], unless its runs are simulated in stretches already.

    They are if the actuator does not forget its initial state. A simulation over `length` may then end anywhere.
    """
    return data if data.in_stretches else restarted(data, length)


def restarted(data: Data, length: float) -> Data:
    """`data` with every run cut into stretches of `length` [s], each starting at the measured angle and velocity.

    Loads keep the time of the recording; all else that a model remembers (heat, play, bristles) is reset.
    """
    runs = tuple(
        stretch for run in data.runs for stretch in _stretches(run, motion_of(run, data.actuator, data.noise), length)
    )
    return replace(data, runs=runs)


def leading_to(data: Data, length: float, last: float) -> Data:
    """Stretches of `length` [s] that lead to test samples, each from the measured angle and velocity.

    The test samples lie within the `last` [s] of each stretch; its other samples train. A test sample too near the
    beginning of its run has no stretch.
    """
    runs = tuple(
        stretch
        for run in data.runs
        for stretch in _leading(run, motion_of(run, data.actuator, data.noise), length, last)
    )
    return replace(data, runs=runs)


def _leading(run: Run, motion: Motion, length: float, last: float) -> Iterator[Run]:
    test = ~(run.train | run.validation)
    number = np.floor((run.time - run.time[0] - (length - last)) / last + 1e-9).astype(int)
    for part in np.unique(number[test & (number >= 0)]).tolist():
        inside = np.flatnonzero(test & (number == part))
        first = int(np.searchsorted(run.time, run.time[0] + part * last - 1e-9))
        if inside[-1] + 1 - first < SETTLED:
            continue
        stretch = run.part(slice(first, int(inside[-1]) + 1))
        train = np.ones(stretch.time.size, dtype=bool)
        train[inside - first] = False
        yield replace(stretch.trained_on(train), start=_start(run, motion, first), shooting=None)


def _stretches(run: Run, motion: Motion, length: float) -> list[Run]:
    number = np.floor((run.time - run.time[0]) / length + 1e-9).astype(int)
    cuts = np.flatnonzero(np.diff(number, prepend=-1))
    stretches = []
    for first, last in zip(cuts, np.append(cuts[1:], run.time.size), strict=True):
        if last - first < SETTLED:
            continue
        part = run.part(slice(int(first), int(last)))
        stretches.append(replace(part, start=_start(run, motion, int(first)), shooting=None))
    return stretches


def _start(run: Run, motion: Motion, sample: int) -> InitialState:
    """The initial state from the samples around `sample`: their mean while the shaft stands still, with its velocity
    otherwise."""
    if sample == 0 and run.shooting is None:
        return run.start
    near = slice(max(sample - SETTLED, 0), sample + SETTLED + 1)
    middle = float(np.mean(run.time[near])) - float(run.time[sample])
    stands = motion.closed[sample] or motion.open[sample] or not motion.moving[sample]
    if run.quantity == "speed":
        return InitialState(float(run.measured[sample]), 0.0, run.start.noise, True, float(motion.angle[sample]))
    rate, curvature = (
        0.0 if stands else float(course[sample]) / motion.angle_per_unit
        for course in (motion.velocity, motion.acceleration)
    )
    level = float(np.mean(run.measured[near])) - rate * middle
    return InitialState(level, rate, run.start.noise, True, float(motion.angle[sample]), curvature)
