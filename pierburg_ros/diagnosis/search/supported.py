"""What recordings support although something remains: quantities added one by one, counted against what remains."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from concurrent.futures import Executor
from dataclasses import dataclass, replace

from pierburg_ros.deadline import OutOfTime
from pierburg_ros.diagnosis.search.candidates import drifting
from pierburg_ros.diagnosis.search.growing import drifted, grown
from pierburg_ros.diagnosis.search.reversals import Play, play_at_reversals
from pierburg_ros.diagnosis.search.scored import Scored, plausible, scored, strange, unseen
from pierburg_ros.diagnosis.search.selection import PROMISING, SIGNIFICANT
from pierburg_ros.diagnosis.search.tried import Progress
from pierburg_ros.diagnosis.search.weighing import Supported, Weighing, Weight, idle
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.estimation.explanation import Explanation, Variant, quantities
from pierburg_ros.plant import Model

MOST = 4
"""Most quantities that are added. Work: each is a round of a second or more; not varied."""
OPEN = 1.0 / 3.0
"""What is left over what the nominal model leaves, in -2 log likelihood, up to which a search for an explanation of all
goes on. Measured: of n = 5 recordings three that something outside the catalogue is in left 0.22, 0.65 and 0.92 of it,
and two that were explained after all 0.18 and 0.19; one that goes on in vain costs time and no name."""


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

    What bends to a remainder gains where it was fitted, and not on samples that validate: of the named, those without
    whose gain there are taken away again, the weakest first. The later ones may bend and take from those before: what
    is confirmed is heard after each, and the likeliest of that is told, without what a likelier explanation can do
    without.
    """
    weighing = Weighing(data, nominal, pool)
    reached = scored(data, Estimator(data, nominal).at(Explanation()))
    begun, confirmed = reached.left, Supported(nominal, reached, {})
    stopped = False
    try:
        for told in _approached(weighing, reached, known, progress):
            reached = told.scored
            confirmed = _likeliest(confirmed, weighing.heard(told), reached)
    except OutOfTime:
        stopped = True
    return Beside(reached, begun, confirmed, stopped)


def _approached(weighing: Weighing, begin: Scored, known: Iterable[Fit], progress: Progress) -> Iterator[Supported]:
    """Ever likelier explanations: quantities added one by one to where they `begin`, then what is `known`.

    Beside a discrepancy as large as all that is missing, a descent sees little of an effect: what is known to come
    nearest without one goes on where it is likelier than all that was added, on samples that validate as well: as where
    many numbers of a description are off. It does not begin there: what is nearest of its size may be what bends most,
    and few quantities lead from there to what is there.
    """
    data, nominal, reached = weighing.data, weighing.nominal, begin
    for told in _added(weighing, begin, progress):
        reached = told.scored
        yield told
    nearest = _nearest(fit for fit in known if not strange(fit, data, nominal))
    ahead = [each for each in plausible(nearest, data, nominal, weighing.pool) if _likelier(each, reached)]
    left = unseen(data, reached.fit) if ahead else 0.0
    near = [each for each in ahead if unseen(data, each.fit) < left]
    if near:
        told = weighing.needed(min(near, key=_price))
        yield told
        yield from _added(weighing, told.scored, progress)


def _added(weighing: Weighing, begin: Scored, progress: Progress) -> Iterator[Supported]:
    """Explanations with one quantity more each, until one more helps no further.

    Each is the one that makes the recordings likeliest with its own most likely discrepancy and values that actuators
    have: an effect that bends to a part of what remains gains no more than that part.
    """
    reached = begin
    for _ in range(MOST):
        larger = grown(weighing.data, weighing.nominal, reached, weighing.pool, progress)[:1]
        if not larger or not _likelier(larger[0], reached):
            return
        told = weighing.needed(larger[0])
        reached = told.scored
        yield told


