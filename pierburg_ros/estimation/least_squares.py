"""Bounded Levenberg-Marquardt for simulations: rough costs, few parameters, many samples."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from pierburg_ros.arrays import Signal

Residual = Callable[[Signal], Signal]


@dataclass(frozen=True)
class Solution:
    """Where the search ended: point, residual there, its Jacobian, half the sum of squares, evaluations used."""

    point: Signal
    residual: Signal
    jacobian: Signal
    evaluations: int

    @property
    def cost(self) -> float:
        """Sum of squared residuals."""
        return float(self.residual @ self.residual)


def minimise(
    residual: Residual,
    start: Signal,
    lower: Signal,
    upper: Signal,
    step: Signal,
    iterations: int = 25,
    tolerance: float = 1e-4,
) -> Solution:
    """Least squares of `residual` within bounds from `start`; finite differences of size `step`.

    Ends when an iteration lowers the cost by less than `tolerance` of it or nothing lowers it. Nielsen's damping
    (Madsen, Nielsen, Tingleff, Methods for Non-linear Least Squares Problems, 2nd ed. 2004).
    """
    point = np.clip(start, lower, upper)
    value = residual(point)
    cost, damping, growth, evaluations = float(value @ value), 1e-3, 2.0, 1
    if point.size == 0:
        return Solution(point, value, np.zeros((value.size, 0)), 1)
    jacobian = _jacobian(residual, point, value, lower, upper, step)
    for iteration in range(iterations):
        if iteration > 0:
            jacobian = _jacobian(residual, point, value, lower, upper, step)
        evaluations += point.size
        improved = False
        for _ in range(6):
            trial = _step(jacobian, value, point, lower, upper, damping)
            there = residual(trial)
            evaluations += 1
            after = float(there @ there)
            if np.isfinite(after) and after < cost:
                improved = True
                damping, growth = max(damping * 0.2, 1e-9), 2.0
                break
            damping, growth = damping * growth * 4.0, growth * 2.0
        if not improved:
            break
        gain = (cost - after) / max(cost, 1e-30)
        point, value, cost = trial, there, after
        if gain < tolerance:
            break
    return Solution(point, value, jacobian, evaluations)


def _jacobian(residual: Residual, point: Signal, value: Signal, lower: Signal, upper: Signal, step: Signal) -> Signal:
    signed = np.where(point + step <= upper, step, -step)
    points = [point + signed[i] * np.eye(point.size)[i] for i in range(point.size)]
    columns = [(there - value) / signed[i] for i, there in enumerate(map(residual, points))]
    return np.asarray(np.nan_to_num(np.stack(columns, axis=1)))


def _step(jacobian: Signal, value: Signal, point: Signal, lower: Signal, upper: Signal, damping: float) -> Signal:
    """Damped Gauss-Newton step; a parameter that a bound stops is left out and the rest solved again."""
    normal, gradient = jacobian.T @ jacobian, jacobian.T @ value
    free = np.ones(point.size, dtype=bool)
    trial = point.copy()
    for _ in range(point.size):
        inner = normal[np.ix_(free, free)]
        scale = np.diag(inner) + 1e-12 * max(float(np.max(np.diag(normal))), 1e-300)
        move = np.linalg.solve(inner + np.diag(damping * scale), -gradient[free])
        trial = point.copy()
        trial[free] += move
        blocked = free & (((trial < lower) & (point <= lower)) | ((trial > upper) & (point >= upper)))
        if not blocked.any():
            break
        free &= ~blocked
        if not free.any():
            return np.array(point)
    return np.asarray(np.clip(trial, lower, upper))
