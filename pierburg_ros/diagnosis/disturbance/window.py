"""A stretch that no effect acting elsewhere explains: a hand on the lever, an open bridge."""

from __future__ import annotations

import numpy as np

from pierburg_ros.arrays import Flags, Signal
from pierburg_ros.estimation.data import Data
from pierburg_ros.recording.loss import Span

BLOCK = 2.6
"""Length of the blocks over which errors are averaged, in the actuator's own time. Derived: 0.25 s for the valve, whose
noise is then known to 6 % at 500 Hz."""
HIGH = 1.5
"""Error of such a block, over the noise, from which it is more than noise. Derived: eight standard deviations at 500
Hz."""
MOST = 0.95
"""Share of all errors above the noise that a stretch must hold if none holds all. Chosen: the rest is a slip at another
moment; not varied."""
LONGEST = 0.25
"""Longest stretch, as a share of the recording and of the motion in it. Chosen: 15 s of a minute: five seconds, and the
time until the duty has moved the shaft back; not varied."""


def confined(data: Data, residual: Signal) -> Span | None:
    """The one stretch [s] of a recording that holds nearly all errors of a `residual` [noise], shape (samples,).

    None where errors are spread over time or over the motion, or where there are none.
    """
    time = np.concatenate([run.time for run in data.runs])
    number = np.floor((time - time[0]) / (BLOCK * data.scales.time)).astype(int)
    samples = np.bincount(number)
    error = np.bincount(number, weights=np.square(residual)) / np.maximum(samples, 1)
    beyond = np.where(error > HIGH**2, error - 1.0, 0.0)
    if not np.any(beyond):
        return None
    moved = _moved(data, number)
    for share in (1.0, MOST):
        first, last = _grown(error > HIGH**2, *_shortest(beyond, share))
        start, end = (float(time[0]) + BLOCK * data.scales.time * place for place in (first - 1, last + 2))
        start, end = max(start, float(time[0])), min(end, float(time[-1]))
        if end - start <= LONGEST * (time[-1] - time[0]) and moved[first : last + 1].sum() <= LONGEST * moved.sum():
            return start, end
    return None


def _moved(data: Data, number: np.ndarray) -> Signal:
    """The range of the measured value in each block, shape (blocks,); `number` is the block of each sample."""
    measured = data.measured
    highest, lowest = np.full(number[-1] + 1, -np.inf), np.full(number[-1] + 1, np.inf)
    np.maximum.at(highest, number, measured)
    np.minimum.at(lowest, number, measured)
    return np.where(highest >= lowest, highest - lowest, 0.0)


def _grown(high: Flags, first: int, last: int) -> tuple[int, int]:
    """A stretch extended on either side by adjacent blocks that are `high` too, up to the first that is not."""
    low = np.flatnonzero(~high)
    before, after = low[low < first], low[low > last]
    return int(before[-1]) + 1 if before.size else 0, int(after[0]) - 1 if after.size else high.size - 1


def _shortest(weights: Signal, share: float) -> tuple[int, int]:
    """First and last block of the shortest stretch that holds this share of all `weights`."""
    total = np.concatenate([[0.0], np.cumsum(weights)])
    last = np.searchsorted(total, total[:-1] + share * total[-1], side="left")
    length = np.where(last < total.size, last - np.arange(weights.size), total.size)
    first = int(np.argmin(length))
    return first, int(last[first]) - 1
