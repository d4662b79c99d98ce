"""Recordings cut into stretches that are each simulated from the measured state."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from pierburg_ros.diagnosis.evidence.motion import Motion, motion_of
from pierburg_ros.effects import EFFECT
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.initial_state import InitialState
from pierburg_ros.estimation.run import Run

SETTLED = 5
"""Samples to either side of a restart over which the angle is averaged, and the least that a stretch has. Derived: the
mean of eleven is known to 0.3 of the noise."""


def forgotten(effects: Iterable[str]) -> bool:
    """Whether none of some effects remembers longer than a stretch: what does cannot start afresh."""
    return all(EFFECT[effect].memory != "lasting" for effect in effects)


def restarted(data: Data, length: float) -> Data:
    """`data` with every run cut into stretches of `length` [s], each starting at the measured angle and velocity.

    Loads keep to the time of the recording; whatever else a model remembers (heat, play, bristles) starts afresh.
    """
    runs = tuple(
        stretch for run in data.runs for stretch in _stretches(run, motion_of(run, data.actuator, data.noise), length)
    )
    return replace(data, runs=runs)


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
    """What the samples around `sample` say: their mean while the shaft stands still, with its velocity as it moves."""
    if sample == 0 and run.shooting is None:
        return run.start
    near = slice(max(sample - SETTLED, 0), sample + SETTLED + 1)
    middle = float(np.mean(run.time[near])) - float(run.time[sample])
    stands = motion.closed[sample] or motion.open[sample] or not motion.moving[sample]
    if run.quantity == "speed":
        return InitialState(float(run.measured[sample]), 0.0, run.start.noise, True, float(motion.angle[sample]))
    rate = 0.0 if stands else float(motion.velocity[sample]) / motion.angle_per_unit
    level = float(np.mean(run.measured[near])) - rate * middle
    return InitialState(level, rate, run.start.noise, True, float(motion.angle[sample]))
