"""What recordings support although something remains: quantities added one by one, counted against what remains."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import Executor
from dataclasses import dataclass, replace

from pierburg_ros.deadline import OutOfTime
from pierburg_ros.diagnosis.search.candidates import Addition, drifting, starts_of
from pierburg_ros.diagnosis.search.linear import promised, promised_by_drift
from pierburg_ros.diagnosis.search.moved import moved
from pierburg_ros.diagnosis.search.reversals import Play, play_at_reversals
from pierburg_ros.diagnosis.search.scored import Scored, estimator_beside, scored, settled
from pierburg_ros.diagnosis.search.selection import PROMISING, SIGNIFICANT
from pierburg_ros.diagnosis.search.tried import Progress
from pierburg_ros.effects import EFFECT
from pierburg_ros.effects.effect import Start
from pierburg_ros.errors import InputError
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.estimation.explanation import Explanation, Quantity, Variant, canonical, quantities, without
from pierburg_ros.estimation.least_squares import BRIEF
from pierburg_ros.estimation.prior import implausible
from pierburg_ros.plant import Model

FOLLOWED = 6
"""Additions of each round that are fitted, of those that a linear step promises most. Work: each costs two brief
descents; not varied."""
SETTLED = 3
"""How many of them are fitted again, each with its own discrepancy. Work: each costs a brief descent and a search for
the discrepancy; not varied."""
MOST = 4
"""Most quantities that are added. Work: each is a round of a second or more; not varied."""
CONFIRMED = 0.5
"""Share of the gain of a quantity, from the samples that train to as many that validate, that these must show as well.
Derived: halfway between what fits the training samples alone, none of it, and what is there, all of it."""
EXPLAINS = 0.5
"""Share of the mean square, of what a quantity moves and of what remains, that it must move (`moved.py`). Derived: what
it moves is then no less than what remains, which is also what makes an effect shown in a trial."""
CARRIES = 0.25
"""Share of the evidence against the model without it that an effect carries at least. Measured: of n = 16 trials with
an effect beside a remainder right names carried 0.34 or more, and wrong ones, where the search had missed what is
there, 0.11 or less."""
ALONE = 0.8
"""Confidence of a name beside a remainder that nothing else comes near. Measured: Laplace's rule of succession, since
of effects put into real recordings all of n = 3 such names were right. With one to three rivals three of six were:
about the share of one among equals."""
OPEN = 1.0 / 3.0
"""What is left over what the nominal model leaves, in -2 log likelihood, up to which a search for an explanation of all
goes on. Measured: of n = 5 recordings three that something outside the catalogue is in left 0.22, 0.65 and 0.92 of it,
and two that were explained after all 0.18 and 0.19; one that goes on in vain costs time and no name."""


@dataclass(frozen=True)
class Weight:
    """What speaks for a quantity, in -2 log likelihood: what leaving it out costs, `gain`, and what is `left` with it.

    Left is how much less likely the residual is than white noise of the sensor's size. `unseen` is what leaving it out
    costs on samples that validate, None where they were asked otherwise; of a quantity that is there as much as they
    are `expected` to show: its gain by their number over that of those that train. `explains` is the share of the mean
    square that it moves, beside what remains, None where that was not asked; `plausible`: its values are such as 95 of
    100 actuators have. `instead` are effects or drifting parameters that gain almost as much in its place. `by_rule` is
    the share of what a controller's rule leaves that goes with it, None where no controller vouches for it
    (`witness.py`).
    """

    gain: float
    left: float
    unseen: float | None = None
    expected: float = 0.0
    explains: float | None = None
    plausible: bool = True
    instead: tuple[str, ...] = ()
    by_rule: float | None = None

    @property
    def carried(self) -> float:
        """Share of the evidence against the model without the quantity that it carries, 0 to 1."""
        gain, left = max(self.gain, 0.0), max(self.left, 0.0)
        return gain / max(gain + left, 1e-9)

    @property
    def confirmed(self) -> bool:
        """Whether samples that no fit has seen say the same."""
        return self.unseen is None or self.unseen >= CONFIRMED * self.expected

    @property
    def believed(self) -> bool:
        """Whether it explains enough with values that an actuator has, and unseen samples confirm it."""
        return (self.explains is None or self.explains >= EXPLAINS) and self.plausible and self.confirmed

    @property
    def confidence(self) -> float:
        """How far it is believed: of equals each is as likely as another; what was asked otherwise by its share."""
        if self.by_rule is not None:
            return self.by_rule / (1 + len(self.instead))
        return self.carried if self.unseen is None else ALONE / (1 + len(self.instead))


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

    The likeliest explanation `reached`, what the nominal model leaves (`begun`, in -2 log likelihood), and what of it
    unseen samples have `confirmed`; where it was `stopped`, what was known by then.
    """

    reached: Scored
    begun: float
    confirmed: Supported
    stopped: bool = False

    @property
    def open(self) -> bool:
        """Whether so little is left that an explanation of its size may account for all."""
        return self.begun > 0.0 and self.reached.left < OPEN * self.begun


