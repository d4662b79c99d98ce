"""How sure the values of a fit are: 95 % intervals, from the curvature of the cost and along its valley."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.effects import DECLARED
from pierburg_ros.estimation.covariance import Covariance, covariance_of
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.estimation.explanation import WHEN, jumps
from pierburg_ros.estimation.least_squares import BRIEF, Solution
from pierburg_ros.estimation.likelihood import SURE, TIED
from pierburg_ros.estimation.slopes import FINE, sharp

DOUBLINGS = 7
"""How often the reach of an interval is doubled at most: 128 times what the curvature says. Work: each costs up to
three brief descents; an interval that wide is not identifiable anyway."""
PATIENCE = 3
"""How many reaches without success end the search where events jump. Work: a descent may have ended in a local
minimum, so one failure is no end; each costs up to three brief descents."""
HALF_WAY = 1.5
"""Reach, in that of the last success, half way to the next one. Derived: the mean of 1 and 2, as reaches double."""
HALF_KNOWN = 0.5
"""A value whose 95 % interval reaches further than this share of it to either side is not identifiable. Given: a value
known to no better than a half is none to act on; a convention of the report."""

Map = Callable[..., Iterable[Any]]


@dataclass(frozen=True)
class Estimate:
    """A value with its 95 % interval and whether the data fix it."""

    value: float
    low: float
    high: float
    identifiable: bool


def covariance(estimator: Estimator, fit: Fit) -> tuple[Covariance, Signal]:
    """Covariance of a fit's coordinates, and the slopes [noise] that it comes from, shape (samples, quantities)."""
    coordinates = estimator.coordinates(fit.explanation)

    def residual(point: Signal) -> Signal:
        return estimator.residual_at(fit.explanation, coordinates, point)

    slopes = sharp(residual, fit.solution.point, coordinates.bounds)
    lengths = [int(np.count_nonzero(run.train)) for run in estimator.data.runs]
    parts = np.split(fit.solution.residual, np.cumsum(lengths)[:-1])
    return covariance_of(slopes, tuple(part for part in parts if part.size)), slopes


def estimates(estimator: Estimator, fit: Fit, over: Map = map) -> dict[str, Estimate]:
    """Value and interval of each free quantity by dotted name; `over` maps a function over the ends to be found.

    A first interval is that of the covariance. Where events jump with the values, the slope at the fit is that of a
    local minimum and the interval too short: each end is therefore moved on while the others, fitted again, keep chi2
    within what 95 % allows (profile likelihood; Murphy and van der Vaart, On Profile Likelihood, J. Am. Stat. Assoc.
    95, 2000). The cost has steps along a moment, since it counts for nothing while the shaft stands still: its interval
    reaches at least to where the step of the fit ends.
    """
    return _profiled(estimator, fit, over)[0]


def lowest_with_estimates(estimator: Estimator, fit: Fit, over: Map = map) -> tuple[Fit, dict[str, Estimate]]:
    """`fit`, or a lower one that the ends of its intervals come upon where events jump, and the `estimates` at it.

    An end is looked for with the other quantities fitted again and again, far along the valley: a way out of a local
    minimum that descents from around it do not take.
    """
    while True:
        known, allowed = _profiled(estimator, fit, over)
        if not jumps(fit.explanation):
            return fit, known
        costs = over(partial(estimator.chi2_at, fit.explanation), allowed)
        cost, lowest = min(zip(costs, allowed, strict=True), key=lambda pair: pair[0], default=(np.inf, fit.values))
        if cost >= fit.chi2 - TIED * fit.repetition:
            return fit, known
        fit = estimator.fit(fit.explanation, lowest)


