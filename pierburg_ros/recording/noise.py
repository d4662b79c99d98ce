"""The noise of a measured signal, and of its stamps, estimated from them alone."""

from __future__ import annotations

import numpy as np

from pierburg_ros.arrays import Signal

SMALLEST = 2e-10
"""Least noise, as a share of the largest value: a nanovolt of 5 V, below what any converter or simulation resolves."""
ACROSS = 10
"""Samples across which the rate of a signal is told. Work: noise then takes off a tenth of what it does from sample to
sample, and is taken off besides; not varied."""
USUAL = 1.5
"""Intervals up to so many medians are no gaps. Derived: halfway to the next sample but one."""


def noise_of(time: Signal, measured: Signal) -> float:
    """Standard deviation of the white part of a smooth signal, same unit, from its third differences.

    The third difference of white noise has 20 times its variance. Differences across gaps are left out, and of
    the others the largest tenth, where the signal has kinks, which takes 38 % off the variance of a normal
    distribution. Never less than the rounding to the smallest step between values, step / sqrt(12), or `SMALLEST`.
    """
    interval = np.diff(time)
    regular = interval < USUAL * np.median(interval)
    together = regular[:-2] & regular[1:-1] & regular[2:]
    differences = np.abs(np.diff(measured, 3)[together])
    deviation = 0.0
    if differences.size:
        kept = differences[differences <= np.quantile(differences, 0.9)]
        deviation = float(np.sqrt(np.mean(np.square(kept)) / (20.0 * 0.623)))
    values = np.unique(measured)
    step = float(np.min(np.diff(values))) if values.size > 1 else 0.0
    largest = float(np.max(np.abs(values), initial=0.0)) or 1.0
    return float(max(deviation, step / np.sqrt(12.0), SMALLEST * largest))


def stamp_noise(time: Signal, measured: Signal, noise: float) -> float:
    """Standard deviation that stamps which are off bring into a signal with this `noise`, same unit.

    The stamp of an input and that of a sample are taken to be off from one another as two of samples are: by the
    standard deviation of the intervals between them. Meanwhile the signal moves on at its rate, root mean square.
    """
    interval = np.diff(time)
    if measured.size <= ACROSS:
        return 0.0
    median = float(np.median(interval))
    change = float(np.mean(np.square(measured[ACROSS:] - measured[:-ACROSS])))
    rate = np.sqrt(max(change - 2.0 * noise**2, 0.0)) / (ACROSS * median)
    return float(np.std(interval[interval < USUAL * median]) * rate)
