"""A stretch that nothing which acts elsewhere explains: a hand on the lever, a bridge that was open."""

from __future__ import annotations

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.estimation.data import Data
from pierburg_ros.recording.loss import Span

BLOCK = 2.6
"""Length of the blocks over which errors are averaged, in the actuator's own time. Derived: 0.25 s for the valve, its
noise is then known to 6 % at 500 Hz."""
HIGH = 1.5
"""Error of such a block, over the noise, from which it is not noise. Derived: eight standard deviations at 500 Hz."""
MOST = 0.95
"""Share of all errors beyond the noise that a stretch must hold. Chosen: the rest may be friction's, which rests
elsewhere for a while after it; not varied."""
LONGEST = 0.25
"""Longest stretch, as a share of the recording. Chosen: 15 s of a minute, five seconds and the time until the duty has
moved the shaft back; not varied."""


def confined(data: Data, residual: Signal) -> Span | None:
    """The one stretch [s] of a recording that holds nearly all errors of a `residual` [noise], shape (samples,).

    None where errors are spread, or there are none.
    """
    time = np.concatenate([run.time for run in data.runs])
    number = np.floor((time - time[0]) / (BLOCK * data.scales.time)).astype(int)
    samples = np.bincount(number)
    error = np.bincount(number, weights=np.square(residual)) / np.maximum(samples, 1)
    beyond = np.where(error > HIGH**2, error - 1.0, 0.0)
    if not np.any(beyond):
        return None
    first, last = _shortest(beyond, MOST)
    while first > 0 and error[first - 1] > HIGH**2:
        first -= 1
    while last < error.size - 1 and error[last + 1] > HIGH**2:
        last += 1
    start, end = (time[0] + BLOCK * data.scales.time * place for place in (first - 1, last + 2))
    start, end = max(float(start), float(time[0])), min(float(end), float(time[-1]))
    return (start, end) if end - start <= LONGEST * (time[-1] - time[0]) else None


def _shortest(weights: Signal, share: float) -> tuple[int, int]:
    """First and last place of the shortest stretch with this share of all `weights`."""
    total = np.concatenate([[0.0], np.cumsum(weights)])
    last = np.searchsorted(total, total[:-1] + share * total[-1], side="left")
    length = np.where(last < total.size, last - np.arange(weights.size), total.size)
    first = int(np.argmin(length))
    return first, int(last[first]) - 1
