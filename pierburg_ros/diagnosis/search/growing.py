"""Larger explanations, scored with the remainder as a part of the likelihood."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Mapping
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import cached_property

from pierburg_ros.diagnosis.search.candidates import Addition, drifting, starts_of, with_drifts
from pierburg_ros.diagnosis.search.linear import promised, promised_left
from pierburg_ros.diagnosis.search.scored import Scored, estimator_beside, plausible, scored, strange
from pierburg_ros.diagnosis.search.tried import Progress
from pierburg_ros.effects import EFFECT
from pierburg_ros.effects.effect import Start
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.estimation.first_part import takes_time, where_shown
from pierburg_ros.inference.explanation import Explanation, Variant, canonical, without
from pierburg_ros.inference.least_squares import BRIEF
from pierburg_ros.plant import Model

FOLLOWED = 5
"""Number of additions that are fitted for each round and way, those for which a linear step promises most. Work: each
costs a brief descent and a search for the discrepancy; in a trial with a remainder, the true effect promised fourth
most."""
SETTLED = 3
"""Number of additions that are fitted again in each round, each with its own discrepancy, those that are most likely
before that. Work: each costs a brief descent and a search for the discrepancy; not varied."""


@dataclass(frozen=True)
class _Promise:
    """An explanation to be fitted from a start, with the share of chi2 that a linear step promises to leave."""

    left: float
    explanation: Explanation
    start: dict[str, float]


def grown(data: Data, nominal: Model, base: Scored, pool: Executor, progress: Progress) -> list[Scored]:
    """The most likely explanations with one quantity more than `base`, the best first.

    They are searched in two ways. With a discrepancy as large as the whole error, nothing seems to be missing, and a
    descent hardly moves. With the squared error alone, a descent goes far, but adapts to any remainder. The most likely
    results of both ways are fitted again with their own discrepancy, and the likelihood decides.
    """
    beside, alone = estimator_beside(data, nominal, base.discrepancy), Estimator(data, nominal)
    own, values = base.fit.explanation, base.fit.values
    ways = [_Way(beside, beside.restated(base.fit), progress), _Way(alone, alone.fit(own, values, BRIEF), progress)]
    # the steps of both ways are handed out together, so that no core waits
    promises = [pool.map(way.promise, way.tasks) for way in ways]
    followed = [(way, one) for way, each in zip(ways, promises, strict=True) for one in _ahead(each)]
    fitted = pool.map(lambda one: (one[0], one[0].fitted(one[1])), followed)
    sensible = [(way, fit) for way, fit in fitted if not strange(fit, data, nominal)]
    reached = pool.map(lambda one: (one[0], scored(data, one[1])), sensible)
    best: dict[Explanation, tuple[_Way, Scored]] = {}
    for way, each in sorted(reached, key=lambda one: one[1].cost):
        best.setdefault(each.fit.explanation, (way, each))
    ahead = pool.map(lambda one: one[0].begun_anew(one[1].fit), itertools.islice(best.values(), SETTLED))
    return _likeliest(ahead, data, nominal, pool)


def drifted(data: Data, nominal: Model, base: Scored, pool: Executor, progress: Progress) -> list[Scored]:
    """The most likely explanations with two more drifting parameters than `base`, the best first.

    A linear step says little about two parameters at once, so all pairs are fitted.
    """
    estimator, own = Estimator(data, nominal), base.fit.explanation
    progress(f"{own.label}, beside two drifts")
    begin = estimator.fit(own, base.fit.values, BRIEF).values
    fits = pool.map(lambda pair: estimator.fit(pair, begin, BRIEF), with_drifts(own, drifting(nominal), 2))
    return _likeliest(sorted(fits, key=lambda fit: fit.chi2)[:FOLLOWED], data, nominal, pool)


def _likeliest(fits: Iterable[Fit], data: Data, nominal: Model, pool: Executor) -> list[Scored]:
    """Those `fits` that have plausible values, each with its own discrepancy, the best first."""
    return sorted(plausible(fits, data, nominal, pool), key=lambda each: each.cost)


@dataclass(frozen=True)
class _Way:
    """One way to search for explanations with one quantity more than `base`: with the cost of an `estimator`."""

    estimator: Estimator
    base: Fit
    progress: Progress

    @cached_property
    def drifts(self) -> tuple[str, ...]:
        """Names of the parameters that may drift."""
        return drifting(self.estimator.nominal)

    @cached_property
    def starts(self) -> dict[Variant, list[Start]]:
        """The effects that may be added, each with its starts."""
        return starts_of(self.estimator.data, self.base.model)

    @property
    def tasks(self) -> list[tuple[Addition, list[Start]]]:
        """All possible additions, each with its starts."""
        return [*((name, []) for name in self.drifts), *self.starts.items()]

    @cached_property
    def quick(self) -> tuple[Estimator, Fit]:
        """Where a promise is evaluated unless it takes time: an estimator, and `base` there."""
        return where_shown(self.base, self.estimator)

    def promise(self, task: tuple[Addition, list[Start]]) -> _Promise | None:
        """What one linear step along an addition promises; None if it cannot be added."""
        addition, starts = task
        slow = isinstance(addition, Variant) and takes_time(addition)
        estimator, fit = (self.estimator, self.base) if slow else self.quick
        own, before = fit.explanation, promised_left(fit)
        larger = (
            Explanation((*own.drifted, addition), own.variants) if isinstance(addition, str) else own.plus(addition)
        )
        explanation = canonical(larger, self.drifts)
        if explanation is None:
            return None
        if isinstance(addition, str):
            return _Promise(promised_left(estimator.at(explanation, fit.values)) / before, explanation, fit.values)
        ways = promised(estimator, fit, addition, starts)
        return _Promise(ways[0][0] / before, explanation, {**fit.values, **ways[0][1]}) if ways else None

    def fitted(self, promise: _Promise) -> Fit:
        """The brief fit from the start of a promise."""
        self.progress(f"{promise.explanation.label}, beside what remains")
        return self.estimator.fit(promise.explanation, promise.start, BRIEF)

    def begun_anew(self, fit: Fit) -> Fit:
        """`fit`, or a better one in which an effect of `base` begins from new starts."""
        return anew(
            self.estimator, fit, {one: self.starts[one] for one in self.base.explanation.variants if one in self.starts}
        )


def _ahead(promises: Iterable[_Promise | None]) -> list[_Promise]:
    """The `FOLLOWED` promises of those that could be made that leave least."""
    return sorted(filter(None, promises), key=lambda each: each.left)[:FOLLOWED]


def anew(estimator: Estimator, fit: Fit, starts: Mapping[Variant, list[Start]]) -> Fit:
    """`fit`, or a better one in which one effect with many local minima begins anew from its `starts`.

    Such an effect was fitted before the last quantity was added, and made up for its absence. It may lie in another
    local minimum by now.
    """
    best = fit
    for variant, own in starts.items():
        if EFFECT[variant.effect].jumps:
            rest = estimator.fit(without(fit.explanation, variant), fit.values, BRIEF)
            ways = promised(estimator, rest, variant, own)[:1]
            again = [estimator.fit(fit.explanation, {**rest.values, **start}, BRIEF) for _, start in ways]
            best = min((best, *again), key=lambda each: each.chi2)
    return best
