"""95 % confidence intervals of fitted values, from the curvature of the cost and along its valley."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.effects import DECLARED
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.estimation.likelihood import SURE, TIED
from pierburg_ros.inference.covariance import Covariance, covariance_of
from pierburg_ros.inference.explanation import WHEN, jumps
from pierburg_ros.inference.least_squares import BRIEF, Solution
from pierburg_ros.inference.slopes import FINE, sharp

DOUBLINGS = 7
"""Largest number of times that the reach of an interval is doubled: up to 128 times the reach from the curvature. Work:
each costs up to three brief descents; an interval that wide is not identifiable anyway."""
PATIENCE = 3
"""Number of reaches without success that end the search where events jump. Work: a descent may have ended in a local
minimum, so one failure does not end the search; each costs up to three brief descents."""
HALF_WAY = 1.5
"""Reach half way to the next one, in units of the reach of the last success. Derived: the mean of 1 and 2, as reaches
double."""
HALF_KNOWN = 0.5
"""A value whose 95 % interval reaches further than this share of it to either side is not identifiable. Given: nobody
should act on a value known to no better than a half; a convention of the report."""

Map = Callable[..., Iterable[Any]]


@dataclass(frozen=True)
class Estimate:
    """A value with its 95 % interval, and whether the data determine it."""

    value: float
    low: float
    high: float
    identifiable: bool


def covariance(estimator: Estimator, fit: Fit) -> tuple[Covariance, Signal]:
    """Covariance of a fit's coordinates, and the slopes [noise] from which it follows, shape (samples, quantities)."""
    coordinates = estimator.coordinates(fit.explanation)

    def residual(point: Signal) -> Signal:
        return estimator.residual_at(fit.explanation, coordinates, point)

    slopes = sharp(residual, fit.solution.point, coordinates.bounds)
    lengths = [int(np.count_nonzero(run.train)) for run in estimator.data.runs]
    parts = np.split(fit.solution.residual, np.cumsum(lengths)[:-1])
    return covariance_of(slopes, tuple(part for part in parts if part.size)), slopes


def estimates(estimator: Estimator, fit: Fit, over: Map = map) -> dict[str, Estimate]:
    """Value and interval of each free quantity by dotted name; `over` maps a function over the ends to be found.

    The first interval is that of the covariance. Where events jump with the values, the slope at the fit is that of a
    local minimum, and this interval is too short. The search therefore moves each end outwards and fits the other
    quantities again, while chi2 stays within what 95 % allows (profile likelihood; Murphy and van der Vaart, On Profile
    Likelihood, J. Am. Stat. Assoc. 95, 2000). The cost has steps along a moment, since a moment has no influence while
    the shaft stands still. The interval of a moment reaches at least to the end of the step with the fit.
    """
    return _profiled(estimator, fit, over)[0]


def lowest_with_estimates(estimator: Estimator, fit: Fit, over: Map = map) -> tuple[Fit, dict[str, Estimate]]:
    """`fit`, or a lower one found at the ends of its intervals where events jump, and the `estimates` at it.

    The search for an end fits the other quantities again and again, far along the valley. This is a way out of a local
    minimum that descents from nearby do not take.
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
    """The `estimates` at a fit, and the values at all points that the intervals must include."""
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
    """Distance that a quantity can move alone until chi2 passes the `limit`, to within the step for slopes.

    The distance ends at the bound. Example: a load may begin at any moment while the shaft stands still.
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
    """Whether a quantity is a moment: the time of a change, or that at which an effect begins or ends."""
    return name.endswith(WHEN) or (name in DECLARED and DECLARED[name].moment)


def _ends(estimator: Estimator, fit: Fit, place: int, reach: float, limit: float, rough: bool) -> list[Signal]:
    """Points that an interval must include: one at `reach` along one of the coordinates, then others along the valley.

    Further out the other quantities are fitted again, as long as chi2 keeps the `limit`. Each fit has three starts: the
    valley extrapolated, the valley at the last success, and the best values. Where events jump, `PATIENCE` reaches
    without success end the search. The point half way from the last success to the next reach is then tried as well: an
    end found by doubling may lie at half of the allowed distance.
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
        """The best fit at a `distance`; `further` is the factor by which the valley is extrapolated to it.

        For a smooth cost, the first fit within the limit is enough.
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
