"""Whether the reported windows hold the effect, against what windows of that length could hold at best."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from pierburg_ros.arrays import Signal

SHORTEST_WINDOW = 0.2  # s, shortest window that section 5 of docs/contract.md allows


def held(time: Signal, signal: Signal, windows: Sequence[Mapping[str, float]]) -> tuple[float, float]:
    """Share of the signal's energy in the windows [1], and their length [s]; overlaps count once."""
    inside = np.zeros(time.size, bool)
    for window in windows:
        inside |= (time >= window["start"]) & (time < window["end"])
    energy = signal**2
    step = (time[-1] - time[0]) / (time.size - 1)
    return float(energy[inside].sum() / energy.sum()), float(inside.sum() * step)


def best(time: Signal, signal: Signal, length: float) -> float:
    """Largest share of the signal's energy that blocks of 0.2 s, together `length` [s] long, can hold [1]."""
    block = np.floor((time - time[0]) / SHORTEST_WINDOW + 1e-6).astype(int)
    energies = np.sort(np.bincount(block, weights=signal**2))[::-1]
    whole, rest = divmod(length / SHORTEST_WINDOW, 1.0)
    count = min(int(whole), energies.size)
    following = energies[count] * rest if count < energies.size else 0.0
    return float((energies[:count].sum() + following) / energies.sum())


def share_of_best(time: Signal, signal: Signal, windows: Sequence[Mapping[str, float]]) -> float | None:
    """Energy in the windows over the best that windows of that length could hold [1]; None without either."""
    if not windows or not np.any(signal):
        return None
    found, length = held(time, signal, windows)
    return found / best(time, signal, length)
