"""A second look around a fit whose cost is rough: events jump with the parameters, and a descent ends in any dent."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pierburg_ros.diagnosis.search import Fit, Search, repetition

Signal = NDArray[np.float64]

REACHES = (0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0)
"""How far to look along each axis of the cost, in standard deviations of the fit."""
FINEST = 1e-3
"""Least difference for a Jacobian, as a share of the usual one."""
ROUNDS = 6
"""How often a better point is descended from."""
WIDEST = 0.25
"""Share of a parameter's range beyond which nothing is looked for."""


def polished(search: Search, fit: Fit) -> Fit:
    """`fit`, or a better one of the same explanation, descended to from a lower point on one of its cost's axes."""
    for _ in range(ROUNDS):
        again = search.fit(fit.explanation, _lower(search, fit), steps=_steps(search, fit))
        if again.chi2 > fit.chi2 - repetition(fit):
            break
        fit = again
    return fit


def _steps(search: Search, fit: Fit) -> Signal:
    """Differences for the Jacobian that are no longer than what the data tell apart."""
    usual = search.coordinates(fit.explanation).steps()
    told_apart = np.sqrt(_spread(fit) / np.maximum(np.sum(fit.solution.jacobian**2, axis=0), 1e-300))
    return np.asarray(np.clip(told_apart, FINEST * usual, usual))


def _spread(fit: Fit) -> float:
    """Rise of chi2 that stands for one standard deviation, squared."""
    return max(1.0, fit.ratio**2) * repetition(fit)


def _lower(search: Search, fit: Fit) -> dict[str, float]:
    """Values at the lowest point on the axes, those of `fit` where none is lower."""
    coordinates = search.coordinates(fit.explanation)
    lower, upper = coordinates.bounds()
    best, found = fit.chi2, fit.values
    for axis in _axes(fit, WIDEST * (upper - lower)):
        for reach in REACHES:
            for side in (-reach, reach):
                values = coordinates.values(np.clip(fit.solution.point + side * axis, lower, upper))
                residual = search.residual(*search.models(fit.explanation, values))
                if float(residual @ residual) < best:
                    best, found = float(residual @ residual), values
    return found


def _axes(fit: Fit, widest: Signal) -> list[Signal]:
    """The axes of the cost around `fit`, each as long as one standard deviation along it, at most `widest`."""
    jacobian = fit.solution.jacobian
    stiffness, directions = np.linalg.eigh(jacobian.T @ jacobian)
    lengths = np.sqrt(_spread(fit) / np.maximum(stiffness, 1e-12 * max(float(stiffness[-1]), 1e-300)))
    found = []
    for length, direction in zip(lengths, directions.T, strict=True):
        room = float(np.min(widest / np.maximum(np.abs(direction), 1e-12)))
        found.append(min(length, room / REACHES[-1]) * direction)
    return found
