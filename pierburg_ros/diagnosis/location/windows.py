"""The windows that hold most of an energy: few, not too short, and together not too long."""

from __future__ import annotations

import math

import numpy as np

from pierburg_ros.arrays import Flags, Signal
from pierburg_ros.kernel import kernel

SHORTEST_LOCATION = 2.6
"""Shortest window that a diagnosis names, in the actuator's own time. Derived: for every shipped actuator it is more
than the 0.2 s that section 5 of docs/contract.md states."""
MOST_BINS = 600
"""Largest number of bins into which a recording is cut; a bin is half the shortest window, or longer. Work: time and
memory grow with the square of the number."""
GRAIN = 1e-7
"""Resolution of the energy of windows, as a share of the whole energy. Derived: a shaft that stands displaced makes
windows of equal energy but for rounding, 1e-12, and rounding must not choose among them."""
ENOUGH = 0.9
"""Share of the energy of longer windows, or more, that shorter ones, or fewer, must keep. Chosen: a tenth is not worth
a longer window; not varied."""


def windows(
    time: Signal, energy: Signal, most: int = 20, shortest: float = 0.2, quarter: float = 0.25
) -> list[tuple[float, float]]:
    """Windows (start, end) [s] that hold most of `energy`, the one with most of it first.

    There are at most `most` windows, each at least `shortest` [s], together at most the share `quarter` of the
    recording. They are exact for window ends on a grid of half the shortest. Their total length is what it takes to
    hold 90 % of the energy of the longest. It is shorter where more windows of that total length would hold much more.
    """
    duration = float(time[-1] - time[0])
    count = min(MOST_BINS, int(2.0 * duration / shortest))
    if count == 0 or not np.any(energy > 0.0):
        return []
    width = duration / count
    least = max(1, math.ceil(shortest / width - 1e-9))
    place = np.minimum(((time - time[0]) / width).astype(int), count - 1)
    held = np.bincount(place, weights=energy, minlength=count)
    binned = np.round(held / (GRAIN * float(held.sum())))
    longest = int(quarter * count + 1e-9)
    if longest < least:
        return []
    plan = _Plan(binned, most, longest, least)
    chosen = plan.chosen(_useful_length(plan.held, binned, least))
    chosen.sort(key=lambda pair: -float(binned[pair[0] : pair[1]].sum()))
    return [(float(time[0] + first * width), float(time[0] + last * width)) for first, last in chosen]


def _useful_length(held: Signal, binned: Signal, least: int) -> int:
    """Number of bins that are worth taking; `held` is the energy of the best windows of each total length."""
    blocks = np.add.reduceat(binned, np.arange(0, binned.size, least))
    reachable = np.cumsum(np.sort(blocks)[::-1])
    lengths = np.arange(held.size)
    unbound = np.interp(lengths, least * np.arange(reachable.size + 1), np.concatenate([[0.0], reachable]))
    enough = int(np.argmax(held >= ENOUGH * held[-1]))
    kept = held[: enough + 1] / np.maximum(unbound[: enough + 1], 1e-300)
    kept[:least] = 0.0
    gathered = np.flatnonzero(kept >= ENOUGH)
    return int(gathered[-1]) if gathered.size else int(np.argmax(kept))


class _Plan:
    """The best windows for every number and total length."""

    def __init__(self, binned: Signal, most: int, longest: int, least: int) -> None:
        self.least = least
        states = (binned.size + 1, most + 1, longest + 1)
        self.left, self.opened = np.zeros(states, dtype=np.bool_), np.zeros(states, dtype=np.bool_)
        outside, inside = np.full(states, -np.inf), np.full(states, -np.inf)
        outside[0, 0, 0] = 0.0
        total = np.concatenate([[0.0], np.cumsum(binned)])
        _fill(total, least, outside, inside, self.left, self.opened)
        self._ends_inside = inside[-1] > outside[-1]
        self._energy = np.maximum(inside[-1], outside[-1])

    @property
    def held(self) -> Signal:
        """The largest energy of windows of at most 0, 1, 2, ... bins in total."""
        return np.maximum.accumulate(self._energy.max(axis=0))

    def chosen(self, length: int) -> list[tuple[int, int]]:
        """The best windows of at most `length` bins in total, as (first bin, bin after the last)."""
        within = self._energy[:, : length + 1]
        number, length = (int(n) for n in np.unravel_index(int(np.argmax(within)), within.shape))
        i, found = self.left.shape[0] - 1, []
        taken, end = bool(self._ends_inside[number, length]), i
        while i > 0:
            if not taken:
                taken, i = bool(self.left[i, number, length]), i - 1
                end = i
            elif self.opened[i, number, length]:
                i, number, length = i - self.least, number - 1, length - self.least
                found.append((i, end))
                taken = False
            else:
                i, length = i - 1, length - 1
        return found


@kernel
def _fill(total: Signal, least: int, outside: Signal, inside: Signal, left: Flags, opened: Flags) -> None:
    """Dynamic programming over bins i, number of windows w and their total length l in bins.

    `outside[i, w, l]` is the largest energy in the first i bins if the last of them is left out, `inside` if it is
    taken in. `left` and `opened` record where each came from. `total` is the energy before each bin.
    """
    bins, most, longest = outside.shape[0], outside.shape[1], outside.shape[2]
    for i in range(1, bins):
        gain = total[i] - total[i - 1]
        for w in range(most):
            for length in range(longest):
                left[i, w, length] = inside[i - 1, w, length] > outside[i - 1, w, length]
                outside[i, w, length] = max(inside[i - 1, w, length], outside[i - 1, w, length])
                if length > 0:
                    inside[i, w, length] = inside[i - 1, w, length - 1] + gain
                if w > 0 and length >= least and i >= least:
                    new = outside[i - least, w - 1, length - least] + total[i] - total[i - least]
                    if new > inside[i, w, length]:
                        inside[i, w, length] = new
                        opened[i, w, length] = True
