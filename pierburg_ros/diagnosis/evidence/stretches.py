"""Recordings cut into stretches that are each simulated from the measured state."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from pierburg_ros.diagnosis.evidence.data import EvidenceData, Run
from pierburg_ros.diagnosis.evidence.motion import Motion, motion_of
from pierburg_ros.effects import EFFECTS

SETTLED = 5
"""Samples to either side of a restart over which the angle is averaged while the shaft stands still."""
FEWEST = 5
"""A stretch has at least so many samples."""
REMEMBERED = frozenset(effect.id for effect in EFFECTS if effect.memory == "lasting")
"""Effects with a memory longer than any stretch: none shows them."""


def restarted(data: EvidenceData, length: float) -> EvidenceData:
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
        if last - first < FEWEST:
            continue
        angle, velocity = _state(run, motion, int(first))
        part = run.part(slice(int(first), int(last)))
        stretches.append(replace(part, initial_angle=angle, initial_velocity=velocity))
    return stretches


def _state(run: Run, motion: Motion, sample: int) -> tuple[float, float]:
    """Angle [rad] and velocity [rad/s] at `sample`: exactly on a stop where the shaft touches it."""
    if sample == 0:
        return run.initial_angle, run.initial_velocity
    actuator = motion.actuator
    for on, stop in ((motion.closed, actuator.lower_stop), (motion.open, actuator.upper_stop)):
        if on[sample]:
            return stop, 0.0
    near = slice(max(sample - SETTLED, 0), sample + SETTLED + 1)
    middle = float(np.mean(motion.time[near])) - float(motion.time[sample])
    velocity = float(motion.velocity[sample]) if motion.moving[sample] else 0.0
    angle = float(np.mean(motion.angle[near])) - velocity * middle
    return min(max(angle, actuator.lower_stop), actuator.upper_stop), velocity
