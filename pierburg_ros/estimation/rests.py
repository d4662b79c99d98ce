"""Recordings cut where the shaft rests, so that a slip at the wrong moment displaces nothing beyond the next rest.

Dry friction lets the shaft rest anywhere, so the cost of a whole recording is rough: one slip that comes early moves
all that follows. Where the shaft rests, its state is known except for the noise, so each part may begin there (multiple
shooting: Bock, Plitt, IFAC Proceedings 17 (1984) 1603-1608). All other memory of a model, such as heat, starts afresh.
The values found in this way are therefore the start of a fit to whole recordings.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.initial_state import InitialState, approach, rests_of
from pierburg_ros.estimation.run import Run


def cut_at_rests(data: Data) -> Data:
    """`data` with every run cut in the middle of each rest; a run that is simulated in stretches stays as it is."""
    return replace(data, runs=tuple(part for run in data.runs for part in _parts(run)))


def _parts(run: Run) -> Iterator[Run]:
    noise = run.start.noise
    rests = [] if run.shooting else [rest for rest in rests_of(run.measured, noise) if rest.start > 0]
    starts = [run.start, *(_start(run.measured, rest, noise) for rest in rests)]
    edges = [0, *((rest.start + rest.stop) // 2 for rest in rests), run.time.size]
    for start, (first, last) in zip(starts, pairwise(edges), strict=True):
        yield replace(run.part(slice(first, last)), start=start, since=run.since if first == 0 else None)


def _start(measured: Signal, rest: slice, noise: float) -> InitialState:
    level = float(np.mean(measured[rest]))
    return InitialState(level, 0.0, noise, True, came=approach(measured[: rest.start], level, noise))
