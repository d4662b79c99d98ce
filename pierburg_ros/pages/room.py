"""The signals of a page within the room that it has."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.pages.over_time import extremes

SIGNAL_ROOM = 1.25e6
"""Characters of a page that its signals may take. Derived: 6 MiB less 4.82 MB of plotly.js and 0.2 MB for the rest."""
STORED = 4.0 / 3.0
"""Characters of a page for each byte of a signal. Derived: base64 writes three bytes as four characters."""


def page_signals(recordings: Sequence[Mapping[str, Signal]], telling: Sequence[str]) -> dict[str, Signal]:
    """The signals of all recordings by number and name, `0/time`, with as many samples as a page has room for.

    Of longer recordings the samples are kept in which one of the signals that are `telling` is lowest or highest in its
    stretch of time.
    """
    needed = sum(STORED * each["time"].size * (4 + 2 * (len(each) - 1)) for each in recordings)
    signals: dict[str, Signal] = {}
    for number, each in enumerate(recordings):
        kept = slice(None) if needed <= SIGNAL_ROOM else _kept(each, telling, SIGNAL_ROOM / needed)
        signals |= {f"{number}/{name}": values[kept] for name, values in each.items()}
    return signals


def _kept(signals: Mapping[str, Signal], telling: Sequence[str], share: float) -> np.ndarray:
    """Which samples to keep, at most a `share` of them: two of each stretch and signal that is telling."""
    telling = [name for name in telling if name in signals]
    buckets = max(int(share * signals["time"].size / (2 * len(telling))) - 1, 2)
    return np.unique(np.concatenate([extremes(signals[name], buckets) for name in telling]))