def supported(data: Data, nominal: Model, known: Iterable[Fit], pool: Executor, progress: Progress) -> Beside:
    """The likeliest explanation, and what of it unseen samples confirm; `known` are fits that a search has made.

    Quantities are added to the nominal model one by one, each the one that makes the recordings likeliest with its own
    most likely discrepancy and values that actuators have: an effect that bends to a part of what remains gains no more
    than that part. It ends where one more helps no further. Beside a discrepancy as large as all that is missing, a
    descent sees little of an effect: what is known to come nearest without one is taken where it is likelier. What
    bends to a remainder gains where it was fitted, and not on samples that validate: of the named, those without whose
    gain there are taken away again, the weakest first. The later ones may bend and take from those before: what is
    confirmed is heard after each, and the likeliest of that is told.
    """
    reached = scored(data, Estimator(data, nominal).at(Explanation()))
    begun, confirmed = reached.left, Supported(nominal, reached, {})
    stopped = False
    try:
        begin = _nearest(fit for fit in known if not _strange(fit, data, nominal))
        near = _settled(begin, data, nominal, pool)
        for _ in range(MOST):
            grown = [*_grown(data, nominal, reached, pool, progress)[:1], *near]
            better = (each for each in grown if _likelier(each, reached))
            following = min(better, key=lambda each: each.cost, default=None)
            if following is None:
                break
            weighed = _without(_weighed(data, nominal, following, pool), _idle, data, nominal, pool)
            reached = weighed.scored
            now = _without(weighed, _unconfirmed, data, nominal, pool)
            confirmed = _likelier_of(confirmed, now)
    except OutOfTime:
        stopped = True
    return Beside(reached, begun, confirmed, stopped)


def _likelier_of(*confirmed: Supported) -> Supported:
    """Of what unseen samples confirm that which makes the recordings likeliest."""
    return min(confirmed, key=lambda each: each.scored.cost)


def _nearest(known: Iterable[Fit]) -> list[Fit]:
    """Of each size the fit that leaves least, without a change in the middle."""
    best: dict[int, Fit] = {}
    for fit in known:
        size = fit.explanation.size
        if fit.explanation.changed is None and 0 < size <= MOST and (size not in best or fit.chi2 < best[size].chi2):
            best[size] = fit
    return list(best.values())


def _settled(fits: Iterable[Fit], data: Data, nominal: Model, pool: Executor) -> list[Scored]:
    """`fits` settled, those with effects of values that few actuators have left out: what bends often has such."""
    found = pool.map(lambda fit: settled(data, nominal, fit), fits)
    return [each for each in found if not _strange(each.fit, data, nominal)]


def _strange(fit: Fit, data: Data, nominal: Model) -> set[str]:
    """Names of the effects' values that few actuators have."""
    coordinates = Estimator(data, nominal).coordinates(fit.explanation)
    return {name for name in implausible(coordinates, coordinates.point(fit.values)) if "." in name}


