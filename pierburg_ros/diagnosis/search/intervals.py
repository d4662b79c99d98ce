"""How sure the values of a fit are."""

from __future__ import annotations

import itertools
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.diagnosis.search.candidates import is_rough
from pierburg_ros.diagnosis.search.fits import Fit, Search, spread

SURE = 1.96
"""Standard deviations to either side that hold 95 %; its square is the rise of chi2 at the ends."""
DOUBLINGS = 7
"""How often the reach of an interval is doubled at most."""
DENTED = 12.0
"""Rise of chi2 allowed where the cost is rough: the best of many dents is lower than the true one by luck."""
PATIENCE = 3
"""How many reaches without success end the search where the cost is rough: a fit may have ended in a dent."""
FIRST = 1e-5
"""Share of its range by which a quantity without a slope is moved first."""
BRIEF = 4
"""Iterations in which the other quantities are fitted again."""
HALF_KNOWN = 0.5
"""A value whose 95 % interval reaches further than this share of it to either side is not identifiable."""


@dataclass(frozen=True)
class Estimate:
    """A value with its 95 % interval and whether the data fix it."""

    value: float
    low: float
    high: float
    identifiable: bool


def estimates(search: Search, fit: Fit) -> dict[str, Estimate]:
    """Value and interval of each free quantity by dotted name.

    The covariance is that of least squares with white noise, times the residual's repetition: samples that say
    the same thing count once. It gives a first interval, linear in the search's coordinates. Where events jump with
    the values the slope at the fit is that of a dent and the interval too short: each end is therefore moved on
    while the others, fitted again, keep chi2 within what 95 % allows (profile likelihood; Murphy and van der Vaart,
    On Profile Likelihood, J. Am. Stat. Assoc. 95, 2000).
    """
    jacobian = fit.solution.jacobian
    normal = jacobian.T @ jacobian
    rise = spread(fit)
    covariance = np.linalg.pinv(normal, rcond=1e-13, hermitian=True) * rise
    weak = np.diag(normal) <= 1e-12 * max(float(np.max(np.diag(normal), initial=0.0)), 1e-300)
    reach = SURE * np.sqrt(np.maximum(np.diag(covariance), 0.0))
    rough = is_rough(fit.explanation)
    limit = fit.chi2 + (DENTED if rough else SURE**2) * rise
    places = range(len(fit.explanation.names))
    coordinates = search.coordinates(fit.explanation)
    sides = [
        (place, side * (_plateau(search, fit, place, side, limit) if weak[place] else float(reach[place])))
        for place in places
        for side in (-1.0, 1.0)
    ]
    with ThreadPoolExecutor(2) as pool:
        ends = list(pool.map(lambda side: _ends(search, fit, side[0], side[1], limit, PATIENCE if rough else 1), sides))
    allowed = [coordinates.values(point) for point in itertools.chain(*ends)]
    result = {}
    for name in fit.explanation.names:
        low, high = (pick(values[name] for values in allowed) for pick in (min, max))
        value = fit.values[name]
        known = max(high - value, value - low) <= HALF_KNOWN * abs(value)
        result[name] = Estimate(value, low, high, known)
    return result


def _plateau(search: Search, fit: Fit, place: int, side: float, limit: float) -> float:
    """How far a quantity without a slope moves alone until chi2 passes the `limit`, to a factor of two.

    At most to its bound. A load may begin at any moment while the shaft stands still.
    """
    coordinates = search.coordinates(fit.explanation)
    lower, upper = (float(bound[place]) for bound in coordinates.bounds())
    reach = FIRST * (upper - lower)
    while reach < upper - lower:
        point = fit.solution.point.copy()
        point[place] = np.clip(point[place] + side * reach, lower, upper)
        if search.chi2_at(fit.explanation, coordinates.values(point)) > limit:
            break
        reach *= 2.0
    return reach


def _ends(search: Search, fit: Fit, place: int, reach: float, limit: float, patience: int) -> list[Signal]:
    """Points that an interval must hold: `reach` away along one of the search's coordinates, then in the valley.

    Further out the other quantities are fitted again, as long as chi2 keeps the `limit`: from where the valley
    leads, from where it was last, and from where they are at the best. `patience`: reaches without success that end it.
    """
    coordinates = search.coordinates(fit.explanation)
    lower, upper = coordinates.bounds()
    name = fit.explanation.names[place]
    best = fit.solution.point

    def moved(distance: float, valley: Signal) -> Signal:
        point = np.clip(best + valley, lower, upper)
        point[place] = np.clip(best[place] + distance, lower[place], upper[place])
        return np.asarray(point)

    nowhere = np.zeros(best.size)
    points, valley = [moved(reach, nowhere)], nowhere
    for _ in range(DOUBLINGS):
        starts = (moved(reach, 2.0 * valley), moved(reach, valley), moved(reach, nowhere))
        tried = {tuple(start): start for start in starts}.values()
        fits = [search.fit(fit.explanation, coordinates.values(start), BRIEF, held=name).solution for start in tried]
        there = min(fits, key=lambda solution: solution.cost)
        if there.cost <= limit:
            points.append(there.point)
            valley = there.point - best
        else:
            patience -= 1
        if patience == 0 or not lower[place] < there.point[place] < upper[place]:
            break
        reach *= 2.0
    return points
