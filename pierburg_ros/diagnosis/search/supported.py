"""What recordings support although a remainder is left: quantities added one by one, scored beside the remainder."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from concurrent.futures import Executor
from dataclasses import dataclass, replace

from pierburg_ros.deadline import OutOfTime
from pierburg_ros.diagnosis.search.belief import PROBABLE
from pierburg_ros.diagnosis.search.candidates import drifting
from pierburg_ros.diagnosis.search.growing import drifted, grown
from pierburg_ros.diagnosis.search.reversals import Play, play_at_reversals
from pierburg_ros.diagnosis.search.scored import Scored, plausible, scored, strange, unseen
from pierburg_ros.diagnosis.search.tried import Progress
from pierburg_ros.diagnosis.search.weighing import Supported, Weighing, Weight, idle
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.estimation.likelihood import SIGNIFICANT
from pierburg_ros.inference.explanation import Explanation, Quantity, Variant, id_of, quantities
from pierburg_ros.plant import Model

MOST = 4
"""Largest number of quantities that are added. Work: each is a round of a second or more; not varied."""
OPEN = 1.0 / 3.0
"""Ratio of the misfit left to that of the nominal model, in -2 log likelihood, up to which the search for an adequate
explanation goes on. Measured: of n = 5 recordings, three that contain something outside the catalogue left 0.22, 0.65
and 0.92, and two that were explained after all 0.18 and 0.19. A search that goes on in vain costs time and no name."""

PLAY = 30.0
"""Gain in -2 log likelihood from which reversals show a play of the sensor. Measured: beside the nominal and beside the
re-estimated model. Of n = 108 blind trials without a play, four show 15 to 22 beside both. Five show more: delays, an
inductance and gears, which better fits remove. Of 13 real recordings none shows 6. A play of 2.3 degrees put into them
shows 39 to 367 in five, and 6 or less where the shaft reverses too seldom."""
CONFIRMED = 0.5
"""Share of an effect's gain on the training samples, scaled to the number of validation samples, that these must show
as well, where an effect is found beside a disturbance. Derived: halfway between a quantity that fits the training
samples alone (none of the gain) and one that is there (all of it)."""


@dataclass(frozen=True)
class Beside:
    """What recordings support beside a remainder.

    `reached` is the most likely explanation. `begun` is what the nominal model leaves, in -2 log likelihood.
    `confirmed` is the explanation that unseen samples confirm. If the work was `stopped`, they hold what was known by
    then.
    """

    reached: Scored
    begun: float
    confirmed: Supported
    stopped: bool = False

    @property
    def open(self) -> bool:
        """Whether so little is left that an explanation of this size may be adequate."""
        return self.begun > 0.0 and self.reached.left < OPEN * self.begun


def supported(data: Data, nominal: Model, known: Iterable[Fit], pool: Executor, progress: Progress) -> Beside:
    """The most likely explanation, and the part of it that unseen samples confirm; `known` are fits of a search.

    A quantity that adapts to a remainder gains on the training samples, but not on the validation samples. Quantities
    without a gain there are removed again, the weakest first. A later quantity may adapt and take gain from earlier
    ones, so this test is made after each addition. The most likely of the confirmed explanations is reported, unless it
    has an effect that a more likely explanation does without.
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
    """Ever more likely explanations: from `begin` with quantities added one by one, then from the `known` fits.

    With a discrepancy as large as the whole error, a descent detects little of an effect. So the known fits with the
    lowest squared error are tried as well. One of them is taken further if it is more likely than every explanation so
    far, on the validation samples too. That happens where many numbers of a description are wrong. The search does not
    begin there: the best fit of a size may be the one that adapts most. Few quantities lead from it to the true
    explanation.
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
    """Explanations with one quantity more each, until one more does not help.

    Each is the one that makes the recordings most likely, with its own most likely discrepancy and plausible values. An
    effect that adapts to a part of the remainder gains no more than that part.
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
    """The more likely one of the confirmed explanations `before` and `now`.

    `before` is dropped if it has an effect that the more likely explanation `reached` does without: this effect only
    replaced something in `reached`.
    """
    stands = set(before.scored.fit.explanation.effects) <= set(reached.fit.explanation.effects)
    return min((before, now) if stands else (now,), key=lambda each: each.scored.cost)


def _nearest(known: Iterable[Fit]) -> list[Fit]:
    """The fit with the lowest chi2 of each size above 0, without a change in mid-recording."""
    best: dict[int, Fit] = {}
    for fit in known:
        size = fit.explanation.size
        if fit.explanation.changed is None and size and (size not in best or fit.chi2 < best[size].chi2):
            best[size] = fit
    return list(best.values())


def _price(reached: Scored) -> float:
    """-2 log likelihood, plus `SIGNIFICANT` for each quantity."""
    return reached.cost + SIGNIFICANT * reached.fit.explanation.size


def _likelier(one: Scored, other: Scored) -> bool:
    """Whether one explanation is as likely as the other or more, when each quantity costs `SIGNIFICANT`."""
    return _price(one) <= _price(other)


def likelier(beside: Beside, fit: Fit, weighing: Weighing) -> Beside:
    """`beside`, or with a `fit` of plausible values if that is more likely by at least `SIGNIFICANT`.

    Adding quantities one by one may miss a combination that a search has found.
    """
    reached = weighing.settled(fit)
    if beside.reached.cost - reached.cost < SIGNIFICANT or strange(reached.fit, weighing.data, weighing.nominal):
        return beside
    now = weighing.heard(weighing.weighed(weighing.lightened(reached)))
    return replace(beside, reached=reached, confirmed=_likeliest(beside.confirmed, now, reached))


