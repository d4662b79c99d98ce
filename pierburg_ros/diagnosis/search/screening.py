"""Candidates for one more quantity in an explanation, ranked by what a linear step along each promises."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass

import numpy as np

from pierburg_ros.diagnosis.search.candidates import Addition, expansions
from pierburg_ros.diagnosis.search.linear import change_starts, promised, promised_left
from pierburg_ros.diagnosis.search.selection import PROMISING
from pierburg_ros.effects import EFFECT
from pierburg_ros.effects.effect import Start
from pierburg_ros.estimation.estimator import Estimator, Fit, adequate
from pierburg_ros.estimation.first_part import takes_time, where_shown
from pierburg_ros.inference.explanation import Explanation, Variant

Promised = tuple[float, dict[str, float]]
"""The chi2 that a linear step promises, and the start that it leads to."""
STARTS_TRIED = 2
"""Number of starts from which a first fit begins. Work: each costs one brief fit; not varied."""


@dataclass(frozen=True)
class Candidate:
    """An explanation to be fitted: with which addition, on which samples, from which starts.

    `base` is the fit that it grows on, on the same samples. `promise` is the error over noise to which a linear step
    from there leads, infinite if no such step was made.
    """

    explanation: Explanation
    addition: Addition
    estimator: Estimator
    base: Fit
    starts: tuple[dict[str, float], ...]
    promise: float = np.inf

    @property
    def jumps(self) -> bool:
        """Whether the cost has many local minima along the addition."""
        return isinstance(self.addition, Variant) and EFFECT[self.addition.effect].jumps

    @property
    def drifts(self) -> bool:
        """Whether the addition is a drift: cheap to fit, and perhaps a base for others."""
        return self.addition in self.explanation.drifted

    @property
    def changes(self) -> bool:
        """Whether the addition is a change in mid-recording."""
        return self.addition == self.explanation.changed


def screened(
    fit: Fit,
    whole: Estimator,
    drifts: tuple[str, ...],
    pool: Executor,
    progress: Callable[[str], None],
) -> list[Candidate]:
    """Every addition to `fit` with its promise, on the first part of each run if that shows the error left."""
    base = whole.restated(fit)
    quick = where_shown(base, whole)

    def candidate(task: tuple[Explanation, tuple[Addition, list[Start]]]) -> Candidate:
        explanation, (addition, starts) = task
        progress(explanation.label)
        if explanation.changed != fit.explanation.changed:
            return _changing(explanation, whole, base)
        if isinstance(addition, str):
            return _drifting(explanation, addition, *quick)
        slow = explanation.changed is not None or takes_time(addition)
        return _acting(explanation, addition, starts, *((whole, base) if slow else quick))

    return list(pool.map(candidate, expansions(base, whole.data, drifts).items()))


def most_promising(candidates: list[Candidate], most: int) -> list[Candidate]:
    """The `most` candidates for which a linear step promises the lowest error."""
    return sorted(candidates, key=lambda candidate: candidate.promise)[:most]


def _changing(explanation: Explanation, estimator: Estimator, base: Fit) -> Candidate:
    """The candidate with a change in mid-recording added to `base`, at the times that gain most."""
    name = explanation.changed
    assert name is not None
    starts = _worthwhile(change_starts(estimator, base, name, STARTS_TRIED), base)
    return Candidate(explanation, name, estimator, base, tuple(start for _, start in starts))


def _drifting(explanation: Explanation, name: str, estimator: Estimator, base: Fit) -> Candidate:
    """The candidate with one more drift added to `base`."""
    promise = promised_left(estimator.at(explanation, base.values))
    starts = _worthwhile([(promise, base.values)], base)
    return Candidate(explanation, name, estimator, base, tuple(start for _, start in starts), _error(promise, base))


def _acting(
    explanation: Explanation, variant: Variant, starts: list[Start], estimator: Estimator, base: Fit
) -> Candidate:
    """The candidate with one more effect added to `base`, from the starts that promise most, if any does."""
    found = _worthwhile(promised(estimator, base, variant, starts)[:STARTS_TRIED], base)
    promise = min((chi2 for chi2, _ in found), default=np.inf)
    chosen = tuple({**base.values, **start} for _, start in found)
    return Candidate(explanation, variant, estimator, base, chosen, _error(promise, base))


def _worthwhile(starts: Sequence[Promised], base: Fit) -> Sequence[Promised]:
    """The starts that promise a noticeable gain if `base` is adequate, otherwise all starts."""
    if not adequate(base):
        return starts
    return [(chi2, start) for chi2, start in starts if base.chi2 - chi2 > PROMISING]


def _error(chi2: float, fit: Fit) -> float:
    """The error over noise that belongs to a sum of squares on the samples of `fit`."""
    return float(np.sqrt(chi2 / fit.solution.residual.size))
