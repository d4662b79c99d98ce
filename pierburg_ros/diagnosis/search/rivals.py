"""Explanations with something else in place of a quantity of the best one, fitted so that ties can be reported."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial

from pierburg_ros.diagnosis.search.attempts import Attempts, far_below
from pierburg_ros.diagnosis.search.candidates import may_change, with_drifts
from pierburg_ros.diagnosis.search.race import NEAR, ROUNDS
from pierburg_ros.diagnosis.search.selection import alike, gains_enough
from pierburg_ros.effects import EFFECT
from pierburg_ros.errors import InputError
from pierburg_ros.estimation.estimator import Fit, adequate
from pierburg_ros.inference.explanation import (
    AFTER,
    WHEN,
    Explanation,
    Quantity,
    Variant,
    jumps,
    moments,
    quantities,
    without,
)
from pierburg_ros.plant import Model

FADING = (0.75, 0.5, 0.25, 0.0)
"""Shares of an effect's strength at which its possible replacement is fitted in turn. Work: one brief fit each; in one
step the other quantities would have to take over the whole effect, and events would jump. Not varied."""


def fit_rivals(attempts: Attempts, best: Fit) -> None:
    """Fit replacements for each quantity of `best`: any other quantity, and for an effect any one or two parameters.

    A load that never ends is the same as a parameter that changed when it began. An earlier fit that explains most of
    what `best` does may only have stopped too early, so it is refined like a fresh one.
    If the cost has many local minima and `best` is not adequate, other drifts start from the values of `best` as well.
    """
    for quantity in quantities(best.explanation):
        rest = without(best.explanation, quantity)
        base = attempts.fits.get(rest) or attempts.add(rest)
        fresh = {fit.explanation for fit in attempts.expand(base)}
        grown = _grown_from(rest, attempts)
        attempts.refine(fit for fit in grown if fit.explanation in fresh or far_below(fit, base))
        counts = (1, 2) if isinstance(quantity, Variant) else (1,)
        rivals = [each for count in counts for each in with_drifts(rest, attempts.drifts, count)]
        rivals += _by_a_change(rest, quantity, attempts)
        list(attempts.pool.map(partial(_tried, attempts, rest, quantity, best), dict.fromkeys(rivals)))
        fits = (attempts.fits[rival] for rival in rivals if rival in attempts.fits)
        # a rival that lacks less than one more quantity has to gain may only be in a wrong local minimum
        near = (fit for fit in fits if not adequate(best) or not gains_enough(fit, best, 1))
        attempts.refine(near)


def _grown_from(rest: Explanation, attempts: Attempts) -> list[Fit]:
    """The fits of explanations with one quantity more than `rest`."""
    larger = attempts.of_size(rest.size + 1)
    return [fit for fit in larger if rest in (without(fit.explanation, each) for each in quantities(fit.explanation))]


def _tried(attempts: Attempts, rest: Explanation, quantity: Quantity, best: Fit, rival: Explanation) -> None:
    """Fit a `rival` for a `quantity` of `best`; the `rest` is `best` without that quantity."""
    known = attempts.fits.get(rival)
    if isinstance(quantity, Variant) and (known is None or known.misfit > alike(best)):
        _take_over(attempts, rival, quantity, best)
    elif jumps(rest) and not adequate(best):
        # grown on the rest, the effects of the rival have first adapted to replace the drift
        attempts.add(rival, best.values)


def _by_a_change(rest: Explanation, quantity: Quantity, attempts: Attempts) -> list[Explanation]:
    """`rest` with a parameter that may have changed when an effect begins; empty if there is no such parameter."""
    if not isinstance(quantity, Variant) or not may_change(rest, attempts.data):
        return []
    constant = _constant_part(quantity, attempts.nominal)
    if constant is None or _beginning(quantity) is None or constant[1] in rest.drifted:
        return []
    return [replace(rest, changed=constant[1])]


def _constant_part(variant: Variant, model: Model) -> tuple[str, str] | None:
    """Dotted name of a parameter that acts like a change of a base parameter, and that one; None if there is none."""
    constant = EFFECT[variant.effect].constant_part
    if constant is None or constant[1] not in model.values:
        return None
    return f"{variant.effect}.{constant[0]}", constant[1]


def _beginning(variant: Variant) -> str | None:
    """Dotted name of the time from which an effect acts; None if that is not searched."""
    return next(iter(moments(variant)), None)


def _take_over(attempts: Attempts, explanation: Explanation, fading: Variant, best: Fit) -> None:
    """Fit an explanation that replaces an effect of `best`, if it fits almost as well while the effect fades.

    In one step, the replacement would have to take over the whole effect, and events would jump. Events would also jump
    if the other effects changed meanwhile, so these are held. The quantities that take over may hardly be distinguished
    from each other, such as resistance and supply. So the first steps are those that the gradients predict: damped
    steps would not go far along such a valley.
    """
    values = best.values
    for start in _at_once(explanation, fading, best):
        attempts.add(explanation, start)
    held = tuple(_faded(variant, best, 1.0) for variant in explanation.variants)
    for share in FADING:
        effects = (*held, _faded(fading, best, share)) if share > 0.0 else held
        stage = Explanation(explanation.drifted, effects, explanation.changed)
        try:
            slopes = attempts.whole.first_part.at(stage, values).solution.jacobian
            stage_fit = attempts.whole.first_part.fit(stage, values, ROUNDS, slopes=slopes)
        except InputError:
            continue
        if stage_fit.ratio > NEAR * best.ratio:
            return
        values = stage_fit.values
    attempts.add(explanation, attempts.add(explanation, values).values)


def _at_once(explanation: Explanation, fading: Variant, best: Fit) -> Iterator[dict[str, float]]:
    """Values at which a base parameter replaces the effect, all the time or from its beginning, if it has one."""
    constant = _constant_part(fading, best.model)
    if constant is None:
        return
    own, base = constant
    moved = best.values[base] + best.values[own]
    if base in explanation.drifted:
        yield {**best.values, base: moved}
    if base == explanation.changed and (begins := _beginning(fading)):
        yield {**best.values, base + AFTER: moved, base + WHEN: best.values[begins]}


def _faded(variant: Variant, fit: Fit, share: float) -> Variant:
    """The effect with its values from `fit`, fixed at a `share` of its strength."""
    declared = EFFECT[variant.effect]
    values = {name: fit.model.values[f"{variant.effect}.{name}"] for name in declared.names}
    scaled = {name: value * (share if name in declared.strength else 1.0) for name, value in values.items()}
    return Variant(variant.effect, (), tuple(scaled.items()))