def confirmed_beside(fit: Fit, weighing: Weighing, progress: Progress) -> bool:
    """Whether unseen samples confirm all effects of a `fit`, with plausible values, however little they explain.

    They must show half of the gain on the training samples, scaled to their number. Drifting parameters must not be
    able to replace any of these effects.
    """
    told = weighing.weighed(weighing.settled(fit))
    least = CONFIRMED * float(weighing.data.validation.sum() / weighing.data.train.sum())
    for quantity, weight in told.weights.items():
        if not isinstance(quantity, Variant):
            continue
        shown = weight.unseen is not None and weight.unseen >= least * weight.gain
        if not shown or not weight.plausible or idle(quantity, weight):
            return False
        if _by_drift(quantity, _replacements(told, quantity, weighing, progress), told, weighing):
            return False
    return True


def told_apart(named: Supported, weighing: Weighing, progress: Progress) -> Supported:
    """The part of `named` that may be named: effects that are probable beside what could replace them.

    The effect that explains least is judged first, for the others may depend on it. If drifting parameters can replace
    an effect, and are no more than its free numbers, they are reported. Of two ties, the one with fewer effects is
    taken.
    """
    doubted = dict[str, Weight]()
    while True:
        rest, weights, improbable = _judged(named, weighing, progress)
        doubted |= improbable
        if rest is None:
            return replace(named, weights=weights, doubted=doubted)
        named = weighing.heard(rest)


def _judged(
    named: Supported, weighing: Weighing, progress: Progress
) -> tuple[Supported | None, dict[Quantity, Weight], dict[str, Weight]]:
    """What to judge next in the place of `named`, with the weights of its effects and the one that is improbable.

    Nothing is judged next if all effects stand.
    """
    weights = dict(named.weights)
    effects = [quantity for quantity in weights if isinstance(quantity, Variant)]
    for quantity in sorted(effects, key=lambda one: weights[one].explained):
        rivals = _replacements(named, quantity, weighing, progress)
        if drift := _by_drift(quantity, rivals, named, weighing):
            return weighing.weighed(drift), weights, {}
        weights[quantity] = judged = _beside(rivals, named, weights[quantity])
        if judged.confidence < PROBABLE and weighing.removable(named, quantity):
            return weighing.given_up(named, quantity), weights, {quantity.effect: judged}
    return None, weights, {}


def _beside(rivals: Mapping[tuple[str, ...], Scored], named: Supported, weight: Weight) -> Weight:
    """The weight of an effect of `named` beside what could replace it."""
    lags = {names: rival.cost - named.scored.cost for names, rival in rivals.items()}
    nearest = min(lags.values(), default=weight.gain)
    tied = tuple(names for names, lag in lags.items() if lag < SIGNIFICANT)
    return replace(weight, instead=tied, apart=min(max(nearest / weight.gain, -1.0), 1.0))


def _by_drift(
    effect: Variant, rivals: Mapping[tuple[str, ...], Scored], named: Supported, weighing: Weighing
) -> Scored | None:
    """The most likely replacement that ties with an effect and consists of no more drifts than that has free numbers.

    None if there is none.
    """
    drifts = set(drifting(weighing.nominal))
    for names, rival in rivals.items():
        tied = rival.cost - named.scored.cost < SIGNIFICANT
        if tied and drifts.issuperset(names) and len(names) <= len(effect.free):
            return rival
    return None


def with_play(named: Supported, reached: Fit, data: Data, nominal: Model) -> Supported:
    """`named` with the play of the sensor added, if reversals show it both beside `named` and beside `reached`.

    A simulation that is wrong by more than the play reverses elsewhere, and a play does not improve it. A spring that
    yields, or a delay, lags behind at reversals too. The quantity that replaces it may not be named, but it removes the
    apparent play. A play that is not probable is doubted.
    """
    own = named.scored.fit
    play = play_at_reversals(data, own)
    if play is None or play.gain < PLAY or not _shows(play, reached, data):
        return named
    weight = Weight(play.gain, play.left)
    if weight.confidence < PROBABLE:
        return replace(named, doubted={**named.doubted, play.variant.effect: weight})
    fit = Estimator(data, nominal).at(own.explanation.plus(play.variant), own.values)
    weights = {**named.weights, play.variant: weight}
    return Supported(nominal, scored(data, fit), weights, named.doubted)


def _shows(play: Play, fit: Fit, data: Data) -> bool:
    """Whether a fit has such a play, or its residual shows one."""
    again = play_at_reversals(data, fit)
    return play.variant.effect in fit.explanation.effects or (again is not None and again.gain >= PLAY)


def _replacements(
    named: Supported, effect: Variant, weighing: Weighing, progress: Progress
) -> dict[tuple[str, ...], Scored]:
    """What could replace an effect, by name: one other quantity, or two drifting parameters; the most likely first."""
    rest = weighing.lacking(named.scored, effect)
    own = set(quantities(rest.fit.explanation))
    rivals: dict[tuple[str, ...], Scored] = {}
    for look in (grown, drifted):
        for each in look(weighing.data, weighing.nominal, rest, weighing.pool, progress):
            added = [one for one in quantities(each.fit.explanation) if one not in own]
            names = tuple(map(id_of, added))
            if names != (effect.effect,):
                rivals.setdefault(names, each)
    return dict(sorted(rivals.items(), key=lambda rival: rival[1].cost))
