"""Single samples far off their neighbours: bit errors, loose contacts, sparks."""

from __future__ import annotations

import math

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from pierburg_ros.arrays import Flags, Signal
from pierburg_ros.recording.noise import noise_of

WINDOW = 7
"""Samples whose median one is held against. Derived: outliers in a row are found up to three, half of what remains;
with one in a hundred four of seven are outliers in 3e-7 of the windows."""
WIDER = 15
"""Samples around one that say how far others are off their lines. Derived: one outlier touches five of them."""
NOISES = 6.0
"""Noises from which a sample is an outlier. Derived: white noise gets there with 2e-9."""
SPREADS = 8.0
"""Usual distances that it is off besides, so that no motion counts. Derived: a corner of the fastest straight motion,
up and down again, is off its median by 2 of them, a jump that stays by 0, and a parabola by 3; what rests on a step of
the converter counts as spread by half of it."""
TURNING = 3.0
"""Steps of the motion itself that it is off besides. Derived: where a motion turns round at once it is off by one, and
by two where it turns between two samples and comes back faster."""
MOST = 0.1
"""Share of samples up to which outliers are outliers. Chosen: beyond it the signal itself jumps to and fro."""


def outliers(time: Signal, measured: Signal) -> Flags:
    """Which samples lie far off those around them, shape (samples,); none where too many do.

    What lies near an outlier is looked at again without it.
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
        if not np.any(more) or np.mean(found) > MOST:
            break
    return found if np.mean(found) <= MOST else np.zeros_like(found)


def _off_median(values: Signal, noise: float, least: float) -> Flags:
    """Which are far off the median of those around them, by what is usual there."""
    around = sliding_window_view(np.pad(values, WINDOW // 2, mode="edge"), WINDOW)
    median = np.median(around, axis=1)
    spread = np.median(np.abs(around - median[:, np.newaxis]), axis=1)
    return np.asarray(np.abs(values - median) > NOISES * noise + SPREADS * np.maximum(spread, least))


def _off_lines(values: Signal, noise: float, least: float) -> Flags:
    """Which are far off the lines through the two before and the two after them, to the same side.

    A corner lies on one of them, but where a motion turns round at once it is off by its own step from sample to
    sample. The noise of three samples adds up to sqrt(1 + 4 + 1) times that of one.
    """
    padded = np.pad(values, 2, mode="edge")
    steps = np.diff(padded)
    before, after = values - padded[1:-3] - steps[:-3], values - padded[3:-1] + steps[3:]
    off = np.where(before * after > 0.0, np.minimum(np.abs(before), np.abs(after)), 0.0)
    turning = TURNING * np.maximum(np.abs(steps[:-3]), np.abs(steps[3:]))
    usual = np.median(sliding_window_view(np.pad(off, WIDER // 2, mode="edge"), WIDER), axis=1)
    return np.asarray(off > math.sqrt(6.0) * NOISES * noise + SPREADS * np.maximum(usual, least) + turning)
