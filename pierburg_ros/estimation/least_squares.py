"""Bounded Levenberg-Marquardt for simulations: rough costs, few parameters, many samples."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from pierburg_ros.arrays import Flags, Signal

Residual = Callable[[Signal], Signal]
Map = Callable[..., Iterable[Any]]

FULL = 25
"""Iterations after which a descent ends that still gains. Work: 68 descents of an effect to a trial took 18
simulations each on average, slopes but the last included, so few come near it (`docs/benchmarks.md`)."""
BRIEF = 8
"""Iterations of a descent that is one of several to choose from; half as many where it starts beside its end. Work: a
descent that is worth more is carried on; not varied."""
AS_FORESEEN = 0.9
"""Share of the foreseen fall of the cost from which slopes from elsewhere serve for a step. Measured: static friction
that the Coulomb friction can stand for gave 0.81 with slopes from where there is none, and led astray (n = 1)."""
TOLERANCE = 1e-4
"""Share of the cost that an iteration has to lower it by for a descent to go on. Derived: of the 22,500
samples that train in a minute it is 2 of chi2, about what chance gives one quantity."""
LIGHTEST = 1e-9
"""Least damping of a step. Derived: far above rounding, so that quantities with the same slopes, or without, can be
solved for."""
REJECTED = 6
"""Steps that may fail to lower the cost before a descent ends. Derived: the damping has then grown by 8 x 16 x ... x
256, almost 1e10, and the step shrunk as much."""


@dataclass(frozen=True)
class Solution:
    """Where a descent ended: the point and the residual there."""

    point: Signal
    residual: Signal
    slope: Callable[[], Signal] = field(repr=False, compare=False)

    @property
    def cost(self) -> float:
        """Sum of squared residuals."""
        return float(self.residual @ self.residual)

    @cached_property
    def jacobian(self) -> Signal:
        """Derivative of the residual at the point, shape (samples, quantities); taken when first asked for."""
        return self.slope()


def minimise(
    residual: Residual,
    start: Signal,
    lower: Signal,
    upper: Signal,
    step: Signal,
    iterations: int = FULL,
    tolerance: float = TOLERANCE,
    over: Map = map,
    slopes: Signal | None = None,
    enough: float = -np.inf,
) -> Solution:
    """Least squares of `residual` within bounds from `start`; finite differences of size `step`.

    Quantities whose bounds coincide stay where they are. Ends after so many `iterations`, or when one lowers the cost
    by less than `tolerance` of it, or nothing lowers it. The damping is Marquardt's: relative to the curvature of each
    quantity, divided by five after a step that lowers the cost, multiplied faster and faster while steps do not.
    `over` maps a function over the columns of a Jacobian, on several cores or on one. Known `slopes` from nearby make
    the first steps, while the cost falls as they foresee. It ends, too, where the cost is `enough`.
    """
    free = upper > lower

    def slope(point: Signal, value: Signal) -> Signal:
        return jacobian(residual, point, value, lower, upper, step, over)

    point = np.clip(start, lower, upper)
    value = residual(point)
    if slopes is not None:
        point, value = _foreseen(residual, slopes, point, value, lower, upper, free, tolerance, enough)
    cost, damping = float(value @ value), 1e-3
    for _ in range(iterations if free.any() else 0):
        if cost <= enough:
            break
        slopes, growth, before = slope(point, value), 8.0, cost
        for _ in range(REJECTED):
            trial = _step(slopes, value, point, lower, upper, free, damping)
            there = residual(trial)
            after = float(there @ there)
            if after < cost:
                point, value, cost, damping = trial, there, after, max(damping * 0.2, LIGHTEST)
                break
            damping, growth = damping * growth, growth * 2.0
        if before - cost <= tolerance * before:
            break
    return Solution(point, value, lambda: slope(point, value))


def jacobian(
    residual: Residual, point: Signal, value: Signal, lower: Signal, upper: Signal, step: Signal, over: Map = map
) -> Signal:
    """Derivative of `residual` at `point`, where it is `value`, by one-sided differences away from a bound."""
    if point.size == 0:
        return np.zeros((value.size, 0))
    signed = np.where(point + step <= upper, step, -step)

    def column(place: int) -> Signal:
        if upper[place] <= lower[place]:
            return np.zeros(value.size)
        moved = point.copy()
        moved[place] += signed[place]
        return np.asarray((residual(moved) - value) / signed[place])

    return np.asarray(np.nan_to_num(np.stack(list(over(column, range(point.size))), axis=1)))


def _foreseen(
    residual: Residual,
    slopes: Signal,
    point: Signal,
    value: Signal,
    lower: Signal,
    upper: Signal,
    free: Flags,
    tolerance: float,
    enough: float,
) -> tuple[Signal, Signal]:
    """Where steps with the same slopes lead while the cost falls as they foresee (the simplified Newton method)."""
    while (cost := float(value @ value)) > enough:
        trial = _step(slopes, value, point, lower, upper, free, LIGHTEST)
        foreseen = value + slopes @ (trial - point)
        fall = cost - float(foreseen @ foreseen)
        if fall <= tolerance * cost:
            break
        there = residual(trial)
        if cost - float(there @ there) < AS_FORESEEN * fall:
            break
        point, value = trial, there
    return point, value


def _step(
    slopes: Signal, value: Signal, point: Signal, lower: Signal, upper: Signal, free: Flags, damping: float
) -> Signal:
    """Where a damped Gauss-Newton step leads; a quantity that a bound stops is left out and the rest solved again."""
    normal, gradient = slopes.T @ slopes, slopes.T @ value
    while free.any():
        inner = normal[np.ix_(free, free)]
        scale = np.diag(inner) + 1e-12 * max(float(np.max(np.diag(normal))), 1e-300)
        trial = point.copy()
        trial[free] -= np.linalg.solve(inner + np.diag(damping * scale), gradient[free])
        blocked = free & (((trial < lower) & (point <= lower)) | ((trial > upper) & (point >= upper)))
        if not blocked.any():
            return np.asarray(np.clip(trial, lower, upper))
        free = free & ~blocked
    return np.array(point)
