"""Bounded Levenberg-Marquardt for simulations, which have rough costs, few parameters and many samples."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from pierburg_ros.arrays import Flags, Signal

Residual = Callable[[Signal], Signal]

FULL = 25
"""Number of iterations after which a descent that still gains ends. Work: n = 148 descents took 15 simulations each on
average, slopes but the last included, and 145 ended within 2 % of the lowest; after 6 iterations it is 14 and 144."""
BRIEF = 8
"""Iterations of a descent that is one of several to choose from; half as many where it starts near its end. Work: a
descent that is worth more is continued; not varied."""
TOLERANCE = 1e-4
"""Share of the cost by which an iteration must lower it for a descent to go on. Derived: for the 22,500 training
samples of a minute it is 2 of chi2, about what chance gives one quantity."""
KEPT_SLOPES = 0.25
"""Share of the predicted decrease of the cost from which a step's slopes also serve for the next one. Measured: n = 188
descents to 42 trials (seeds 31 and 32). With 0, 0.25, 0.5 and 0.75 they take 2,304, 2,244, 2,297 and 2,326 simulations,
and 185, 184, 184 and 184 of them end within 2 % of the lowest. With new slopes for each step it is 2,995 and 182."""
SMALLEST_DAMPING = 1e-9
"""Smallest damping of a step. Derived: far above rounding, so that quantities with the same slopes, or without, can be
solved for."""
REJECTED = 6
"""Number of steps that may fail to lower the cost before a descent ends. Derived: the damping has then grown by 8 x 16
x ... x 256, almost 1e10, and the step has shrunk as much."""


@dataclass(frozen=True)
class _Place:
    """A point and the residual there."""

    point: Signal
    value: Signal

    @cached_property
    def cost(self) -> float:
        """Sum of squared residuals."""
        return float(self.value @ self.value)


@dataclass(frozen=True)
class _Tangent:
    """The linear prediction from slopes at a place; `normal` is slopes' slopes, `gradient` slopes' residual."""

    place: _Place
    slopes: Signal
    normal: Signal
    gradient: Signal

    @staticmethod
    def at(place: _Place, slopes: Signal) -> _Tangent:
        """The linear prediction with these `slopes`, shape (samples, quantities)."""
        return _Tangent(place, slopes, slopes.T @ slopes, slopes.T @ place.value)

    def fall(self, point: Signal) -> float:
        """The predicted decrease of the cost at a `point`."""
        move = point - self.place.point
        return float(-(2.0 * self.gradient + self.normal @ move) @ move)

    def corrected(self, there: _Place) -> _Tangent:
        """The prediction from another place, with slopes changed as little as can be to match it (Broyden's update)."""
        move = there.point - self.place.point
        missed = there.value - self.place.value - self.slopes @ move
        unit = move / max(float(move @ move), 1e-300)
        cross = np.outer(self.slopes.T @ missed, unit)
        normal = self.normal + cross + cross.T + float(missed @ missed) * np.outer(unit, unit)
        slopes = self.slopes + np.outer(missed, unit)
        return _Tangent(there, slopes, normal, slopes.T @ there.value)


@dataclass(frozen=True)
class Solution:
    """The end of a descent: the point and the residual there."""

    point: Signal
    residual: Signal
    slope: Callable[[], Signal] = field(repr=False, compare=False)

    def __getstate__(self) -> dict[str, Any]:
        """For copies: the slopes in place of what computes them."""
        return {"point": self.point, "residual": self.residual, "jacobian": self.jacobian}

    @property
    def cost(self) -> float:
        """Sum of squared residuals."""
        return float(self.residual @ self.residual)

    @cached_property
    def jacobian(self) -> Signal:
        """Derivative of the residual at the point, shape (samples, quantities); computed at its first use."""
        return self.slope()

    @cached_property
    def basis(self) -> Signal:
        """Orthonormal basis of what small moves from the point do to the residual, shape (samples, quantities)."""
        return np.asarray(np.linalg.qr(self.jacobian)[0])


def minimise(
    residual: Residual,
    start: Signal,
    lower: Signal,
    upper: Signal,
    step: Signal,
    iterations: int = FULL,
    tolerance: float = TOLERANCE,
) -> Solution:
    """Least squares of `residual` within bounds from `start`; finite differences of size `step`.

    Quantities whose bounds coincide stay where they are. Each iteration takes slopes by differences. It goes on with
    them, corrected after each step, while the cost falls (the secant version of Levenberg-Marquardt: Madsen, Nielsen,
    Tingleff, Methods for non-linear least squares problems, 2004, section 3.4). The descent ends after so many
    `iterations`, or when one lowers the cost by less than `tolerance` of it. It also ends after a last step if the
    slopes predict no more than that, and when no step lowers the cost. The damping is Marquardt's: relative to the
    curvature of each quantity. It is divided by five after a step that lowers the cost, and multiplied faster and
    faster while steps do not.
    """
    free = upper > lower

    def slope(at: _Place) -> Signal:
        return jacobian(residual, at.point, at.value, lower, upper, step)

    def aim(line: _Tangent, damping: float) -> Signal:
        return _step(line, lower, upper, free, damping)

    def moved(point: Signal) -> _Place:
        return _Place(point, residual(point))

    at, damping = moved(np.clip(start, lower, upper)), 1e-3
    for _ in range(iterations if free.any() else 0):
        line, growth, before = _Tangent.at(at, slope(at)), 8.0, at.cost
        last = aim(line, SMALLEST_DAMPING)
        if 0.0 <= line.fall(last) <= tolerance * before:
            at = min(at, moved(last), key=lambda each: each.cost)
            break
        for _ in range(REJECTED):
            there = moved(aim(line, damping))
            if there.cost < at.cost:
                break
            damping, growth = damping * growth, growth * 2.0
        while there.cost < at.cost:
            follows = at.cost - there.cost >= KEPT_SLOPES * line.fall(there.point)
            line, at, damping = line.corrected(there), there, max(damping * 0.2, SMALLEST_DAMPING)
            if not follows or line.fall(aim(line, SMALLEST_DAMPING)) <= tolerance * at.cost:
                break
            there = moved(aim(line, damping))
        if before - at.cost <= tolerance * before:
            break
    return Solution(at.point, at.value, lambda: slope(at))


def beside(values: Signal, basis: Signal) -> Signal:
    """What an orthonormal `basis`, shape (samples, vectors), leaves of values or columns, shape (samples, ...)."""
    return np.asarray(values - basis @ (basis.T @ values))


def jacobian(residual: Residual, point: Signal, value: Signal, lower: Signal, upper: Signal, step: Signal) -> Signal:
    """Derivative of `residual`, which is `value` at `point`, by one-sided differences; shape (samples, quantities).

    The differences point away from a bound.
    """
    if point.size == 0:
        return np.zeros((value.size, 0))
    signed = np.where(point + step <= upper, step, -step)

    def column(place: int) -> Signal:
        if upper[place] <= lower[place]:
            return np.zeros(value.size)
        moved = point.copy()
        moved[place] += signed[place]
        return np.asarray((residual(moved) - value) / signed[place])

    return np.asarray(np.nan_to_num(np.stack(list(map(column, range(point.size))), axis=1)))


def _step(line: _Tangent, lower: Signal, upper: Signal, free: Flags, damping: float) -> Signal:
    """The point after a damped Gauss-Newton step; without a quantity that a bound stops, the rest is solved again."""
    normal, gradient, point = line.normal, line.gradient, line.place.point
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
