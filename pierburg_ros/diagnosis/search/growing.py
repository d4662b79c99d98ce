"""Explanations with one quantity more, counted against what remains."""

from __future__ import annotations

from collections.abc import Mapping
from concurrent.futures import Executor
from dataclasses import dataclass

from pierburg_ros.diagnosis.search.candidates import Addition, drifting, starts_of
from pierburg_ros.diagnosis.search.linear import promised, promised_by_drift
from pierburg_ros.diagnosis.search.scored import Scored, estimator_beside, plausible
from pierburg_ros.diagnosis.search.tried import Progress
from pierburg_ros.effects import EFFECT
from pierburg_ros.effects.effect import Start
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.estimation.explanation import Explanation, Variant, canonical, without
from pierburg_ros.estimation.least_squares import BRIEF
from pierburg_ros.plant import Model

FOLLOWED = 3
"""Additions of each round and way that are fitted, of those that a linear step promises most. Work: each costs a brief
descent; with 6, and 3 fitted again, no more of n = 4 trials beside a remainder were named."""
SETTLED = 2
"""How many of them are fitted again, each with its own discrepancy. Work: each costs a brief descent and a search for
the discrepancy."""


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
    own, values = base.fit.explanation, base.fit.values
    beside, alone = estimator_beside(data, nominal, base.discrepancy), Estimator(data, nominal)
    ways = [(beside, beside.restated(base.fit)), (alone, alone.fit(own, values, BRIEF))]
    found = [fit for estimator, begin in ways for fit in _larger(estimator, begin, pool, progress)]
    return sorted(plausible(found, data, nominal, pool), key=lambda each: each.cost)


def _larger(estimator: Estimator, base: Fit, pool: Executor, progress: Progress) -> list[Fit]:
    """The best fits of explanations with one quantity more than `base`, as an `estimator` counts."""
    drifts, known = drifting(estimator.nominal), starts_of(estimator.data, base.model)
    tasks: list[tuple[Addition, list[Start]]] = [*((name, []) for name in drifts), *known.items()]
    promises = [each for each in pool.map(lambda task: _promise(estimator, base, drifts, *task), tasks) if each]

    def fitted(promise: _Promise) -> Fit:
        progress(f"{promise.explanation.label}, beside what remains")
        return estimator.fit(promise.explanation, promise.start, BRIEF)

    def again(fit: Fit) -> Fit:
        return anew(estimator, fit, {one: known[one] for one in base.explanation.variants if one in known})

    followed = sorted(promises, key=lambda promise: promise.chi2)[:FOLLOWED]
    fits = sorted(pool.map(fitted, followed), key=lambda fit: fit.chi2)[:SETTLED]
    return list(pool.map(again, fits))


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


def _promise(
    estimator: Estimator, fit: Fit, drifts: tuple[str, ...], addition: Addition, starts: list[Start]
) -> _Promise | None:
    """What one linear step along an addition promises; None where it cannot be added."""
    own = fit.explanation
    larger = Explanation((*own.drifted, addition), own.variants) if isinstance(addition, str) else own.plus(addition)
    explanation = canonical(larger, drifts)
    if explanation is None:
        return None
    if isinstance(addition, str):
        return _Promise(promised_by_drift(estimator.at(explanation, fit.values)), explanation, fit.values)
    ways = promised(estimator, fit, addition, starts)
    return _Promise(ways[0][0], explanation, {**fit.values, **ways[0][1]}) if ways else None