def _likelier(larger: Scored, smaller: Scored) -> bool:
    """Whether each quantity that one has more than the other makes the recordings likelier by what names one."""
    more = larger.fit.explanation.size - smaller.fit.explanation.size
    return more > 0 and smaller.cost - larger.cost >= SIGNIFICANT * more


def likelier(beside: Beside, fit: Fit, data: Data, nominal: Model, pool: Executor) -> Beside:
    """`beside`, or with a `fit` of plausible values that makes the recordings likelier by as much as names a quantity.

    Quantities that are added one by one may miss what a search has found together.
    """
    reached = settled(data, nominal, fit)
    if beside.reached.cost - reached.cost < SIGNIFICANT or _strange(reached.fit, data, nominal):
        return beside
    now = _without(_weighed(data, nominal, reached, pool), _unconfirmed, data, nominal, pool)
    return replace(beside, reached=reached, confirmed=_likelier_of(beside.confirmed, now))


def confirmed_beside(fit: Fit, data: Data, nominal: Model, pool: Executor) -> bool:
    """Whether unseen samples confirm all effects of a `fit` beside what remains, however little of it they explain."""
    weights = _weighed(data, nominal, settled(data, nominal, fit), pool).weights
    effects = {quantity: weight for quantity, weight in weights.items() if isinstance(quantity, Variant)}
    return all(weight.confirmed and not _idle(quantity, weight) for quantity, weight in effects.items())


def told_apart(named: Supported, data: Data, nominal: Model, pool: Executor, progress: Progress) -> Supported:
    """What of `named` may be named, each effect with what could stand in its place.

    An effect that a drift could stand for is not: of equals that with fewer effects is taken.
    """
    told, drifts = _with_rivals(named, data, nominal, pool, progress), set(drifting(nominal))
    doubted = {quantity for quantity, weight in told.weights.items() if drifts & set(weight.instead)}
    if not doubted:
        return told
    rest = _without(told, lambda quantity, _: quantity in doubted, data, nominal, pool)
    return told_apart(rest, data, nominal, pool, progress)


def with_play(named: Supported, reached: Fit, data: Data, nominal: Model) -> Supported:
    """`named` and the play of the sensor that shows at reversals, beside `named` as beside what was `reached`.

    A simulation that is wrong by more than the play turns round elsewhere, and a play does it no good. A spring that
    gives way lags behind at reversals too: what stands in for it may not be named, but takes that play away.
    """
    own = named.scored.fit
    play = play_at_reversals(data, own)
    if play is None or play.gain < PROMISING or not _shows(play, reached, data):
        return named
    fit = Estimator(data, nominal).at(own.explanation.plus(play.variant), own.values)
    weights = {**named.weights, play.variant: Weight(play.gain, play.left)}
    return Supported(nominal, scored(data, fit), weights)


def _shows(play: Play, fit: Fit, data: Data) -> bool:
    """Whether a fit has such a play, or leaves one."""
    again = play_at_reversals(data, fit)
    return play.variant.effect in fit.explanation.effects or (again is not None and again.gain >= PROMISING)


def _with_rivals(named: Supported, data: Data, nominal: Model, pool: Executor, progress: Progress) -> Supported:
    """`named` with what could stand in the place of each effect: what is less likely by less than would name it."""
    weights = dict(named.weights)
    for quantity, weight in weights.items():
        if isinstance(quantity, Variant):
            rest = _lacking(data, nominal, named.scored, quantity)
            others = _grown(data, nominal, rest, pool, progress)
            near = [each.fit.explanation for each in others if each.cost - named.scored.cost < SIGNIFICANT]
            added = (set(quantities(each)) - set(quantities(rest.fit.explanation)) for each in near)
            ids = dict.fromkeys(one if isinstance(one, str) else one.effect for each in added for one in each)
            weights[quantity] = replace(weight, instead=tuple(each for each in ids if each != quantity.effect))
    return replace(named, weights=weights)


