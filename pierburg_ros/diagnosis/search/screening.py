"""What may be added to an explanation, ranked by how far a linear step along it promises to come."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass

import numpy as np

from pierburg_ros.diagnosis.search.candidates import Addition, expansions
from pierburg_ros.diagnosis.search.linear import change_starts, promised, promised_by_drift
from pierburg_ros.diagnosis.search.selection import PROMISING, adequate
from pierburg_ros.effects import EFFECT
from pierburg_ros.effects.effect import Start
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.estimation.explanation import Explanation, Variant

LATE = 0.5
"""Excess of squared error in a first look, as a share of the whole, below which the look takes in everything. Derived:
less than half of what is left to explain would be seen."""
STARTS_TRIED = 2
"""Starts from which a first look is taken. Work: each costs one brief fit; not varied."""


@dataclass(frozen=True)
class Prospect:
    """An explanation to look at, by what it is grown: on which samples, from which starts.

    `base` is the fit that it grows on, on the same samples, `promise` the error over noise that a linear step
    from there comes to, infinite where none was made.
    """

    explanation: Explanation
    addition: Addition
    estimator: Estimator
    base: Fit
    starts: tuple[dict[str, float], ...]
    promise: float = np.inf

    @property
    def jumps(self) -> bool:
        """Whether the cost has many local minima along what is added."""
        return isinstance(self.addition, Variant) and EFFECT[self.addition.effect].jumps

    @property
    def drifts(self) -> bool:
        """Whether it grows by a drift: cheap to look at, and perhaps what others grow on."""
        return self.addition in self.explanation.drifted

    @property
    def changes(self) -> bool:
        """Whether it grows by a change in the middle of the recording."""
        return self.addition == self.explanation.changed


def screened(
    fit: Fit,
    whole: Estimator,
    glance: Estimator,
    drifts: tuple[str, ...],
    pool: Executor,
    progress: Callable[[str], None],
) -> list[Prospect]:
    """Every addition to `fit` with its promise: at a `glance`, the first part of each run, where that shows it."""
    base = whole.restated(fit)
    brief = glance.restated(base)
    quick = (whole, base) if _shows_late(brief, base) else (glance, brief)

    def prospect(task: tuple[Explanation, tuple[Addition, list[Start]]]) -> Prospect:
        explanation, (addition, starts) = task
        progress(explanation.label)
        if explanation.changed != fit.explanation.changed:
            return _changing(explanation, whole, base)
        if isinstance(addition, str):
            return _drifting(explanation, addition, *quick)
        slow = explanation.changed is not None or _takes_time(addition)
        return _acting(explanation, addition, starts, *((whole, base) if slow else quick))

    return list(pool.map(prospect, expansions(base, whole.data, drifts).items()))


def most_promising(prospects: list[Prospect], most: int) -> list[Prospect]:
    """The first so many by what a linear step promises."""
    return sorted(prospects, key=lambda prospect: prospect.promise)[:most]


def _takes_time(variant: Variant) -> bool:
    """Whether an effect goes by the time since the start: the first part of a recording may not show it."""
    effect = EFFECT[variant.effect]
    return effect.dated or effect.memory == "lasting"


def _changing(explanation: Explanation, estimator: Estimator, base: Fit) -> Prospect:
    """A change in the middle of the recording on top of `base`, at the moments that gain most."""
    name = explanation.changed
    assert name is not None
    starts = change_starts(estimator, base, name, STARTS_TRIED)
    return Prospect(explanation, name, estimator, base, tuple(starts))


def _drifting(explanation: Explanation, name: str, estimator: Estimator, base: Fit) -> Prospect:
    """One more drift on top of `base`."""
    promise = promised_by_drift(estimator.at(explanation, base.values))
    return Prospect(explanation, name, estimator, base, (base.values,), _error(promise, base))


def _acting(
    explanation: Explanation, variant: Variant, starts: list[Start], estimator: Estimator, base: Fit
) -> Prospect:
    """One more effect on top of `base`, from the starts that promise most, if any does."""
    found = promised(estimator, base, variant, starts)[:STARTS_TRIED]
    if adequate(base):
        found = [pair for pair in found if base.chi2 - pair[0] > PROMISING]
    promise = min((chi2 for chi2, _ in found), default=np.inf)
    chosen = tuple({**base.values, **start} for _, start in found)
    return Prospect(explanation, variant, estimator, base, chosen, _error(promise, base))


def _error(chi2: float, fit: Fit) -> float:
    """Error over noise that a sum of squares on the samples of `fit` amounts to."""
    return float(np.sqrt(chi2 / fit.solution.residual.size))


def _shows_late(glance: Fit, whole: Fit) -> bool:
    """Whether the first look would miss most of what is left to explain."""
    return glance.ratio**2 - 1.0 < LATE * (whole.ratio**2 - 1.0)
