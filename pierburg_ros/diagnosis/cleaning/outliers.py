"""Single samples far off their neighbours: bit errors, loose contacts, sparks."""

from __future__ import annotations

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from pierburg_ros.arrays import Flags, Signal
from pierburg_ros.recording.noise import noise_of

WINDOW = 7
"""Samples whose median one is held against. Derived: outliers in a row are found up to three, half of what remains;
with one in a hundred four of seven are outliers in 3e-7 of the windows."""
NOISES = 6.0
"""Noises off the median from which a sample is an outlier. Derived: white noise gets there with 2e-9."""
SPREADS = 8.0
"""Median distances from the median that it is off besides, so that no motion counts. Derived: a corner of the fastest
straight motion, up and down again, is off by 2 of them, a jump that stays by 0, and a parabola by 3; what rests on a
step of the converter counts as spread by half of it."""
MOST = 0.1
"""Share of samples up to which outliers are outliers. Chosen: beyond it the signal itself jumps to and fro."""


def outliers(time: Signal, measured: Signal) -> Flags:
    """Which samples lie far off the median of those around them, shape (samples,); none where too many do."""
    if measured.size < WINDOW:
        return np.zeros(measured.size, dtype=bool)
    padded = np.pad(measured, WINDOW // 2, mode="edge")
    around = sliding_window_view(padded, WINDOW)
    median = np.median(around, axis=1)
    spread = np.median(np.abs(around - median[:, np.newaxis]), axis=1)
    step = float(np.min(np.diff(np.unique(measured)), initial=np.inf))
    spread = np.maximum(spread, 0.5 * step if np.isfinite(step) else 0.0)
    off = np.abs(measured - median)
    found = off > NOISES * noise_of(time, measured) + SPREADS * spread
    return np.asarray(found if np.mean(found) <= MOST else np.zeros_like(found))
