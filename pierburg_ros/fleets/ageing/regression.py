"""Weighted regression of estimates whose stated deviations may be too small: the scatter between them is estimated too.

The model is that of a meta-regression: y = X b + u + e, the errors e with the stated deviations, the scatter u between
recordings with one unknown variance. That is found as Paule and Mandel do, so that the weighted squares of what remains
are as many as its degrees of freedom (R. C. Paule and J. Mandel, Consensus values and weighting factors, J. Res. NBS 87
(1982) 377-385). Where even without scatter less remains, stated deviations are too wide and are left so. Intervals are
those of Student's t (G. Knapp and J. Hartung, Improved tests for a random effects meta-regression with a single
covariate, Statistics in Medicine 22 (2003) 2693-2710), never shorter than the weights alone make them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy import optimize, stats

from pierburg_ros.arrays import Signal


@dataclass(frozen=True)
class Regression:
    """Coefficients with their `covariance`, shape (columns,) and (columns, columns).

    `scatter` is the standard deviation between recordings beside the stated ones, `freedom` the degrees of freedom,
    `squares` the weighted squares of what remains.
    """

    coefficients: Signal
    covariance: Signal
    scatter: float
    freedom: int
    squares: float

    def chance(self, column: int) -> float:
        """How often chance alone makes a coefficient as large, to either side."""
        deviation = math.sqrt(self.covariance[column, column])
        return float(2.0 * stats.t.sf(abs(self.coefficients[column]) / deviation, self.freedom))

    def interval(self, column: int) -> tuple[float, float]:
        """95 % interval of a coefficient."""
        reach = self.quantile * math.sqrt(self.covariance[column, column])
        value = float(self.coefficients[column])
        return value - reach, value + reach

    @property
    def quantile(self) -> float:
        """Deviations to either side that hold 95 %."""
        return float(stats.t.ppf(0.975, self.freedom))

    def at(self, row: Signal) -> tuple[float, float]:
        """The mean where the columns have the values of `row`, and its standard deviation."""
        return float(row @ self.coefficients), math.sqrt(max(float(row @ self.covariance @ row), 0.0))


def regression(columns: Signal, values: Signal, deviations: Signal, scatter: float | None = None) -> Regression | None:
    """The regression of `values`, shape (recordings,), on `columns`, shape (recordings, columns).

    `scatter` is estimated where it is not given. None where the columns cannot be told apart or nothing is left over.
    """
    freedom = values.size - columns.shape[1]
    if freedom < 1 or np.linalg.matrix_rank(_scaled(columns)) < columns.shape[1]:
        return None
    between = _between(columns, values, deviations, freedom) if scatter is None else scatter**2
    inverse, coefficients, squares = _weighted(columns, values, 1.0 / (deviations**2 + between))
    covariance = inverse * max(squares / freedom, 1.0)
    return Regression(coefficients, covariance, float(np.sqrt(between)), freedom, squares)


def _between(columns: Signal, values: Signal, deviations: Signal, freedom: int) -> float:
    """The variance between recordings of Paule and Mandel, 0 where the stated deviations explain all."""

    def excess(between: float) -> float:
        return _weighted(columns, values, 1.0 / (deviations**2 + between))[2] - freedom

    if excess(0.0) <= 0.0:
        return 0.0
    plain = np.linalg.lstsq(columns, values, rcond=None)[0]
    high = max(float(np.sum((values - columns @ plain) ** 2)), float(np.min(deviations)) ** 2)
    while excess(high) > 0.0:
        high *= 4.0
    return float(optimize.brentq(excess, 0.0, high, xtol=1e-9 * high, rtol=1e-9))


def _weighted(columns: Signal, values: Signal, weights: Signal) -> tuple[Signal, Signal, float]:
    """Inverse of the normal matrix, coefficients, and the weighted squares of what remains."""
    root = np.sqrt(weights)
    sizes = np.maximum(np.linalg.norm(columns * root[:, None], axis=0), 1e-300)
    _, lengths, directions = np.linalg.svd(columns * root[:, None] / sizes, full_matrices=False)
    scaled = directions / lengths[:, None]
    inverse = scaled.T @ scaled / np.outer(sizes, sizes)
    coefficients = inverse @ (columns.T @ (weights * values))
    remainder = values - columns @ coefficients
    return inverse, coefficients, float(np.sum(weights * remainder**2))


def _scaled(columns: Signal) -> Signal:
    return np.asarray(columns / np.maximum(np.linalg.norm(columns, axis=0), 1e-300))
