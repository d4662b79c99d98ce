"""How well a fit knows its quantities: 95 % intervals, and which of them only show together.

The covariance follows from the slopes of the residual at the fit. A residual that is correlated in time counts in
effective samples, or by its sums over blocks (the sandwich) where these vary more. What a fit holds is known from its
description only: its slopes count too, so that no quantity is known better than what it is only seen in ratio to.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.effects import EFFECT
from pierburg_ros.errors import InputError
from pierburg_ros.inference.coordinates import ABOVE, Coordinates, without_effects
from pierburg_ros.inference.covariance import RANK, Spread, spread
from pierburg_ros.inference.explanation import WHEN, Explanation, moments_of, without
from pierburg_ros.inference.fit import Fit, strongest
from pierburg_ros.inference.slopes import sharp
from pierburg_ros.plant import Model

HALF_KNOWN = 0.5
"""A value whose 95 % interval reaches further than this share of it to either side is not identifiable. Given: nobody
should act on a value known to no better than a half; a convention of the report."""
DEVIATIONS = 4.0
"""Standard deviations in the range of a parameter. Given: its ends count as two either way."""
NARROWED = 0.5
"""Share of the standard deviation before a recording below which the one after it must be for the recording to tell a
quantity. Derived: three quarters of what is known then come from the recording."""
FREE = 10.0
"""Standard deviation before a recording of what is free, in ranges. Derived: what is held, a quarter of a range, then
counts 1600 times as much, and all that is determined at all a million times."""
TOGETHER = 0.99
"""Correlation from which quantities only show together. Derived: each would be known seven times, 1 / sqrt(1 -
0.99^2), better if the others were known."""
ON_BOUND = 1e-6
"""Distance from a bound, as a share of the range, within which a fit ended on it. Derived: far above rounding, and far
below any step of a fit."""
TWO_SIDED = 3.84
"""Rise of -2 log likelihood at the ends of a 95 % interval. Derived: the square of 1.96."""
MOVED_OUT = 10
"""Times that an end is moved out. Derived: from an interval a thousandth as wide as it should be."""
OUTWARD = 2.0
"""Factor by which it is moved. Chosen: an interval is then too wide by this factor at most."""
NUDGE = 1e-6
"""Step in coordinates for the slope of a value. Derived: conversions are smooth; the error is 1e-12."""


@dataclass(frozen=True)
class Interval:
    """What a fit knows of one quantity, in the quantity's unit.

    `ci95` is None where the recordings do not determine it, and where the fit ended on a bound of the search
    (`at_bound`). `identifiable`: the interval is narrow enough to act on. `tied_with` names quantities, free or held,
    with which it only shows together: each by itself, or else the fewest that do so in common.
    """

    value: float
    ci95: tuple[float, float] | None
    identifiable: bool
    at_bound: bool
    tied_with: tuple[str, ...]


def intervals(fit: Fit, held: Sequence[str] = ()) -> dict[str, Interval]:
    """What `fit` knows of each free quantity, by dotted name, beside parameters that it `held`.

    A held parameter may be anywhere in its range, whose ends count as two standard deviations.
    """
    own = fit.explanation
    if not own.names:
        return {}
    beside = tuple(name for name in held if name not in own.names)
    whole = replace(own, drifted=(*beside, *own.drifted))
    coordinates = fit.fitter.coordinates(whole)
    point = coordinates.point(fit.values)
    residuals = by_run(fit)
    lower, upper = coordinates.bounds
    ranges = (upper - lower) / DEVIATIONS
    before = np.where([name in beside for name in whole.names], ranges, FREE * (upper - lower))
    known = spread(slopes_at(fit, whole), residuals, before, fit.rounding)
    told = np.sqrt(np.diagonal(known.matrix)) < NARROWED * ranges
    on_bound = np.minimum(point - lower, upper - point) <= ON_BOUND * (upper - lower)
    found = {}
    for name in own.names:
        place, value = whole.names.index(name), coordinates.values(point)[name]
        at_bound = bool(on_bound[place])
        several = [_ends(fit, coordinates, point, name, known)] if told[place] else []
        several += [flat] if (flat := moment_ends(fit, name)) else []
        ci95 = None
        if several and not at_bound:
            ci95 = min(low for low, _ in several), max(high for _, high in several)
        near = ci95 is not None and max(value - ci95[0], ci95[1] - value) <= HALF_KNOWN * abs(value)
        partners = tuple(whole.names[other] for other in together(known.matrix, place))
        found[name] = Interval(value, ci95, near, at_bound, partners)
    return found


def moment_ends(fit: Fit, name: str) -> tuple[float, float] | None:
    """The first and the last moment [s] that are as likely as 95 % allow; None for what is no moment of one recording.

    A cost is flat over a moment while the shaft does not show it, at rest on a stop or where samples are held out. Both
    models are simulated whole, with the strongest pull, which forgets soonest what was before.
    """
    effect, _, parameter = name.partition(".")
    if len(fit.fitter.data.runs) > 1:
        return None
    fitter, time = strongest(fit.fitter), fit.fitter.data.runs[0].time
    if name.endswith(WHEN):
        assert fit.after is not None
        gained, where = fitter.gained(fit.model, fit.after), np.ones(time.size, dtype=bool)
    elif parameter and parameter in (moments := moments_of(effect)):
        start, end = (fit.values[f"{effect}.{each}"] for each in moments)
        gained = fitter.gained(*at_no_time_and_always(fit, effect))
        is_start = parameter == moments[0]
        gained, where = (gained, time < (end or math.inf)) if is_start else (-gained, time >= start)
    else:
        return None
    if not where.any():
        return None
    allowed = np.min(gained[where]) + TWO_SIDED * fit.repetition * max(fit.ratio**2, 1.0)
    possible = np.flatnonzero(where & (gained <= allowed))
    return float(time[possible[0]]), float(time[min(possible[-1] + 1, time.size - 1)])


def at_no_time_and_always(fit: Fit, effect: str) -> tuple[Model, Model]:
    """The model of a fit without a dated effect, and with it at all times."""
    always = fit.model.with_values({f"{effect}.{each}": 0.0 for each in moments_of(effect)})
    return without_effects(always, [effect]), always


def slopes_at(fit: Fit, explanation: Explanation) -> Signal:
    """Derivative of the fitted residual at `fit` by coordinates of an `explanation`, shape (samples, quantities)."""
    fitter, coordinates = fit.fitter, fit.fitter.coordinates(explanation)

    def fitted(point: Signal) -> Signal:
        return fitter.fitted(explanation, {**fit.values, **coordinates.values(point)})

    return sharp(fitted, coordinates.point(fit.values), coordinates.bounds)


def together(matrix: Signal, place: int) -> list[int]:
    """The quantities of a covariance `matrix` each of which determines the one at a `place`, or the fewest that do."""
    deviation = np.sqrt(np.maximum(np.diagonal(matrix), 1e-300))
    correlation = matrix / np.outer(deviation, deviation)

    def shared(others: list[int]) -> float:
        inner, own = correlation[np.ix_(others, others)], correlation[others, place]
        return float(own @ np.linalg.pinv(inner, rcond=RANK**2, hermitian=True) @ own)

    chosen: list[int] = []
    rest = [other for other in range(deviation.size) if other != place]
    alone = [other for other in rest if abs(correlation[other, place]) > TOGETHER]
    while rest and not alone:
        best = max(rest, key=lambda other: shared([*chosen, other]))
        chosen, rest = [*chosen, best], [other for other in rest if other != best]
        if shared(chosen) > TOGETHER**2:
            return chosen
    return alone


def _ends(fit: Fit, coordinates: Coordinates, point: Signal, name: str, known: Spread) -> tuple[float, float]:
    """The least and the largest value of a quantity within its 95 %, the others where they are likeliest then."""
    slope = np.zeros(point.size)
    for each in (name, ABOVE.get(name)):
        if each in coordinates.names:
            place = coordinates.names.index(each)
            axis, at = coordinates.axes[place], float(point[place])
            slope[place] = (axis.value(at + NUDGE) - axis.value(at - NUDGE)) / (2.0 * NUDGE)
    move = known.factor * (known.matrix @ slope / max(math.sqrt(float(slope @ known.matrix @ slope)), 1e-300))

    def end(side: float) -> float:
        """The end on one side, moved out while a fit with the value held there is as likely."""
        for _ in range(MOVED_OUT):
            values = coordinates.values(np.clip(point + side * move, *coordinates.bounds))
            if not _possible(fit, name, values):
                break
            side *= OUTWARD
        return coordinates.values(point + side * move)[name]

    low, high = end(-1.0), end(1.0)
    return min(low, high), max(low, high)


def _possible(fit: Fit, name: str, values: dict[str, float]) -> bool:
    """Whether a fit from some values on, with the quantity held there, is as likely as 95 % allow.

    Only of effects that make events: where these come, numbers that move together bend, and slopes do not tell that.
    """
    variant = next((each for each in fit.explanation.variants if name in each.names), None)
    if variant is None or EFFECT[variant.effect].mark is None:
        return False
    held = without(fit.explanation, variant).plus(
        variant.holding(name.removeprefix(f"{variant.effect}."), values[name])
    )
    possible = fit.chi2 + TWO_SIDED * fit.repetition * max(fit.ratio**2, 1.0)
    # along the ridge, and from the fit: a descent may end in a minimum beside either
    for start in ({**fit.values, **values}, {**fit.values, name: values[name]}):
        with suppress(InputError):
            if fit.fitter.fit(held, start).chi2 <= possible:
                return True
    return False


def by_run(fit: Fit) -> tuple[Signal, ...]:
    """The fitted residual, one array for each run with samples that were fitted."""
    data = fit.fitter.data
    parts = data.by_run(data.train)
    ends = np.cumsum([np.count_nonzero(part) for part in parts])[:-1]
    return tuple(part for part in np.split(fit.fitted, ends) if part.size)
