"""The noise of a measured signal, estimated from the signal alone."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Signal = NDArray[np.float64]


KEPT = 0.9
"""Share of the differences that count, the smallest: where the signal has kinks they are large."""
REMAINING = 0.623
"""Variance of a normal distribution without the tenth farthest out, over the whole one's."""


def noise_of(time: Signal, measured: Signal) -> float:
    """Standard deviation of the white part of a smooth signal, same unit, at least that of its rounding.

    Differences across gaps are left out.
    """
    interval = np.diff(time)
    regular = interval < 1.5 * np.median(interval)
    together = regular[:-2] & regular[1:-1] & regular[2:]
    return max(_white(np.diff(measured, 3)[together]), rounding_of(measured), 1e-9)


def white_part(signal: Signal) -> float:
    """Standard deviation of the white part of a signal of evenly spaced samples, same unit."""
    return _white(np.diff(signal, 3))


def rounding_of(measured: Signal) -> float:
    """Standard deviation of the rounding to the smallest step between values, step / sqrt(12), same unit."""
    values = np.unique(measured)
    return float(np.min(np.diff(values)) / np.sqrt(12.0)) if values.size > 1 else 0.0


def _white(third_differences: Signal) -> float:
    """The third difference of white noise has 20 times its variance."""
    squares = np.square(third_differences)
    count = int(KEPT * squares.size)
    return float(np.sqrt(np.mean(np.partition(squares, count)[:count]) / (20.0 * REMAINING))) if count else 0.0
