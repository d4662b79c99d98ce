"""Larger explanations, counted against what remains."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Mapping
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import cached_property
from typing import TypeVar

from pierburg_ros.diagnosis.search.candidates import Addition, drifting, starts_of, with_drifts
from pierburg_ros.diagnosis.search.linear import promised, promised_by_drift
from pierburg_ros.diagnosis.search.scored import Scored, estimator_beside, plausible, scored, strange
from pierburg_ros.diagnosis.search.tried import Progress
from pierburg_ros.effects import EFFECT
from pierburg_ros.effects.effect import Start
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.estimation.explanation import Explanation, Variant, canonical, without
from pierburg_ros.estimation.least_squares import BRIEF
from pierburg_ros.plant import Model

FOLLOWED = 5
"""Additions of each round and way that are fitted, of those that a linear step promises most. Work: each costs a brief
descent and a search for the discrepancy; in a trial beside a remainder the true effect promised fourth most."""
SETTLED = 3
"""How many additions of each round are fitted again, each with its own discrepancy, of those that are likeliest as they
are. Work: each costs a brief descent and a search for the discrepancy; not varied."""


@dataclass(frozen=True)
class _Promise:
    """An explanation to be fitted from a start, by the chi2 that a linear step promises."""

    chi2: float
    explanation: Explanation
    start: dict[str, float]


def grown(data: Data, nominal: Model, base: Scored, pool: Executor, progress: Progress) -> list[Scored]:
    """The likeliest explanations with one quantity more than `base`, the best first.

    They are looked for in two ways. Beside a discrepancy as large as all that is missing nothing seems to be missing,
    and a descent hardly moves. By the squared error alone it goes far, but bends to whatever remains. All that is found
    is fitted with its own discrepancy, and the likeliest counts.
    """
    beside, alone = estimator_beside(data, nominal, base.discrepancy), Estimator(data, nominal)
    own, values = base.fit.explanation, base.fit.values
    ways = [_Way(beside, beside.restated(base.fit), progress), _Way(alone, alone.fit(own, values, BRIEF), progress)]
    # each step of both is handed out at once, so that no core waits for the other way
    promises = [pool.map(way.promise, way.tasks) for way in ways]
    followed = [(way, one) for way, each in zip(ways, promises, strict=True) for one in _lowest(filter(None, each))]
    fitted = pool.map(lambda one: (one[0], one[0].fitted(one[1])), followed)
    sensible = [(way, fit) for way, fit in fitted if not strange(fit, data, nominal)]
    reached = pool.map(lambda one: (one[0], scored(data, one[1])), sensible)
    best: dict[Explanation, tuple[_Way, Scored]] = {}
    for way, each in sorted(reached, key=lambda one: one[1].cost):
        best.setdefault(each.fit.explanation, (way, each))
    ahead = pool.map(lambda one: one[0].begun_anew(one[1].fit), itertools.islice(best.values(), SETTLED))
    return _likeliest(ahead, data, nominal, pool)


def drifted(data: Data, nominal: Model, base: Scored, pool: Executor, progress: Progress) -> list[Scored]:
    """The likeliest explanations with two more drifting parameters than `base`, the best first.

    What a linear step promises of two at once says little: all pairs are fitted.
    """
    estimator, own = Estimator(data, nominal), base.fit.explanation
    progress(f"{own.label}, beside two drifts")
    begin = estimator.fit(own, base.fit.values, BRIEF).values
    fits = pool.map(lambda pair: estimator.fit(pair, begin, BRIEF), with_drifts(own, drifting(nominal), 2))
    return _likeliest(_lowest(fits), data, nominal, pool)


def _likeliest(fits: Iterable[Fit], data: Data, nominal: Model, pool: Executor) -> list[Scored]:
    """Fits of plausible values, each with its own discrepancy, the best first."""
    return sorted(plausible(fits, data, nominal, pool), key=lambda each: each.cost)


@dataclass(frozen=True)
class _Way:
    """One way to look for explanations with one quantity more than `base`: as an `estimator` counts."""

    estimator: Estimator
    base: Fit
    progress: Progress

    @cached_property
    def drifts(self) -> tuple[str, ...]:
        """Names of what may drift."""
        return drifting(self.estimator.nominal)

    @cached_property
    def starts(self) -> dict[Variant, list[Start]]:
        """What effects may be added, each with its starts."""
        return starts_of(self.estimator.data, self.base.model)

    @property
    def tasks(self) -> list[tuple[Addition, list[Start]]]:
        """All that may be added."""
        return [*((name, []) for name in self.drifts), *self.starts.items()]

    def promise(self, task: tuple[Addition, list[Start]]) -> _Promise | None:
        """What one linear step along an addition promises; None where it cannot be added."""
        addition, starts = task
        fit, own = self.base, self.base.explanation
        larger = (
            Explanation((*own.drifted, addition), own.variants) if isinstance(addition, str) else own.plus(addition)
        )
        explanation = canonical(larger, self.drifts)
        if explanation is None:
            return None
        if isinstance(addition, str):
            return _Promise(promised_by_drift(self.estimator.at(explanation, fit.values)), explanation, fit.values)
        ways = promised(self.estimator, fit, addition, starts)
        return _Promise(ways[0][0], explanation, {**fit.values, **ways[0][1]}) if ways else None

    def fitted(self, promise: _Promise) -> Fit:
        """The brief fit that was promised."""
        self.progress(f"{promise.explanation.label}, beside what remains")
        return self.estimator.fit(promise.explanation, promise.start, BRIEF)

    def begun_anew(self, fit: Fit) -> Fit:
        """`fit`, or a better one with an effect of the base begun anew."""
        return anew(
            self.estimator, fit, {one: self.starts[one] for one in self.base.explanation.variants if one in self.starts}
        )


_Counted = TypeVar("_Counted", Fit, _Promise)


def _lowest(found: Iterable[_Counted]) -> list[_Counted]:
    """Those that are followed, for they leave least."""
    return sorted(found, key=lambda each: each.chi2)[:FOLLOWED]


def anew(estimator: Estimator, fit: Fit, starts: Mapping[Variant, list[Start]]) -> Fit:
    """`fit`, or a better one with one of its effects whose events jump begun anew beside the others, from its `starts`.

    Such an effect was fitted in the place of what has been added since, and may lie in another local minimum by now.
    """
    best = fit
    for variant, own in starts.items():
        if EFFECT[variant.effect].jumps:
            rest = estimator.fit(without(fit.explanation, variant), fit.values, BRIEF)
            ways = promised(estimator, rest, variant, own)[:1]
            again = [estimator.fit(fit.explanation, {**rest.values, **start}, BRIEF) for _, start in ways]
            best = min((best, *again), key=lambda each: each.chi2)
    return best
