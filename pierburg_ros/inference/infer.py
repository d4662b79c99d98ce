"""From recordings to a choice: motion, balance, search, choice, one after the other."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from pierburg_ros.inference.balance import Balance
from pierburg_ros.inference.choice import Choice, chosen
from pierburg_ros.inference.data import data_of
from pierburg_ros.inference.fit import Effort, Fitter, ladder
from pierburg_ros.inference.motion import motion_of
from pierburg_ros.inference.search import Progress, Search, aliases, free_parameters, key, searched
from pierburg_ros.inference.shortlist import Span, independent
from pierburg_ros.plant import Model
from pierburg_ros.recording import Recording
from pierburg_ros.workers import workers

USUAL = 20_000
"""Simulations after which no larger explanation is grown. Work: twice what two effects beside four drifts took."""


def infer(
    recordings: Sequence[Recording],
    nominal: Model,
    tell: Progress = lambda _: None,
    jobs: int | None = None,
    budget: float = 1.0,
) -> Choice:
    """What `nominal` lacks, by the recordings alone, with `jobs` fits at a time; `budget` in usual efforts.

    The same recordings give the same choice on every machine, at any load and with any number of jobs. InputError where
    the recordings cannot be used.
    """
    data = data_of(recordings, nominal)
    first = ladder(data)[0]
    motions = tuple(motion_of(run, nominal, first) for run in data.runs)
    balance, free = Balance(data.actuator, motions), free_parameters(nominal)
    angles = np.concatenate([motion.whole.angle for motion in motions]) / data.scales.angle
    span = Span(data.duration / data.scales.time, float(np.min(angles)), float(np.max(angles)))
    fitter = Fitter(data, nominal, first, Effort(budget * USUAL if math.isfinite(budget) else math.inf))
    with workers(jobs) as pool:
        base = tuple(name for name in free if "." not in name)
        search = Search(balance, independent(balance, nominal, base), span, pool, tell)
        fits = searched(fitter, search)
        choice = chosen(fits, free, pool)
        if len(choice.chosen.explanation.drifted) < 2:
            return choice
        own = next(fit for fit in fits if key(fit) == key(choice.chosen))
        return chosen([*fits, *aliases(own, search)], free, pool)