def _profiled(estimator: Estimator, fit: Fit, over: Map) -> tuple[dict[str, Estimate], list[dict[str, float]]]:
    """The `estimates` at a fit, and all values that they allow."""
    names = fit.explanation.names
    if not names:
        return {}, []
    known = covariance(estimator, fit)[0]
    reach = known.factor * np.sqrt(np.maximum(np.diagonal(known.matrix), 0.0))
    rough = jumps(fit.explanation)
    limit = fit.chi2 + (TIED if rough else SURE**2) * fit.spread
    coordinates = estimator.coordinates(fit.explanation)

    def first(place: int, side: float) -> float:
        if known.undetermined[place] or _is_moment(names[place]):
            return _plateau(estimator, fit, place, side, limit)
        return float(reach[place])

    sides = [(place, side * first(place, side)) for place in range(len(names)) for side in (-1.0, 1.0)]
    ends = over(lambda side: _ends(estimator, fit, side[0], side[1], limit, rough), sides)
    allowed = [coordinates.values(point) for point in itertools.chain(*ends)]
    result = {}
    for name in names:
        low, high = (pick(values[name] for values in allowed) for pick in (min, max))
        value = fit.values[name]
        identifiable = max(high - value, value - low) <= HALF_KNOWN * abs(value)
        result[name] = Estimate(value, min(low, value), max(high, value), identifiable)
    return result, allowed


def _plateau(estimator: Estimator, fit: Fit, place: int, side: float, limit: float) -> float:
    """How far a quantity moves alone until chi2 passes the `limit`, to the step with which slopes are taken.

    At most to its bound. A load may begin at any moment while the shaft stands still.
    """
    coordinates = estimator.coordinates(fit.explanation)
    lower, upper = (float(bound[place]) for bound in coordinates.bounds)
    step = FINE * (upper - lower)

    def allowed(reach: float) -> bool:
        point = fit.solution.point.copy()
        point[place] = np.clip(point[place] + side * reach, lower, upper)
        return estimator.chi2_at(fit.explanation, coordinates.values(point)) <= limit

    inside, outside = 0.0, step
    while outside < upper - lower and allowed(outside):
        inside, outside = outside, 2.0 * outside
    while outside - inside > step:
        between = 0.5 * (inside + outside)
        inside, outside = (between, outside) if allowed(between) else (inside, between)
    return max(inside, step)


def _is_moment(name: str) -> bool:
    """Whether a quantity is a moment: of a change, or when an effect begins or ends."""
    return name.endswith(WHEN) or (name in DECLARED and DECLARED[name].moment)


def _ends(estimator: Estimator, fit: Fit, place: int, reach: float, limit: float, rough: bool) -> list[Signal]:
    """Points that an interval must hold: `reach` away along one of the coordinates, then in the valley.

    Further out the other quantities are fitted again, as long as chi2 keeps the `limit`. Three starts are tried: where
    the valley leads, where it was last, and the best values. Where events jump, `PATIENCE` reaches without success end
    the search, and half way from the last success to the next reach is tried as well: an end found by doubling may lie
    at half of what is allowed.
    """
    coordinates = estimator.coordinates(fit.explanation)
    lower, upper = coordinates.bounds
    name = fit.explanation.names[place]
    best = fit.solution.point

    def moved(distance: float, valley: Signal) -> Signal:
        point = np.clip(best + valley, lower, upper)
        point[place] = np.clip(best[place] + distance, lower[place], upper[place])
        return np.asarray(point)

    def fitted(distance: float, valley: Signal, further: float) -> Solution:
        """The best fit at so great a distance, from the valley that leads there by a factor `further`.

        A smooth cost needs no better one than the first that keeps the limit.
        """
        starts = (moved(distance, further * valley), moved(distance, valley), moved(distance, nowhere))
        solutions: list[Solution] = []
        for start in {tuple(start): start for start in starts}.values():
            solutions.append(estimator.fit(fit.explanation, coordinates.values(start), BRIEF, held=name).solution)
            if not rough and solutions[-1].cost <= limit:
                break
        return min(solutions, key=lambda solution: solution.cost)

    nowhere = np.zeros(best.size)
    points, valley, reached = [moved(reach, nowhere)], nowhere, 0.0
    patience = PATIENCE if rough else 1
    for _ in range(DOUBLINGS):
        there = fitted(reach, valley, 2.0)
        if there.cost <= limit:
            points.append(there.point)
            valley, reached = there.point - best, reach
        else:
            patience -= 1
        if patience == 0 or not lower[place] < there.point[place] < upper[place]:
            break
        reach *= 2.0
    if rough and reached != 0.0 and patience == 0:
        there = fitted(HALF_WAY * reached, valley, HALF_WAY)
        points += [there.point] if there.cost <= limit else []
    return points
