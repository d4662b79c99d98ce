"""What else could stand for each quantity of the best explanation: fitted, so that ties can be told."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial

from pierburg_ros.diagnosis.search.attempts import Attempts
from pierburg_ros.diagnosis.search.candidates import may_change, with_drifts
from pierburg_ros.diagnosis.search.race import NEAR, ROUNDS
from pierburg_ros.diagnosis.search.selection import adequate, alike, gains_enough
from pierburg_ros.effects import EFFECT
from pierburg_ros.errors import InputError
from pierburg_ros.estimation.estimator import Fit
from pierburg_ros.estimation.explanation import (
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
"""Shares of an effect's strength at which what may stand for it is fitted in turn. Work: one brief fit each; in one
step the others would have to take over all of it, and events would jump. Not varied."""


def fit_rivals(attempts: Attempts, best: Fit) -> None:
    """Try what could stand for each quantity of `best`: any other one, and for an effect any one or two parameters.

    A load that never ends is a parameter that changed when it began.
    Where events jump and something is left, other drifts start from the values of `best` as well.
    """
    for quantity in quantities(best.explanation):
        rest = without(best.explanation, quantity)
        attempts.refine(attempts.expand(attempts.fits.get(rest) or attempts.add(rest)))
        counts = (1, 2) if isinstance(quantity, Variant) else (1,)
        rivals = [each for count in counts for each in with_drifts(rest, attempts.drifts, count)]
        rivals += _by_a_change(rest, quantity, attempts)
        list(attempts.pool.map(partial(_tried, attempts, rest, quantity, best), dict.fromkeys(rivals)))
        fits = (attempts.fits[rival] for rival in rivals if rival in attempts.fits)
        # what lacks less than one more quantity has to gain may lack it by its local minimum alone
        near = (fit for fit in fits if not adequate(best) or not gains_enough(fit, best, 1))
        attempts.refine(near)


def _tried(attempts: Attempts, rest: Explanation, quantity: Quantity, best: Fit, rival: Explanation) -> None:
    """Try a `rival` of a `quantity` of `best`, which has the `rest` beside it."""
    known = attempts.fits.get(rival)
    if isinstance(quantity, Variant) and (known is None or known.misfit > alike(best)):
        _take_over(attempts, rival, quantity, best)
    elif jumps(rest) and not adequate(best):
        # grown on the rest, its effects have first been bent to stand for the drift
        attempts.add(rival, best.values)


def _by_a_change(rest: Explanation, quantity: Quantity, attempts: Attempts) -> list[Explanation]:
    """`rest` with the parameter that may have changed at the moment at which an effect begins, if it has one."""
    if not isinstance(quantity, Variant) or not may_change(rest, attempts.data):
        return []
    constant = _constant_part(quantity, attempts.nominal)
    if constant is None or _beginning(quantity) is None or constant[1] in rest.drifted:
        return []
    return [replace(rest, changed=constant[1])]


def _constant_part(variant: Variant, model: Model) -> tuple[str, str] | None:
    """Dotted name of what acts as a change of a base parameter, and that parameter; None where the model has none."""
    constant = EFFECT[variant.effect].constant_part
    if constant is None or constant[1] not in model.values:
        return None
    return f"{variant.effect}.{constant[0]}", constant[1]


def _beginning(variant: Variant) -> str | None:
    """Dotted name of the moment from which an effect acts, where that is searched."""
    return next(iter(moments(variant)), None)


def _take_over(attempts: Attempts, explanation: Explanation, fading: Variant, best: Fit) -> None:
    """Fit an explanation that stands for an effect of `best` by other means, if it keeps up as the effect fades.

    In one step the others would have to take over all of it, and events would jump. They would also jump if its other
    effects gave way meanwhile. What takes over may hardly be told apart itself, as resistance and supply are: the first
    steps are those that the slopes foresee, for damped ones would not come far along such a valley.
    """
    values = best.values
    for start in _at_once(explanation, fading, best):
        attempts.add(explanation, start)
    held = tuple(_faded(variant, best, 1.0) for variant in explanation.variants)
    for share in FADING:
        effects = (*held, _faded(fading, best, share)) if share > 0.0 else held
        stage = Explanation(explanation.drifted, effects, explanation.changed)
        try:
            slopes = attempts.first_part.at(stage, values).solution.jacobian
            stage_fit = attempts.first_part.fit(stage, values, ROUNDS, slopes=slopes)
        except InputError:
            continue
        if stage_fit.ratio > NEAR * best.ratio:
            return
        values = stage_fit.values
    attempts.add(explanation, attempts.add(explanation, values).values)


def _at_once(explanation: Explanation, fading: Variant, best: Fit) -> Iterator[dict[str, float]]:
    """Values at which a base parameter is what the effect was, all the time or from its start, if there is one."""
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
    """The effect as `fit` has it, fixed at a share of its strength."""
    declared = EFFECT[variant.effect]
    values = {name: fit.model.values[f"{variant.effect}.{name}"] for name in declared.names}
    scaled = {name: value * (share if name in declared.strength else 1.0) for name, value in values.items()}
    return Variant(variant.effect, (), tuple(scaled.items()))
