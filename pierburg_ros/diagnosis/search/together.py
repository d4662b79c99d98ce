"""Parameters that drift together: as many as recordings tell apart, and as few as do the same."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np
from scipy.linalg import qr

from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.estimation.explanation import Explanation

INDEPENDENT = 1e-3
"""A parameter whose mark in the signal, beyond those of the others, is smaller than this share of its own adds none.
Derived: one-sided differences of 0.05 % show an exact tie as up to 5e-4."""
Begun = tuple[Explanation, dict[str, float]]
"""An explanation and the values from which it is fitted."""


def drifting_apart(estimator: Estimator, drifts: Sequence[str]) -> Explanation:
    """As many of the `drifts` as the recordings tell apart, by their marks in the signal at nominal values."""
    jacobian = estimator.at(Explanation(tuple(drifts))).solution.jacobian
    marks = jacobian / np.maximum(np.linalg.norm(jacobian, axis=0), 1e-12)
    _, triangle, order = qr(marks, mode="economic", pivoting=True)
    count = int(np.sum(np.abs(np.diag(triangle)) > INDEPENDENT))
    names = {drifts[index] for index in order[:count]}
    return Explanation(tuple(name for name in drifts if name in names))


def drifting_fewer(fit: Fit, estimator: Estimator, drifts: Sequence[str], count: int) -> list[Begun]:
    """The effects of a `fit` with only so many of the `drifts`, the best combinations first.

    All are asked, by one linear step at the values of the fit: what its residual grows by where the other parameters
    are nominal again, and those in the combination, and the effects, make up for it. In logarithms that is exact for
    parameters that the recordings tell only by their products and ratios.
    """
    everything = Explanation(tuple(drifts), fit.explanation.variants)
    at, coordinates = estimator.at(everything, fit.values), estimator.coordinates(everything)
    begin = at.solution.point
    back = coordinates.point(estimator.nominal.values) - begin
    triangle = np.asarray(qr(at.solution.jacobian, mode="r")[0])[: begin.size]
    found: list[tuple[float, Begun]] = []
    for chosen in itertools.combinations(range(len(drifts)), count):
        free = np.arange(begin.size) >= len(drifts)
        free[list(chosen)] = True
        step = np.where(free, 0.0, back)
        if free.any():
            step[free] = np.linalg.lstsq(triangle[:, free], -triangle @ step, rcond=None)[0]
        grown = float(np.sum(np.square(triangle @ step)))
        values = coordinates.values(np.clip(begin + step, *coordinates.bounds))
        own = Explanation(tuple(everything.drifted[place] for place in chosen), everything.variants)
        found.append((grown, (own, {**estimator.nominal.values, **values})))
    return [each for _, each in sorted(found, key=lambda one: one[0])]
