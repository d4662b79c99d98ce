"""Which explanation is chosen, what equals it, how sure each name is, and which model predicts best.

One criterion: minus twice the log likelihood of the fitted samples, in effective samples, and `SIGNIFICANT` for each
quantity that an explanation changes, a drifted parameter or an effect. So the fewest quantities that account for the
recording win, and one effect before the two drifts that equal it. Which parameters have to drift beside some effects is
read off one fit with all of them free: the cost is a parabola around it, and all subsets are compared in its numbers.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.effects import EFFECT
from pierburg_ros.inference.evidence import EXPLAINED, SIGNIFICANT, TIED, certainty, probability
from pierburg_ros.inference.explanation import Explanation, id_of, jumps, without
from pierburg_ros.inference.explanation import quantities as quantities_of
from pierburg_ros.inference.fit import Fit, adequate, rms_of, strongest
from pierburg_ros.inference.polish import polished
from pierburg_ros.inference.search import DEEPEST, Search, bare, begun_again, from_description, key, other_way_round
from pierburg_ros.inference.shortlist import DEPENDENT

REFITTED = 3
"""Choices of drifts of one number that are fitted beside the same effects. Work: a parabola has ranked them."""
INSTEAD = 2
"""Most quantities that together are an alternative to one. Chosen: what takes more to equal it is told from it."""
NAMED = 0.5
"""Least confidence at which an effect is named where something remains: it then takes more of the error than it leaves.
Measured: beside physics that no effect describes wrong effects had 0.34 at most, and right ones that showed 0.94 to 1
(n = 16 recordings, 5 effects each)."""
NAMED_BY_TIME = 0.75
"""The same of what acts at times of its own, which may follow any physics in time. Measured: a load over time had 0.64
at most where there was none (n = 16)."""
NAMED_EITHER = 0.75
"""Least confidence that one of two effects acts at which the likelier of them is named, the other as its tie. As for
`NAMED_BY_TIME`: two follow more than one does. Measured: 0.2 at most where there was none (n = 3), 0.96 where one of
two frictions that fit alike was hidden."""


@dataclass(frozen=True)
class Name:
    """How sure an effect is, between 0 and 1, by the best explanation `fit` with it and the best `rival` without it.

    It is the probability that the fit is better, times the share of the rival's error above the noise that it takes:
    where something remains that no effect describes, any effect takes a part of it. `along` is that share of the error
    of the balance, where the balance alone names the effect. `instead` is the effect that may act in its place, where
    only one of both is sure.
    """

    confidence: float
    fit: Fit
    rival: Fit
    along: float | None = None
    instead: str | None = None


@dataclass(frozen=True)
class Choice:
    """The chosen explanation, and the model that is handed out.

    `explained`: it leaves only noise. `chosen` is judged with the pull of its fitter, `handed` is the same explanation
    with the weakest pull. `ties` are alternatives to each of its quantities, by effect id or parameter name. `names`
    holds its effects by id, and `doubted` those of other explanations that gain something. All other fits have the
    weakest pull: `predictor` is the one of them that predicts held-out samples best, `described` and `estimated` (all
    parameters again, no effect) included.
    """

    explained: bool
    chosen: Fit
    handed: Fit
    predictor: Fit
    described: Fit
    estimated: Fit
    fits: tuple[Fit, ...]
    names: Mapping[str, Name]
    doubted: Mapping[str, Name] = field(default_factory=dict)
    ties: Mapping[str, tuple[tuple[str, ...], ...]] = field(default_factory=dict)

    @property
    def alternatives(self) -> frozenset[str]:
        """All that may stand in the place of one of its quantities."""
        return frozenset(name for several in self.ties.values() for names in several for name in names)

    @property
    def verdict(self) -> Verdict:
        """What the chosen explanation amounts to."""
        if not self.explained:
            return "unexplained"
        if self.chosen.explanation.variants:
            return "missing_physics"
        return "parameter_drift" if self.chosen.size else "consistent"


Verdict = Literal["consistent", "parameter_drift", "missing_physics", "unexplained"]


def chosen(fits: Sequence[Fit], parameters: Sequence[str], search: Search) -> Choice:
    """The choice among `fits`, each with all drifts free; any of the base `parameters` may be what drifted.

    Where none of them leaves only noise they are compared with the strongest pull: what remains then costs least, and a
    slip at the wrong moment does not last. Where no effect that makes such slips leaves only noise there either, or one
    that makes none does as well, only effects count that are sure enough, beside whatever else.
    """
    weakest, last, estimated = tuple(fits), fits[0].fitter, next(fit for fit in fits if bare(fit))
    pool, explained = search.pool, any(map(adequate, fits))
    if not explained:
        fits = list(pool.map(lambda fit: strongest(fit.fitter).fit(fit.explanation, fit.values), fits))
        enough = [fit for fit in fits if adequate(fit)]
        explained = bool(enough) and all(jumps(fit.explanation) for fit in enough)
    fitter, nominal = fits[0].fitter, fits[0].fitter.nominal
    described = fitter.fit(Explanation(), nominal.values, 0)
    whole = [*fits, *other_way_round(fits, pool)]
    everything = [described, *whole]
    apart, named = estimated.explanation.drifted, dict[str, Name]()
    if not explained:
        # where an error remains only what the recordings tell apart may follow it
        parameters = apart
        named = sure(everything)
        whole = [min((fit for fit in whole if key(fit) <= named.keys()), key=lambda fit: fit.chi2)]
    everything += fewest([described, *whole], parameters, search)
    able = [fit for fit in everything if explained or key(fit) <= key(whole[0])]
    best = Score.of(able).best(able, apart)
    if explained and len(best.explanation.drifted) > 1:
        beside = [fit for fit in fits if bare(fit) or key(fit) == key(best)]
        alike = [each for fit in beside for each in from_description(fit, search)]
        alike += fewest([described, *alike], parameters, search)
        everything += alike
        able += alike
        best = Score.of(able).best(able, apart)
    best, dropped = needed(begun_again(best, search), pool)
    everything += [best, *dropped, *in_place(best, whole, parameters, search)]
    score = Score.of(everything)
    if not explained:
        # fits made since may doubt what seemed sure
        named = sure(everything) | {name: each for name, each in named.items() if each.instead}
        best = score.best([fit for fit in everything if key(fit) <= named.keys()], apart)
    own, others = names(best, everything, explained, named)
    handed = polished(last.fit(best.explanation, best.values))
    known = (last.fit(Explanation(), nominal.values, 0), *weakest)
    return Choice(
        explained=explained and adequate(best),
        chosen=best,
        handed=handed,
        predictor=predictor(handed, (handed, *known)),
        described=known[0],
        estimated=estimated,
        fits=(handed, *known),
        names=own,
        doubted=others,
        ties=ties(best, [fit for fit in everything if score.alike(fit, best)]) | either(own),
    )


@dataclass(frozen=True)
class Score:
    """Minus twice the log likelihood in effective samples, from the `least` chi2 on, and the price of a quantity.

    `rounded` is the squared error that a coarse converter makes beside, and by which correct simulators differ: what is
    far below it tells nothing.
    """

    effective: float
    least: float
    rounded: float
    price: float

    @staticmethod
    def of(fits: Sequence[Fit]) -> Score:
        """The score of some fits to the same samples.

        Where an error remains in all, names have a threshold of their own, and a quantity has to pay for itself alone
        (Schwarz, Estimating the dimension of a model, 1978).
        """
        least = min(fits, key=lambda fit: fit.chi2)
        effective = least.fitted.size / least.repetition
        rounded = least.fitted.size * (least.rounding + least.fitter.unlike**2)
        price = SIGNIFICANT if adequate(least) else math.log(max(effective, math.e))
        return Score(effective, least.chi2, rounded, price)

    def lack(self, chi2: float) -> float:
        """How much less likely the recordings are than by the best fit."""
        before, after = (max(each + self.rounded, 1e-300) for each in (chi2, self.least))
        return self.effective * math.log(before / after)

    def __call__(self, fit: Fit) -> float:
        """What is least for the explanation that is chosen."""
        return self.lack(fit.chi2) + self.price * fit.size

    def best(self, fits: Sequence[Fit], apart: Sequence[str]) -> Fit:
        """The fit that is chosen; of those as good that change no more quantities, one with the fewest effects.

        Of these one whose drifts are among those that the recordings tell `apart`: others equal one of them.
        """
        first = min(fits, key=self)
        equal = [fit for fit in fits if self.alike(fit, first) and fit.size <= first.size]
        return min(
            equal, key=lambda fit: (len(fit.explanation.effects), len({*fit.explanation.drifted} - {*apart}), self(fit))
        )

    def alike(self, fit: Fit, best: Fit) -> bool:
        """Whether a fit makes the recordings as likely as the best, but for what is a tie."""
        return self.lack(fit.chi2) <= self.lack(best.chi2) + TIED


def fewest(fits: Sequence[Fit], parameters: Sequence[str], search: Search) -> list[Fit]:
    """Fits with the effects of `fits`, of which the first has no drifts, and fewer drifts, by size.

    It ends where one more quantity cannot pay, even if it leaves as little as all drifts together.
    """
    score, found = Score.of(fits), [*fits]
    parabolas = list(search.pool.map(lambda fit: Parabola.of(fit, parameters), fits[1:]))
    for size in range(len(parameters) + DEEPEST + 1):
        best = min(map(score, found))
        able = [each for each in parabolas if score.lack(each.fit.chi2) + score.price * size < best + TIED]
        if not able:
            break
        ways = ((each, explanation) for each in able for explanation in each.best_of_size(size))
        found += fitted(ways, search)
    return found[len(fits) :]


def fitted(pairs: Iterable[tuple[Parabola, Explanation]], search: Search) -> list[Fit]:
    """A fit of each explanation from where a parabola is least; again where it leaves more than that foretells."""

    def one(pair: tuple[Parabola, Explanation]) -> Fit:
        parabola, explanation = pair
        foretold, values = parabola.lowest(explanation)
        fit = parabola.fit.fitter.fit(explanation, values)
        return fit if fit.chi2 <= foretold + TIED * fit.repetition else begun_again(fit, search)

    return list(search.pool.map(one, pairs))


def needed(best: Fit, pool: Executor) -> tuple[Fit, list[Fit]]:
    """The best fit without quantities that do not pay, and the last fits without one of those that do."""
    fitter = best.fitter
    while True:
        dropped = list(pool.map(lambda less: fitter.fit(*less), smaller_by_one(best)))
        score = Score.of([best, *dropped])
        least = min((best, *dropped), key=score)
        if least is best:
            return best, dropped
        best = least


def smaller_by_one(fit: Fit) -> list[tuple[Explanation, dict[str, float]]]:
    """The explanation of a fit without each of its quantities, with that as described in its values."""
    own, nominal = fit.explanation, fit.fitter.nominal.values
    less = []
    for quantity in quantities_of(own):
        effect = None if isinstance(quantity, str) else EFFECT[quantity.effect]
        names = [f"{effect.id}.{name}" for name in effect.names] if effect else [id_of(quantity)]
        less.append((without(own, quantity), {**fit.values, **{name: nominal[name] for name in names}}))
    return less


def in_place(best: Fit, fits: Sequence[Fit], parameters: Sequence[str], search: Search) -> list[Fit]:
    """Fits in which two drifts stand in the place of one effect of the best."""
    own, pairs = set(best.explanation.effects), []
    for fit in fits:
        if set(fit.explanation.effects) < own and len(fit.explanation.effects) == len(own) - 1:
            parabola = Parabola.of(fit, parameters)
            kept = set(best.explanation.drifted)
            pairs += [(parabola, each) for each in parabola.best_of_size(best.size + 1) if kept <= set(each.drifted)]
    return fitted(pairs, search)


@dataclass(frozen=True)
class Parabola:
    """The cost around a fit as its slopes foretell it, over the base `parameters` and the numbers of its effects."""

    fit: Fit
    parameters: tuple[str, ...]
    normal: Signal
    gradient: Signal
    point: Signal
    home: Signal

    @staticmethod
    def of(fit: Fit, parameters: Sequence[str]) -> Parabola:
        """The parabola around `fit`, which need not have all of the parameters free."""
        fitter = fit.fitter
        parameters = [name for name in parameters if name != fit.explanation.changed]
        whole = replace(fit.explanation, drifted=tuple(parameters))
        slopes, coordinates = fitter.slopes(fit, whole), fitter.coordinates(whole)
        home = coordinates.point(fitter.nominal.values)[: len(parameters)]
        gradient = slopes.T @ fit.fitted
        return Parabola(fit, tuple(parameters), slopes.T @ slopes, gradient, coordinates.point(fit.values), home)

    def best_of_size(self, size: int) -> list[Explanation]:
        """The likeliest explanations with the same effects that change so many quantities."""
        drifts = size - replace(self.fit.explanation, drifted=()).size
        if not 0 <= drifts <= len(self.parameters):
            return []
        ways = sorted(itertools.combinations(range(len(self.parameters)), drifts), key=lambda way: self.cost(way)[0])
        return [
            replace(self.fit.explanation, drifted=tuple(self.parameters[place] for place in way))
            for way in ways[:REFITTED]
        ]

    def cost(self, drifted: Sequence[int]) -> tuple[float, Signal]:
        """The least chi2 with only these parameters drifted, and the point where it is."""
        number = len(self.parameters)
        held = [place for place in range(number) if place not in drifted]
        free = [*drifted, *range(number, self.point.size)]
        move = np.zeros(self.point.size)
        move[held] = (self.home - self.point[:number])[held]
        slope = self.gradient + self.normal @ move
        cost = self.fit.chi2 + float(2.0 * self.gradient @ move + move @ self.normal @ move)
        if free:
            inner = self.normal[np.ix_(free, free)]
            scale = np.sqrt(np.maximum(np.diag(inner), 1e-300))
            step = np.linalg.pinv(inner / np.outer(scale, scale), rcond=DEPENDENT**2, hermitian=True) @ (
                slope[free] / scale
            )
            cost -= float(step @ (slope[free] / scale))
            move[free] -= step / scale
        return max(cost, 0.0), self.point + move

    def lowest(self, explanation: Explanation) -> tuple[float, dict[str, float]]:
        """Least chi2 of an explanation, and all values by dotted name there; what does not drift is as described."""
        chi2, point = self.cost([self.parameters.index(name) for name in explanation.drifted])
        fitter = self.fit.fitter
        coordinates = fitter.coordinates(replace(self.fit.explanation, drifted=self.parameters))
        found = coordinates.values(np.clip(point, *coordinates.bounds))
        held = {name: fitter.nominal.values[name] for name in self.parameters if name not in explanation.drifted}
        return chi2, {**self.fit.values, **found, **held}


def predictor(best: Fit, fits: Sequence[Fit]) -> Fit:
    """The fit that predicts the held-out samples best; the `best` itself where it leaves only noise, as others may."""
    samples = best.fitter.data.validation
    if adequate(best) or not samples.any():
        return best
    return min(fits, key=lambda fit: rms_of(fit, samples))


def names(
    best: Fit, fits: Sequence[Fit], explained: bool, named: Mapping[str, Name]
) -> tuple[dict[str, Name], dict[str, Name]]:
    """How sure each effect of the `best` fit is, and how sure others that gain something, the surest first.

    Where something remains, any fit that has an effect may tell how sure it is, and what is `named` as one of two stays
    that. What explains all leaves to others the chance that it is the worse one.
    """
    own = best.explanation.effects
    if explained:
        mine = {effect: name_of(frozenset({effect}), best, fits, explained) for effect in own}
        found = surest(
            (effect, Name(1.0 - better(fit, best), fit, best)) for fit in fits for effect in fit.explanation.effects
        )
    else:
        found = surest(judged(fits)) | {name: each for name, each in named.items() if each.instead}
        mine = {effect: found[effect] for effect in own}
    told = {*own, *(each.instead for each in mine.values())}
    doubted = (
        (name, each) for name, each in found.items() if name in EFFECT and name not in told and each.confidence > 0.0
    )
    return mine, dict(sorted(doubted, key=lambda each: -each[1].confidence))


def sure(fits: Sequence[Fit]) -> dict[str, Name]:
    """The effects, and changes, that are sure enough to be named where an error remains, each alone, or as one of two.

    Of two neither of which is sure, but that one of them acts, the likelier.
    """
    found = surest(judged(fits))
    named = {name: each for name, each in found.items() if each.confidence >= least(name)}
    doubted = sorted(name for name in found.keys() - named.keys() if name in EFFECT and not EFFECT[name].dated)
    pairs = [one_of_two(frozenset(pair), fits) for pair in itertools.combinations(doubted, 2)]
    together, name, each = max(filter(None, pairs), key=lambda pair: pair[0], default=(0.0, "", None))
    return named | {name: each} if each is not None and together >= NAMED_EITHER else named


def one_of_two(pair: frozenset[str], fits: Sequence[Fit]) -> tuple[float, str, Name] | None:
    """How sure it is that one of two effects acts, and the likelier; None where no fit has one without the other."""
    apart = [[fit for fit in fits if key(fit) & pair == {name}] for name in sorted(pair)]
    if not all(apart):
        return None
    together = max(name_of(pair, fit, fits).confidence for several in apart for fit in several)
    first, second = (min(several, key=lambda fit: fit.chi2) for several in apart)
    best, rival = (first, second) if better(second, first) >= 0.5 else (second, first)
    (name,), (other,) = key(best) & pair, key(rival) & pair
    return together, name, Name(together * better(rival, best), best, rival, instead=other)


def either(names: Mapping[str, Name]) -> dict[str, tuple[tuple[str, ...], ...]]:
    """For each effect that is sure only as one of two, the other one."""
    return {name: ((each.instead,),) for name, each in names.items() if each.instead is not None}


def judged(fits: Sequence[Fit]) -> Iterator[tuple[str, Name]]:
    """Each effect, or change, of each fit, and how sure that fit makes it."""
    return ((name, name_of(frozenset({name}), fit, fits)) for fit in fits for name in sorted(key(fit)))


def surest(judged: Iterable[tuple[str, Name]]) -> dict[str, Name]:
    """The surest of several judgements of each effect, or change; the first of equals."""
    found: dict[str, Name] = {}
    for name, each in judged:
        if name not in found or each.confidence > found[name].confidence:
            found[name] = each
    return found


def least(name: str) -> float:
    """The confidence that an effect, or the change of a parameter in mid-recording, needs where something remains."""
    return NAMED_BY_TIME if name not in EFFECT or EFFECT[name].dated else NAMED


def name_of(names: frozenset[str], best: Fit, fits: Sequence[Fit], explained: bool = False) -> Name:
    """How sure some effects, or changes, of the `best` fit are, against the best without any that changes no more.

    What explains all takes the whole error, whatever others leave.
    """
    others = [fit for fit in fits if not names & key(fit) and len(key(fit)) <= len(key(best))]
    simple = [fit for fit in others if fit.size <= best.size]
    rival = min(simple or others, key=lambda fit: fit.chi2)
    share = 1.0 if explained else taken(rival, best)
    return Name(better(rival, best) * share, best, rival)


def better(worse: Fit, fit: Fit) -> float:
    """Probability, 0 to 1, that a fit is better than another, by the spread over all blocks that were chosen by."""
    data = fit.fitter.data
    samples = data.train | data.validation
    return probability(certainty(worse.residual[samples], fit.residual[samples], data.block[samples]))


def taken(worse: Fit, fit: Fit) -> float:
    """The share of what the `worse` fit leaves above the noise that another does not leave, 0 to 1.

    Nothing of an error that is not distinguished from the noise.
    """
    if worse.ratio < EXPLAINED:
        return 0.0
    return min(max((worse.ratio**2 - fit.ratio**2) / (worse.ratio**2 - 1.0), 0.0), 1.0)


def ties(best: Fit, alike: Sequence[Fit]) -> dict[str, tuple[tuple[str, ...], ...]]:
    """For each quantity of the best fit, what may stand in its place: in those `alike` that keep the others."""
    own, found = quantities(best.explanation), {}
    for quantity in sorted(own):
        kept = own - {quantity}
        others = (quantities(fit.explanation) for fit in alike)
        instead = {other - kept for other in others if kept <= other and quantity not in other}
        instead = {each for each in instead if 0 < len(each) <= INSTEAD}
        least = [each for each in instead if not any(other < each for other in instead)]
        if least:
            found[quantity] = tuple(sorted(tuple(sorted(each)) for each in least))
    return found


def quantities(explanation: Explanation) -> frozenset[str]:
    """The ids of effects and names of parameters that an explanation changes."""
    return frozenset(map(id_of, quantities_of(explanation)))
