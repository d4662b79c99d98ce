"""How sure the values of a fit are."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pierburg_ros.diagnosis.search import Fit, Search, repetition

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
    """Value and interval of each free quantity by dotted name, from the curvature of the cost at the fit.

    The covariance is that of least squares with white noise, times the residual's repetition: samples that say
    the same thing count once. Intervals are linear in the search's coordinates.
    """
    jacobian = fit.solution.jacobian
    normal = jacobian.T @ jacobian
    spread = max(1.0, fit.ratio**2) * repetition(fit)
    covariance = np.linalg.pinv(normal, rcond=1e-13, hermitian=True) * spread
    weak = np.diag(normal) <= 1e-12 * max(float(np.max(np.diag(normal), initial=0.0)), 1e-300)
    coordinates = search.coordinates(fit.explanation)
    lower, upper = coordinates.bounds()
    result = {}
    for i, name in enumerate(fit.explanation.names):
        reach = 1.96 * np.sqrt(max(float(covariance[i, i]), 0.0)) if not weak[i] else np.inf
        ends = []
        for side in (-reach, reach):
            point = fit.solution.point.copy()
            point[i] = np.clip(point[i] + side, lower[i], upper[i])
            ends.append(coordinates.values(point)[name])
        low, high = min(ends), max(ends)
        value = fit.values[name]
        known = max(high - value, value - low) <= HALF_KNOWN * abs(value)
        result[name] = Estimate(value, low, high, bool(known and np.isfinite(reach)))
    return result
