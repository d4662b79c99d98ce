"""A converter that ends below what the sensor gives: the reading stands at its highest or lowest value."""

from __future__ import annotations

import math

import numpy as np

from pierburg_ros.arrays import Flags, Signal
from pierburg_ros.recording.noise import noise_of

RESOLVED = 0.5
"""Noise, in steps of the converter, from which readings of a shaft at rest differ. Derived: with half a step of noise
two successive readings are equal with about 0.5."""
CHANCE = 1e-6
"""How likely a run of equal readings may be by chance in a whole recording for it to be the converter's end. Chosen:
one recording in a million; not varied."""
BESIDE = 4.0
"""Noises below the end within which readings are left out too: of those only the lower ones are seen. Derived: white
noise goes further with 3e-5."""


def saturated(time: Signal, measured: Signal) -> Flags:
    """Which samples stand at the end of the converter, or so near that noise decides, shape (samples,).

    The end is the highest or lowest value, repeated in a row far longer than noise repeats any other.
    """
    values, noise = np.unique(measured), noise_of(time, measured)
    found = np.zeros(measured.size, dtype=bool)
    if values.size < 3 or noise < RESOLVED * float(np.min(np.diff(values))):
        return found
    same = np.diff(measured) == 0.0
    for end in (values[0], values[-1]):
        if _longest(measured == end) >= _by_chance(same[measured[1:] != end], measured.size):
            found |= np.abs(measured - end) <= BESIDE * noise
    return found


def _by_chance(same: Flags, size: int) -> float:
    """Length of a run of equal readings that is not chance, from how often two successive ones are the `same`."""
    share = min(max((np.count_nonzero(same) + 1.0) / (same.size + 2.0), 1e-6), 1.0 - 1e-6)
    return 1.0 + math.log(CHANCE / size) / math.log(share)


def _longest(flags: Flags) -> int:
    """Most flags in a row."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flags, [False]]).astype(int)))
    return int(np.max(edges[1::2] - edges[::2], initial=0))
