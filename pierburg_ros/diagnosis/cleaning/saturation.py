"""A converter whose range is smaller than the sensor's: the reading stays at its highest or lowest value."""

from __future__ import annotations

import math

import numpy as np

from pierburg_ros.arrays import Flags, Signal
from pierburg_ros.recording.noise import noise_of

RESOLVED = 0.5
"""Smallest noise with which readings of a shaft at rest differ, in steps of the converter. Derived: with half a step of
noise two successive readings are equal with probability of about 0.5."""
CHANCE = 1e-6
"""Probability below which a run of equal readings is not chance, over a whole recording, but the converter's end.
Chosen: one recording in a million; not varied."""
BEFORE = 8
"""Samples over which a rate is taken, twice in a row. Chosen: enough that their mean is no noise, few enough to be a
moment."""
CUT_OFF = 0.67
"""Share of a rate that is kept by what is cut off. Derived: where a shaft turns its rate falls to a third from one
stretch of equal length to the next, and what is cut off keeps all; this is half way."""
BESIDE = 4.0
"""Distance from the end within which readings are left out too, in standard deviations of the noise: there one side of
the noise is cut off. Derived: white noise goes further with probability 3e-5."""


def saturated(time: Signal, measured: Signal, rest: float | None = None) -> Flags:
    """Which samples stand at the end of the converter's range, or so near that noise decides, shape (samples,).

    A shaft that stands reads `rest`, where every standing shaft reads the same: that is no end of a range.

    The end is the highest or lowest value, if it repeats in a row far longer than noise repeats any other, and the
    reading comes to it or leaves it without slowing down: a shaft that dwells where it turns slows down before.
    """
    values, noise = np.unique(measured), noise_of(time, measured)
    found = np.zeros(measured.size, dtype=bool)
    if values.size < 3 or noise < RESOLVED * float(np.min(np.diff(values))):
        return found
    same = np.diff(measured) == 0.0
    for end in (values[0], values[-1]):
        if rest is not None and abs(end - rest) <= BESIDE * noise:
            continue
        runs = _runs(measured == end)
        longest = max(runs, key=lambda run: run[1] - run[0])
        if longest[1] - longest[0] >= _by_chance(same[measured[1:] != end], measured.size) and _cut(measured, longest):
            found |= np.abs(measured - end) <= BESIDE * noise
    return found


def _by_chance(same: Flags, size: int) -> float:
    """Length from which a run of equal readings is not chance, from how often two successive ones are the `same`."""
    share = min(max((np.count_nonzero(same) + 1.0) / (same.size + 2.0), 1e-6), 1.0 - 1e-6)
    return 1.0 + math.log(CHANCE / size) / math.log(share)


def _runs(flags: Flags) -> list[tuple[int, int]]:
    """First flag and the place after the last one of each row of flags."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flags, [False]]).astype(int)))
    return [(int(first), int(last)) for first, last in zip(edges[::2], edges[1::2], strict=True)]


def _cut(measured: Signal, run: tuple[int, int]) -> bool:
    """Whether the reading keeps its rate up to a run of equal readings, or has it at once after."""
    sides = (measured[: run[0] + 1][::-1], measured[run[1] - 1 :])
    for side in sides:
        if side.size > 2 * BEFORE:
            near, far = abs(side[BEFORE] - side[0]), abs(side[2 * BEFORE] - side[BEFORE])
            if near >= CUT_OFF * far > 0.0:
                return True
    return False
