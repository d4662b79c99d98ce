"""Single samples far off their neighbours: bit errors, loose contacts, sparks."""

from __future__ import annotations

import math

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from pierburg_ros.arrays import Flags, Signal
from pierburg_ros.recording.noise import noise_of

MEDIAN_WINDOW = 7
"""Length of the window [samples] of the median with which a sample is compared. Derived: up to three outliers in a row
are found, half of the other samples. If one sample in a hundred is an outlier, four of seven are in 3e-7 of the
windows."""
WIDER = 15
"""Length of the window [samples] that gives the usual distance of samples from the lines through their neighbours.
Derived: one outlier affects five of them."""
NOISES = 6.0
"""Distance from which a sample is an outlier, in standard deviations of the noise. Derived: white noise reaches it with
probability 2e-9."""
SPREADS = 8.0
"""Further distance that an outlier must have, in usual distances, so that no motion counts as one. Derived: a corner of
the fastest straight motion, up and down again, is 2 of them off its median, a jump that stays 0, and a parabola 3. For
a signal that rests on one step of the converter, half a step counts as the usual distance."""
TURNING = 3.0
"""Further distance that an outlier must have, in steps of the motion from sample to sample. Derived: at an abrupt
reversal a sample is off by one. It is off by two if the motion reverses between two samples and returns faster."""
MOST_OUTLIERS = 0.1
"""Largest share of samples that may be outliers. Chosen: beyond it the signal itself jumps to and fro."""


def outliers(time: Signal, measured: Signal) -> Flags:
    """Which samples lie far from their neighbours, shape (samples,); none where too many do.

    After outliers are removed, the samples near them are tested again.
    """
    found = np.zeros(measured.size, dtype=bool)
    noise = noise_of(time, measured)
    step = float(np.min(np.diff(np.unique(measured)), initial=math.inf))
    least = 0.5 * step if math.isfinite(step) else 0.0
    while np.count_nonzero(~found) > WIDER:
        kept = np.flatnonzero(~found)
        rest = measured[kept]
        more = _off_median(rest, noise, least) | _off_lines(rest, noise, least)
        found[kept[more]] = True
        if not np.any(more) or np.mean(found) > MOST_OUTLIERS:
            break
    return found if np.mean(found) <= MOST_OUTLIERS else np.zeros_like(found)


def _off_median(values: Signal, noise: float, least: float) -> Flags:
    """Which samples lie far from the median of their neighbours, compared with the usual distance there."""
    around = sliding_window_view(np.pad(values, MEDIAN_WINDOW // 2, mode="edge"), MEDIAN_WINDOW)
    median = np.median(around, axis=1)
    spread = np.median(np.abs(around - median[:, np.newaxis]), axis=1)
    return np.asarray(np.abs(values - median) > NOISES * noise + SPREADS * np.maximum(spread, least))


def _off_lines(values: Signal, noise: float, least: float) -> Flags:
    """Which samples lie far, on the same side, from both lines through the two samples before and the two after.

    A corner lies on one of the lines. At an abrupt reversal a sample is off by its own step from sample to sample. The
    noise of three samples adds up to sqrt(1 + 4 + 1) times that of one.
    """
    padded = np.pad(values, 2, mode="edge")
    steps = np.diff(padded)
    before, after = values - padded[1:-3] - steps[:-3], values - padded[3:-1] + steps[3:]
    off = np.where(before * after > 0.0, np.minimum(np.abs(before), np.abs(after)), 0.0)
    turning = TURNING * np.maximum(np.abs(steps[:-3]), np.abs(steps[3:]))
    usual = np.median(sliding_window_view(np.pad(off, WIDER // 2, mode="edge"), WIDER), axis=1)
    return np.asarray(off > math.sqrt(6.0) * NOISES * noise + SPREADS * np.maximum(usual, least) + turning)
