"""From recordings to a choice: motion, balance, search, choice, one after the other."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from pierburg_ros.budget import USUAL_BUDGET, Budget
from pierburg_ros.inference.along import named_along
from pierburg_ros.inference.balance import Balance, balance_of
from pierburg_ros.inference.choice import Choice, chosen
from pierburg_ros.inference.data import Data, data_of
from pierburg_ros.inference.evidence import EXPLAINED
from pierburg_ros.inference.explanation import Variant
from pierburg_ros.inference.fit import Effort, Fitter, ladder
from pierburg_ros.inference.search import Progress, Search, free_parameters, searched
from pierburg_ros.inference.shortlist import Span, forms, independent
from pierburg_ros.plant import Model
from pierburg_ros.recording import Recording
from pierburg_ros.workers import workers


@dataclass(frozen=True)
class Inferred:
    """A choice, and what it was made with: the balance, the ways in which effects may act, and the effort.

    `free` are all parameters that may drift, `drifts` those of them that the recordings tell apart.
    """

    choice: Choice
    balance: Balance
    candidates: Sequence[tuple[Variant, list[dict[str, float]]]]
    free: tuple[str, ...]
    drifts: tuple[str, ...]
    effort: Effort


def infer(
    recordings: Sequence[Recording],
    nominal: Model,
    tell: Progress = lambda _: None,
    jobs: int | None = None,
    budget: Budget = USUAL_BUDGET,
    unlike: float = 0.0,
) -> Inferred:
    """What `nominal` lacks, by the recordings alone, with `jobs` fits at a time.

    The same recordings give the same choice on every machine, at any load and with any number of jobs, unless the clock
    or Ctrl-C stopped it (`Inferred.effort`). An error of the size `unlike` (measured unit, root mean square) counts as
    noise. InputError where the recordings cannot be used.
    """
    data = data_of(recordings, nominal)
    data, effort = replace(data, noise=math.hypot(data.noise, unlike)), Effort(budget)
    inferred = inferred_from(data, nominal, tell, jobs, effort)
    judges = judging_on(inferred.choice)
    if judges is None or effort.over:
        return inferred
    tell("what was explained misses blocks that were held out: once more, with these")
    return inferred_from(replace(data, chooses=None, judges=judges), nominal, tell, jobs, effort)


def judging_on(choice: Choice) -> int | None:
    """Which block of a cycle judges from now on; None where what explains the fitted blocks misses no other.

    Held-out blocks that it misses tell what the fitted ones did not: those that it misses least are kept to judge.
    """
    fit, data = choice.handed, choice.handed.fitter.data
    left = {data.chooses: fit.ratio_of(data.validation), data.judges: fit.ratio_of(data.test)}
    return min(left, key=left.__getitem__) if choice.explained and max(left.values()) > EXPLAINED else None


def inferred_from(data: Data, nominal: Model, tell: Progress, jobs: int | None, effort: Effort) -> Inferred:
    """What `nominal` lacks by the blocks of some data: one search and its choice."""
    first = ladder(data)[0]
    balance, free = balance_of(data, nominal, first), free_parameters(nominal)
    angles = np.concatenate([motion.whole.angle for motion in balance.motions]) / data.scales.angle
    span = Span(data.duration / data.scales.time, float(np.min(angles)), float(np.max(angles)))
    fitter = Fitter(data, nominal, first, effort)
    with workers(jobs) as pool:
        search = Search(balance, independent(fitter, balance, free), forms(data, nominal, span), pool, tell)
        fits = searched(fitter, search)
        choice = chosen(fits, free, search)
    choice = named_along(choice, balance, search.candidates)
    return Inferred(choice, balance, search.candidates, free, search.drifts, effort)