def _likeliest(before: Supported, now: Supported, reached: Scored) -> Supported:
    """Of what unseen samples have confirmed `before` and `now` that which makes the recordings likelier.

    An effect that the likelier explanation `reached` does without stood for what is in that: it is no longer told.
    """
    stands = set(before.scored.fit.explanation.effects) <= set(reached.fit.explanation.effects)
    return min((before, now) if stands else (now,), key=lambda each: each.scored.cost)


def _nearest(known: Iterable[Fit]) -> list[Fit]:
    """Of each size the fit that leaves least, without a change in the middle."""
    best: dict[int, Fit] = {}
    for fit in known:
        size = fit.explanation.size
        if fit.explanation.changed is None and size and (size not in best or fit.chi2 < best[size].chi2):
            best[size] = fit
    return list(best.values())


def _price(reached: Scored) -> float:
    """-2 log likelihood, and what names a quantity for each."""
    return reached.cost + SIGNIFICANT * reached.fit.explanation.size


def _likelier(one: Scored, other: Scored) -> bool:
    """Whether each quantity that one has more than the other makes the recordings likelier by what names one."""
    return _price(one) <= _price(other)


def likelier(beside: Beside, fit: Fit, weighing: Weighing) -> Beside:
    """`beside`, or with a `fit` of plausible values that makes the recordings likelier by as much as names a quantity.

    Quantities that are added one by one may miss what a search has found together.
    """
    reached = weighing.settled(fit)
    if beside.reached.cost - reached.cost < SIGNIFICANT or strange(reached.fit, weighing.data, weighing.nominal):
        return beside
    now = weighing.heard(weighing.weighed(reached))
    return replace(beside, reached=reached, confirmed=_likeliest(beside.confirmed, now, reached))


def confirmed_beside(fit: Fit, weighing: Weighing, progress: Progress) -> bool:
    """Whether unseen samples confirm all effects of a `fit`, with plausible values, however little they explain.

    None of them may be what drifting parameters could stand for.
    """
    told = weighing.weighed(weighing.settled(fit))
    effects = {quantity: weight for quantity, weight in told.weights.items() if isinstance(quantity, Variant)}
    if any(not weight.confirmed or not weight.plausible or idle(one, weight) for one, weight in effects.items()):
        return False
    return effects.keys() <= told_apart(told, weighing, progress).weights.keys()


def told_apart(named: Supported, weighing: Weighing, progress: Progress) -> Supported:
    """What of `named` may be named, each effect with what could stand in its place.

    Where drifting parameters, no more than an effect has free numbers, could stand for it they are told: of equals that
    with fewer effects is taken.
    """
    weights, drifts = dict(named.weights), set(drifting(weighing.nominal))
    for quantity, weight in weights.items():
        if isinstance(quantity, Variant):
            rivals = _rivals(named, quantity, weighing, progress)
            for names, rival in rivals.items():
                if drifts.issuperset(names) and len(names) <= len(quantity.free):
                    return told_apart(weighing.heard(weighing.weighed(rival)), weighing, progress)
            weights[quantity] = replace(weight, instead=tuple(rivals))
    return replace(named, weights=weights)


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


def _rivals(named: Supported, effect: Variant, weighing: Weighing, progress: Progress) -> dict[tuple[str, ...], Scored]:
    """What could stand in the place of an effect, by name: what is less likely by less than would name it.

    One other quantity, or two drifting parameters; the likeliest first.
    """
    rest = weighing.lacking(named.scored, effect)
    own = set(quantities(rest.fit.explanation))
    rivals: dict[tuple[str, ...], Scored] = {}
    for look in (grown, drifted):
        for each in look(weighing.data, weighing.nominal, rest, weighing.pool, progress):
            added = [one for one in quantities(each.fit.explanation) if one not in own]
            names = tuple(one if isinstance(one, str) else one.effect for one in added)
            if each.cost - named.scored.cost < SIGNIFICANT and names != (effect.effect,):
                rivals.setdefault(names, each)
    return dict(sorted(rivals.items(), key=lambda rival: rival[1].cost))
