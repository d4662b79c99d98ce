"""The noise of a measured signal, estimated from it alone."""

from __future__ import annotations

import numpy as np

from pierburg_ros.arrays import Signal

SMALLEST_NOISE = 2e-10
"""Least noise, as a share of the largest value: a nanovolt of 5 V, below what any converter or simulation resolves."""
USUAL_INTERVAL = 1.5
"""Intervals up to so many medians are no gaps. Derived: halfway to the next sample but one."""


def noise_of(time: Signal, measured: Signal) -> float:
    """Standard deviation of the white part of a smooth signal, same unit, from its third differences.

    The third difference of white noise has 20 times its variance. Differences across gaps are left out, and of
    the others the largest tenth, where the signal has kinks, which takes 38 % off the variance of a normal
    distribution. Never less than the rounding to the smallest step between values, step / sqrt(12), or
    `SMALLEST_NOISE`.
    """
    interval = np.diff(time)
    regular = interval < USUAL_INTERVAL * np.median(interval)
    together = regular[:-2] & regular[1:-1] & regular[2:]
    differences = np.abs(np.diff(measured, 3)[together])
    deviation = 0.0
    if differences.size:
        kept = differences[differences <= np.quantile(differences, 0.9)]
        deviation = float(np.sqrt(np.mean(np.square(kept)) / (20.0 * 0.623)))
    values = np.unique(measured)
    step = float(np.min(np.diff(values))) if values.size > 1 else 0.0
    largest = float(np.max(np.abs(values), initial=0.0)) or 1.0
    return float(max(deviation, step / np.sqrt(12.0), SMALLEST_NOISE * largest))
