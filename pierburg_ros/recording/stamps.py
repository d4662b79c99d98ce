"""How far the stamps of samples are off, told by the samples themselves."""

from __future__ import annotations

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.recording.noise import USUAL_INTERVAL

ACROSS = 10
"""Samples across which the rate of a signal is told. Work: noise then takes off a tenth of what it does from sample to
sample, and is taken off besides; not varied."""
FASTEST_SHARE = 0.05
"""Share of the samples, those in the fastest motion, that say how far stamps are off. Chosen: 1,500 of a minute at
500 Hz, whose median is known to 5 %; not varied."""
CHI2 = 0.455
"""Median of the square of a standard normal variable."""


def stamp_error(time: Signal, measured: Signal, noise: float) -> float:
    """Standard deviation [s] by which stamps are off, of a signal with this `noise` (same unit).

    Stamps that are off by chance have uneven intervals, with twice their variance. But samples may be uneven indeed:
    then the signal is as smooth in fast motion as at rest, where each sample is held against the cubic through two on
    either side. What it is rougher is the rate times the error of the stamps. The lesser of the two counts.
    """
    interval = np.diff(time)
    usual = interval < USUAL_INTERVAL * np.median(interval)
    if measured.size <= ACROSS or not usual.any():
        return 0.0
    uneven = float(np.std(interval[usual]) / np.sqrt(2.0))
    square = np.square(rates(time, measured)[2:-2])
    rough = _roughness(time, measured)
    together = usual[:-3] & usual[1:-2] & usual[2:-1] & usual[3:]
    if not together.any():
        return 0.0
    fast = together & (square >= np.quantile(square[together], 1.0 - FASTEST_SHARE))
    excess = float(np.median(rough[fast])) / CHI2 - noise**2
    moving = float(np.median(square[fast]))
    return min(uneven, float(np.sqrt(max(excess, 0.0) / moving))) if moving > 0.0 else 0.0


def rates(time: Signal, measured: Signal) -> Signal:
    """How fast a signal moves around each sample [1/s], shape (samples,)."""
    number = np.arange(measured.size)
    before, after = np.maximum(number - ACROSS // 2, 0), np.minimum(number + ACROSS // 2, number[-1])
    return np.asarray((measured[after] - measured[before]) / (time[after] - time[before]))


def _roughness(time: Signal, measured: Signal) -> Signal:
    """Squared distance of each sample but the outer two from the cubic through two before and two after it.

    In multiples of what noise does to it, so that white noise has its own variance; shape (samples - 4,).
    """
    own = time[2:-2]
    others = [time[place : time.size - 4 + place] for place in (0, 1, 3, 4)]
    weights = [
        np.prod([(own - other) / (one - other) for other in others if other is not one], axis=0) for one in others
    ]
    values = [measured[place : time.size - 4 + place] for place in (0, 1, 3, 4)]
    distance = measured[2:-2] - sum(weight * value for weight, value in zip(weights, values, strict=True))
    return np.asarray(np.square(distance) / (1.0 + sum(np.square(weight) for weight in weights)))
