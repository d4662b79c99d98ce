"""What recordings support although something remains: quantities added one by one, counted against what remains."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from concurrent.futures import Executor
from dataclasses import dataclass

from pierburg_ros.diagnosis.search.candidates import Addition, drifting, starts_of
from pierburg_ros.diagnosis.search.linear import promised, promised_by_drift
from pierburg_ros.diagnosis.search.scored import Scored, scored, settled
from pierburg_ros.diagnosis.search.screening import STARTS_TRIED
from pierburg_ros.diagnosis.search.selection import SIGNIFICANT
from pierburg_ros.diagnosis.search.tried import Progress
from pierburg_ros.effects.effect import Start
from pierburg_ros.errors import InputError
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.estimation.explanation import Explanation, Quantity, canonical, quantities, without
from pierburg_ros.estimation.least_squares import BRIEF
from pierburg_ros.plant import Model

FOLLOWED = 6
"""Additions of each round that are fitted, of those that a linear step promises most. Work: each costs two brief
descents; not varied."""
SETTLED = 3
"""How many of them are fitted again, each with its own discrepancy. Work: each costs a brief descent and a search for
the discrepancy; not varied."""
MOST = 4
"""Most quantities that are added. Work: each is a round of a second or more; not varied."""
CARRIED = 2.0 / 3.0
"""Share that a quantity must carry of the evidence against the model without it; the rest remains with it as well.
Chosen: twice what remains; on n = 18 recordings true effects carried 0.68 to 0.93 of it when they were named, and
others at most 0.66 when that was decided; not varied."""
BARELY = 0.95
"""What is left after one more quantity, over what was left before, from which no further one is tried. Measured: n = 2
recordings that something else is in gained 1 to 5 % from then on; a quantity that is named leaves a third."""
OPEN = 0.1
"""What is left over what the nominal model leaves, in -2 log likelihood, up to which a search for an explanation of all
goes on. Measured: n = 3 recordings that something outside the catalogue is in left 0.23 to 0.72 of it; of n = 8 others
five left at most 0.06, and three 0.18 to 0.53, where adding one by one had missed what was there."""


@dataclass(frozen=True)
class Weight:
    """What speaks for a quantity, in -2 log likelihood: what leaving it out costs, `gain`, and what is `left` with it.

    Left is how much less likely the residual is than white noise of the sensor's size.
    """

    gain: float
    left: float

    @property
    def carried(self) -> float:
        """Share of the evidence against the model without the quantity that it carries, 0 to 1."""
        gain, left = max(self.gain, 0.0), max(self.left, 0.0)
        return gain / max(gain + left, 1e-9)


@dataclass(frozen=True)
class Supported:
    """An explanation with its likelihood, and the weight of each of its quantities.

    `nominal` is the model that it changes: the nominal one, on a shaft that goes round with the lesser orders of the
    torque over a turn.
    """

    nominal: Model
    scored: Scored
    weights: Mapping[Quantity, Weight]


@dataclass(frozen=True)
class Beside:
    """What recordings say when they are counted against what remains.

    The likeliest explanation `reached`, what the nominal model leaves (`begun`, in -2 log likelihood), and the
    explanation that may be `named`, None if there is none.
    """

    reached: Scored
    begun: float
    named: Supported | None

    @property
    def open(self) -> bool:
        """Whether so little is left that an explanation of its size may account for all."""
        return self.reached.left < OPEN * self.begun


def supported(data: Data, nominal: Model, pool: Executor, progress: Progress) -> Beside:
    """The likeliest explanation, and the largest of which each quantity carries most of the evidence against the rest.

    Quantities are added to the nominal model one by one, each the one that makes the recordings likeliest with its own
    most likely discrepancy: an effect that bends to a part of what remains gains no more than that part. Of the named,
    those that do not carry enough are taken away again, the weakest first. It ends where one more addition helps no
    further one, or too little is left for it.
    """
    named: Supported | None = None
    reached = scored(data, Estimator(data, nominal).at(Explanation()))
    begun = reached.left
    for _ in range(MOST):
        following = _grown(data, nominal, reached, pool, progress)
        if following is None:
            break
        weighed = _without(_weighed(data, nominal, following, pool), _idle, data, nominal, pool)
        before, reached = reached.left, weighed.scored
        # who carries that share of the evidence leaves no more of it
        carrying = None
        if reached.left <= (1.0 - CARRIED) * begun:
            carrying = _without(weighed, _weak, data, nominal, pool)
        if carrying and len(carrying.weights) > (len(named.weights) if named else 0):
            named = carrying
        elif named is not None or reached.left > BARELY * before:
            break
        if reached.left < SIGNIFICANT:
            break
    return Beside(reached, begun, named)


@dataclass(frozen=True)
class _Promise:
    """An explanation to be fitted from some starts, by the chi2 that a linear step promises."""

    chi2: float
    explanation: Explanation
    starts: list[dict[str, float]]


def _grown(data: Data, nominal: Model, base: Scored, pool: Executor, progress: Progress) -> Scored | None:
    """The likeliest explanation with one quantity more."""
    estimator = Estimator(data, nominal, discrepancy=base.discrepancy)
    fit, drifts = estimator.restated(base.fit), drifting(nominal)
    tasks: list[tuple[Addition, list[Start]]] = [(name, []) for name in drifts]
    tasks += list(starts_of(data, fit.model).items())
    promises = [each for each in pool.map(lambda task: _promise(estimator, fit, drifts, *task), tasks) if each]

    def fitted(promise: _Promise) -> Fit:
        progress(f"{promise.explanation.label}, beside what remains")
        fits = (estimator.fit(promise.explanation, start, BRIEF) for start in promise.starts)
        return min(fits, key=lambda fit: fit.chi2)

    followed = sorted(promises, key=lambda promise: promise.chi2)[:FOLLOWED]
    fits = sorted(pool.map(fitted, followed), key=lambda fit: fit.chi2)[:SETTLED]
    likely = pool.map(lambda fit: settled(data, nominal, fit), fits)
    return min(likely, key=lambda each: each.cost, default=None)


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
        return _Promise(promised_by_drift(estimator.at(explanation, fit.values)), explanation, [fit.values])
    ways = promised(estimator, fit, addition, starts)[:STARTS_TRIED]
    return _Promise(ways[0][0], explanation, [{**fit.values, **start} for _, start in ways]) if ways else None


def _idle(weight: Weight) -> bool:
    """Whether a quantity gains too little: a later one has made it needless."""
    return weight.gain < SIGNIFICANT


def _weak(weight: Weight) -> bool:
    """Whether a quantity does not carry enough of the evidence."""
    return weight.carried < CARRIED


def _without(
    weighed: Supported, out: Callable[[Weight], bool], data: Data, nominal: Model, pool: Executor
) -> Supported:
    """The explanation without the quantities that are `out`: the weakest goes first, then all are weighed again."""
    while any(out(weight) for weight in weighed.weights.values()):
        weakest = min(weighed.weights, key=lambda quantity: weighed.weights[quantity].gain)
        best = weighed.scored
        estimator = Estimator(data, nominal, discrepancy=best.discrepancy)
        rest = estimator.fit(without(best.fit.explanation, weakest), best.fit.values, BRIEF)
        weighed = _weighed(data, nominal, settled(data, nominal, rest), pool)
    return weighed


def _weighed(data: Data, nominal: Model, best: Scored, pool: Executor) -> Supported:
    """The weight of each quantity: what the others, fitted again with their own discrepancy, leave without it."""
    estimator = Estimator(data, nominal, discrepancy=best.discrepancy)

    def lacking(quantity: Quantity) -> float:
        rest = without(best.fit.explanation, quantity)
        try:
            return settled(data, nominal, estimator.fit(rest, best.fit.values, BRIEF)).cost
        except InputError:
            return best.cost

    own = quantities(best.fit.explanation)
    costs = zip(own, pool.map(lacking, own), strict=True)
    return Supported(nominal, best, {quantity: Weight(cost - best.cost, best.left) for quantity, cost in costs})