@dataclass(frozen=True)
class _Promise:
    """An explanation to be fitted from a start, by the chi2 that a linear step promises."""

    chi2: float
    explanation: Explanation
    start: dict[str, float]


def _grown(data: Data, nominal: Model, base: Scored, pool: Executor, progress: Progress) -> list[Scored]:
    """The likeliest explanations with one quantity more, the best first."""
    estimator = estimator_beside(data, nominal, base.discrepancy)
    fit, drifts = estimator.restated(base.fit), drifting(nominal)
    tasks: list[tuple[Addition, list[Start]]] = [(name, []) for name in drifts]
    tasks += list(starts_of(data, fit.model).items())
    promises = [each for each in pool.map(lambda task: _promise(estimator, fit, drifts, *task), tasks) if each]

    def fitted(promise: _Promise) -> Fit:
        progress(f"{promise.explanation.label}, beside what remains")
        return estimator.fit(promise.explanation, promise.start, BRIEF)

    followed = sorted(promises, key=lambda promise: promise.chi2)[:FOLLOWED]
    fits = sorted(pool.map(fitted, followed), key=lambda fit: fit.chi2)[:SETTLED]
    return sorted(_settled(fits, data, nominal, pool), key=lambda each: each.cost)


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


def _idle(quantity: Quantity, weight: Weight) -> bool:
    """Whether a quantity gains too little: a later one has made it needless."""
    return weight.gain < SIGNIFICANT


def _unconfirmed(quantity: Quantity, weight: Weight) -> bool:
    """Whether a quantity gains or explains too little, or gains nothing on unseen samples, as what acts only once.

    A parameter may drift a little beside an effect; an effect has to carry its part.
    """
    if _idle(quantity, weight) or not weight.believed:
        return True
    return isinstance(quantity, Variant) and (EFFECT[quantity.effect].dated or weight.carried < CARRIES)


def _without(
    weighed: Supported, out: Callable[[Quantity, Weight], bool], data: Data, nominal: Model, pool: Executor
) -> Supported:
    """The explanation without the quantities that are `out`: the weakest goes first, then all are weighed again."""
    while leaving := {quantity: each.gain for quantity, each in weighed.weights.items() if out(quantity, each)}:
        weakest = min(leaving, key=lambda quantity: leaving[quantity])
        best = weighed.scored
        estimator = estimator_beside(data, nominal, best.discrepancy)
        rest = estimator.fit(without(best.fit.explanation, weakest), best.fit.values, BRIEF)
        weighed = _weighed(data, nominal, settled(data, nominal, rest), pool)
    return weighed


def _weighed(data: Data, nominal: Model, best: Scored, pool: Executor) -> Supported:
    """The weight of each quantity: what the others, fitted again with their own discrepancy, leave without it."""
    strange = _strange(best.fit, data, nominal)

    def weight(quantity: Quantity, rest: Scored) -> Weight:
        gain, told = rest.cost - best.cost, shares[quantity]
        plausible = isinstance(quantity, str) or not {f"{quantity.effect}.{name}" for name in quantity.free} & strange
        return Weight(gain, best.left, rest.unseen - best.unseen, expected * gain, told, plausible)

    shares = moved(data, nominal, best.fit)
    expected = float(data.validation.sum() / data.train.sum())
    own = quantities(best.fit.explanation)
    rests = zip(own, pool.map(lambda quantity: _lacking(data, nominal, best, quantity), own), strict=True)
    return Supported(nominal, best, {quantity: weight(quantity, rest) for quantity, rest in rests})


def _lacking(data: Data, nominal: Model, best: Scored, quantity: Quantity) -> Scored:
    """The best without a quantity, its others fitted again with their own discrepancy; itself where that cannot be."""
    estimator = estimator_beside(data, nominal, best.discrepancy)
    rest = without(best.fit.explanation, quantity)
    try:
        return settled(data, nominal, estimator.fit(rest, best.fit.values, BRIEF))
    except InputError:
        return best
