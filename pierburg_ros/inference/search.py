"""Which explanations are fitted: up to three effects, grown from the likeliest, each with all drifts free."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import Executor
from contextlib import suppress
from dataclasses import dataclass, replace
from operator import attrgetter

import numpy as np

from pierburg_ros.effects import DECLARED, EFFECT
from pierburg_ros.errors import InputError
from pierburg_ros.inference.balance import Balance
from pierburg_ros.inference.changes import Change, changes
from pierburg_ros.inference.coordinates import in_order
from pierburg_ros.inference.explanation import WHEN, Explanation, Variant, jumps, moments_of, without
from pierburg_ros.inference.fit import Fit, Fitter, adequate, excess, ladder, strongest
from pierburg_ros.inference.intervals import at_no_time_and_always, moment_ends
from pierburg_ros.inference.least_squares import BRIEF
from pierburg_ros.inference.shortlist import Promise, added, balanced, distinct, promises
from pierburg_ros.plant import Model

Progress = Callable[[str], None]

TRIED = 4
"""Effects whose promises are fitted on top of an explanation with effects. Work: each costs two short fits; not
varied."""
PROMISING = 0.2
"""Part of the share that the best promises to take, below which a promise is not fitted. Measured: the effect
that explains most promised 0.48 of the best at least (n = 15 recordings).
"""
STARTS = 2
"""Promises of one effect that are fitted. Work: each costs a short fit; not varied."""
MOVES = 2
"""Times that the moments of a change, or of a load, are read off a fit, and the fit made again. Work: the second moves
them by samples."""
BETWEEN = 20
"""Most moments that are tried within the interval of one. Work: in steps of the actuator's time they were half of all
simulations where a load in time explains little."""
BEAM = 3
"""Explanations of each size that are grown and fitted on. Work: as for `TRIED`."""
GROWN = 4.0
"""Mean square, in that of the best explanation of a size, up to which another one is fitted on and grown. Chosen: what
leaves twice the error of the best hardly holds the effect that explains most; not varied."""
DEEPEST = 3
"""Most effects in an explanation. Given: supports of up to three effects."""


@dataclass(frozen=True)
class Search:
    """What a search works with; `drifts` are the base parameters that are free in every fit."""

    balance: Balance
    drifts: tuple[str, ...]
    candidates: Sequence[tuple[Variant, list[dict[str, float]]]]
    pool: Executor
    tell: Progress


def searched(fitter: Fitter, search: Search) -> list[Fit]:
    """The explanations that lead, fitted with the weakest pull of the ladder, best first.

    From the best of each size the next size is grown, until one leaves only noise or one more effect gains little.
    Where no effect that promises something explains alone, each is also tried from the description on. What is no
    longer needed beside what came later is dropped again.
    """
    pool = search.pool
    search.tell("re-estimated parameters")
    base = fitter.fit(Explanation(search.drifts), described_or_balanced(fitter, search))
    leading, ended = [base], followed([base], pool)
    with fitter.effort.interruptible():
        for size in range(1, DEEPEST + 1):
            if any(map(adequate, ended)) or fitter.effort.over:
                break
            several = to_the_end([each for fit in leading for each in promising(fit, search)], search)
            ended = best_of_support([*ended, *followed(several, pool)])
            if size == 1 and not any(map(adequate, ended)):
                described = to_the_end(from_description(base, search), search)
                several, ended = [*several, *described], best_of_support([*ended, *followed(described, pool)])
            if not several:
                break
            ended = best_of_support([*ended, *followed(without_one(ended[0], pool), pool)])
            before, leading = leading[0], nearest(several)[:BEAM]
            # of as many effects as may still act the one that takes most takes its part at least
            if excess(leading[0]) > (1.0 - 1.0 / (DEEPEST + 1 - size)) * excess(before):
                break
    return ended


def promising(fit: Fit, search: Search) -> list[Fit]:
    """Short fits with an effect added that promises most, and with a parameter that changes where there is none yet."""
    search.tell(f"what could be added to {label(fit)}")
    promised = promises(fit, search.balance, search.candidates, search.pool)
    if bare(fit):
        return [*fits_of(fit, best_of_each(promised, len(EFFECT)), search), *changed(fit, search)]
    return fits_of(fit, best_of_each(promised, TRIED), search)


def to_the_end(several: Sequence[Fit], search: Search) -> list[Fit]:
    """The best of some short fits, one of each support, fitted until they gain no more, best first."""
    best = best_of_support(several)[:BEAM]
    if best:
        search.tell(f"{', '.join(map(label, best))}, to the end")
    return nearest(list(search.pool.map(lambda fit: fit.fitter.fit(fit.explanation, fit.values), best)))


def nearest(fits: Sequence[Fit]) -> list[Fit]:
    """The best fit of each support that leaves at most `GROWN` times the mean square of the best, best first."""
    ordered = best_of_support(fits)
    return [fit for fit in ordered if fit.chi2 <= GROWN * ordered[0].chi2]


def without_one(fit: Fit, pool: Executor) -> list[Fit]:
    """A fit of several effects without each of them in turn: what it was grown from may have been a local minimum."""
    if len(fit.explanation.variants) < 2:
        return []
    first = strongest(fit.fitter)

    def one(variant: Variant) -> Fit:
        absent = {f"{variant.effect}.{name}": 0.0 for name in EFFECT[variant.effect].names}
        return first.fit(without(fit.explanation, variant), {**fit.values, **absent})

    return list(pool.map(one, fit.explanation.variants))


def from_description(fit: Fit, search: Search) -> list[Fit]:
    """A short fit with each form of each effect added to a fit whose drifts begin as described.

    Drifts may stand for an effect: next to them it promises nothing, and a descent would have to give them up first.
    None where the effort is spent.
    """
    fitter = fit.fitter
    if fitter.effort.over:
        return []
    search.tell(f"what may stand for the drifts beside {label(fit)}")
    described = {**fit.values, **undrifted(fit)}

    def one(candidate: tuple[Variant, list[dict[str, float]]]) -> Fit | None:
        variant, starts = candidate
        with suppress(InputError):
            values = in_order(added(described, variant, starts[0]), fitter.nominal)
            return fitter.fit(fit.explanation.plus(variant), values, BRIEF)
        return None

    others = [
        (variant, starts)
        for variant, starts in search.candidates
        if variant.effect not in fit.explanation.effects and EFFECT[variant.effect].ripple is None
    ]
    return list(filter(None, search.pool.map(one, others)))


def undrifted(fit: Fit) -> dict[str, float]:
    """The drifted parameters of a fit as they are described."""
    return {name: fit.fitter.nominal.values[name] for name in fit.explanation.drifted}


def begun_again(fit: Fit, search: Search) -> Fit:
    """The best of a fit, of one down the ladder again, and of fits with other numbers that its effects declare.

    Their strength is kept. Where events jump a descent ends at the first of many minima. Measured: n = 10 explanations
    of three recordings of valves that stick; 5 descents end within 60 of chi2 of the best, all of these do.
    """
    if not jumps(fit.explanation):
        return fit
    constants = [constant for constant in ladder(fit.fitter.data) if constant <= fit.fitter.constant]
    best = min((fit, led(fit, constants)), key=lambda each: each.chi2)
    begun: list[dict[str, float]] = []
    for variant, starts in search.candidates:
        effect = EFFECT[variant.effect]
        if variant not in fit.explanation.variants or effect.mark is None:
            continue
        beside = [f"{effect.id}.{name}" for name in variant.free if name not in effect.strength]
        formed = (added(best.values, variant, start) for start in starts if beside)
        begun += [{**best.values, **{name: values[name] for name in beside}} for values in formed]
    several = (fit.fitter.fit(fit.explanation, values) for values in distinct(begun))
    return min((best, *several), key=lambda each: each.chi2)


def described_or_balanced(fitter: Fitter, search: Search) -> dict[str, float]:
    """Where fits begin: the description, or the values of the balance where these leave less."""
    values, _ = balanced(search.balance, fitter.nominal, search.drifts, {})
    both = [fitter.fit(Explanation(search.drifts), start, 0) for start in (fitter.nominal.values, values)]
    return min(both, key=lambda fit: fit.chi2).values


def fits_of(fit: Fit, promised: Sequence[Promise], search: Search) -> list[Fit]:
    """Short fits from each of the promises on top of a fit.

    Drifts begin as in the fit, by the balance, and as described, where a model can. Where events jump each of these may
    end elsewhere; otherwise the nearest does.
    """
    fitter, described = fit.fitter, undrifted(fit)

    def one(promise: Promise) -> Fit:
        explanation, begun = fit.explanation.plus(promise.variant), []
        for start in (promise.values, promise.balanced, in_order({**promise.values, **described}, fitter.nominal)):
            with suppress(InputError):
                begun.append(fitter.fit(explanation, start, 0))
        begun.sort(key=lambda each: each.chi2)
        several = begun if jumps(explanation) else begun[:1]
        best = min((fitter.fit(explanation, each.values, BRIEF) for each in several), key=lambda each: each.chi2)
        return timed(best, promise.variant)

    return list(search.pool.map(one, promised))


def timed(fit: Fit, variant: Variant) -> Fit:
    """A short fit with the moments of a dated effect moved to where it gains most, in a single recording.

    One that is best at an end of the recording is held there.
    """
    fitter, moments = fit.fitter, moments_of(variant.effect)
    if not {*moments} & {*variant.free} or len(fitter.data.runs) > 1:
        return fit
    for _ in range(MOVES):
        span, own = fitter.span(*at_no_time_and_always(fit, variant.effect)), variant
        for name, moment in zip(moments, span, strict=True):
            own = own if moment else own.holding(name, 0.0)
        values = {f"{variant.effect}.{name}": moment for name, moment in zip(moments, span, strict=True)}
        moved = fitter.fit(fit.explanation.formed(own), {**fit.values, **values}, BRIEF)
        if moved.chi2 >= fit.chi2:
            break
        fit = moved
    return fit


def other_way_round(fits: Sequence[Fit], pool: Executor) -> list[Fit]:
    """Fits whose effect acts up to a moment, or from one on, with it on the rest of the recording, the other way.

    Beside all drifts both are equal, for a constant part is free; beside fewer they are not.
    """

    def turned(pair: tuple[Fit, Variant]) -> Fit:
        (fit, variant), effect = pair, EFFECT[pair[1].effect]
        own, values = variant, dict(fit.values)
        for name, other in itertools.permutations(moments_of(effect.id)):
            values[f"{effect.id}.{name}"] = moment = fit.values[f"{effect.id}.{other}"]
            own = own.freeing(name) if moment else own.holding(name, 0.0)
        for name in effect.strength:
            values[f"{effect.id}.{name}"] *= -1.0
        return fit.fitter.fit(fit.explanation.formed(own), values)

    pairs = [(fit, variant) for fit in fits for variant in fit.explanation.variants]
    return list(pool.map(turned, (pair for pair in pairs if len(moments_in(*pair)) == 1)))


def moments_in(fit: Fit, variant: Variant) -> list[str]:
    """Those moments of an effect that a fit moves, and that are not at an end of the recording."""
    return [
        name for name in moments_of(variant.effect) if name in variant.free and fit.values[f"{variant.effect}.{name}"]
    ]


def changed(fit: Fit, search: Search) -> list[Fit]:
    """Short fits in which a parameter changes in mid-recording, beside the drifts of a fit: those of the best.

    A moment is held while values are fitted, and then moved to where it gains most: a cost has no slope over it.
    """
    fitter = fit.fitter

    def one(change: Change) -> Fit:
        own, values = change.explanation, change.values
        when = values[f"{own.changed}{WHEN}"]
        for _ in range(MOVES):
            found = fitter.fit(replace(own, when=when), values, BRIEF)
            assert found.after is not None
            values, when = found.values, fitter.moment(found.model, found.after)
        return fitter.fit(own, {**values, f"{own.changed}{WHEN}": when}, 0)

    every = search.pool.map(one, changes(fit, search.balance, free_parameters(fitter.nominal)))
    return sorted(every, key=lambda each: each.chi2)[:STARTS]


def followed(fits: Iterable[Fit], pool: Executor) -> list[Fit]:
    """The same explanations fitted on, pulled ever more weakly, best first."""
    several = pool.map(lambda fit: led(fit, ladder(fit.fitter.data)[1:]), fits)
    return sorted(several, key=lambda fit: fit.chi2)


def led(fit: Fit, constants: Iterable[float]) -> Fit:
    """The same explanation fitted with each of the `constants` [s] of the pull, one after the other."""
    for constant in constants:
        fit = fit.fitter.pulled(constant).fit(fit.explanation, fit.values)
    return dated_again(fit)


def dated_again(fit: Fit) -> Fit:
    """A fit that leaves an error from the best of the moments that its samples hardly tell apart, if it has any.

    While samples are held out, or a shaft rests, a cost is flat over a moment, but where a pull remembers what it
    started. Moments are tried as far apart as the actuator's own time, or `BETWEEN` of them.
    """
    fitter = fit.fitter
    for name in () if adequate(fit) else fit.explanation.names:
        first, last = moment_ends(fit, name) or (0.0, 0.0)
        step = max(fitter.data.scales.time, (last - first) / BETWEEN)
        moments = np.arange(first, last, step).tolist()
        several = [fitter.fit(fit.explanation, {**fit.values, name: moment}, 0) for moment in moments]
        best = min((fit, *several), key=lambda each: each.chi2)
        fit = fit if best is fit else fitter.fit(fit.explanation, best.values)
    return fit


def best_of_each(promised: Sequence[Promise], effects: int) -> list[Promise]:
    """The best promises of each of so many `effects`, in turn the best by simulation, by the balance and at rests.

    What promises little by each is left out.
    """
    shares = ("simulated", "along", "at_rests")
    orders = (ordered(promised, attrgetter(share)) for share in shares)
    groups: dict[str, list[Promise]] = {}
    for promise in filter(None, itertools.chain.from_iterable(itertools.zip_longest(*orders))):
        group = groups.setdefault(promise.variant.effect, [])
        if len(group) < STARTS and not any(promise.equals(other) for other in group):
            group.append(promise)
    return [promise for group in list(groups.values())[:effects] for promise in group]


def ordered(promised: Sequence[Promise], share: Callable[[Promise], float]) -> list[Promise]:
    """The promises by a `share`, the largest first, but for those that promise little by it."""
    most = max(map(share, promised), default=0.0)
    return sorted((each for each in promised if share(each) > PROMISING * most), key=share, reverse=True)


def best_of_support(fits: Iterable[Fit]) -> list[Fit]:
    """The best fit of each set of effects, best first."""
    best: dict[frozenset[str], Fit] = {}
    for fit in sorted(fits, key=lambda fit: fit.chi2):
        best.setdefault(key(fit), fit)
    return list(best.values())


def key(fit: Fit) -> frozenset[str]:
    """The effects of a fit, and the parameter that changes in it."""
    own = fit.explanation
    return frozenset((*own.effects, own.changed) if own.changed else own.effects)


def bare(fit: Fit) -> bool:
    """Whether an explanation has neither effects nor a change in mid-recording."""
    return not key(fit)


def label(fit: Fit) -> str:
    """The effects of a fit in words."""
    own = fit.explanation
    change = (f"a change of {own.changed}",) if own.changed else ()
    return " and ".join((*change, *own.effects)).replace("_", " ") or "the re-estimated model"


def free_parameters(nominal: Model) -> tuple[str, ...]:
    """Base parameters that a fit may change, and the numbers of effects that the actuator always has."""
    always = (f"{effect}.{name}" for effect in nominal.actuator.effects for name in EFFECT[effect].names)
    numbers = (name for name in always if name in DECLARED and not DECLARED[name].choices)
    return (*nominal.actuator.free, *(name for name in numbers if nominal.values[name] != 0.0))
