"""Bounded least squares of the simulated against the measured quantity, over whole recordings."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import optimize

from pierburg_ros.arrays import Signal
from pierburg_ros.errors import InputError
from pierburg_ros.estimation.problem import COARSE_STEP, FINE_STEP, Problem
from pierburg_ros.estimation.scaling import Scaling
from pierburg_ros.estimation.uncertainty import RANK, Uncertainty, uncertainty
from pierburg_ros.plant import Model
from pierburg_ros.recording.noise import noise_of
from pierburg_ros.recording.recording import Recording

GOOD = 1.1
"""A fit whose RMSE is below this multiple of the noise needs no second start."""
COARSE_TOLERANCE = 1e-3
"""Relative change of the cost at which the wide difference steps have done their part."""
ROUGH = 1e-3
"""Share of the cost that one more linear step promises and did not deliver: the cost is rough there."""
SPREAD = 0.4
"""Standard deviation of further starts, in scaled coordinates: 40 % of a positive parameter."""


@dataclass(frozen=True)
class Fit:
    """A fitted model with what is known of its free parameters.

    `residuals` [measured unit], measured less simulated, one array a recording; `jacobian` of the residual to
    the scaled coordinates (relative change for positive parameters), shape (samples, names).
    """

    model: Model
    names: tuple[str, ...]
    scaling: Scaling
    coordinates: Signal
    residuals: tuple[Signal, ...]
    jacobian: Signal
    uncertainty: Uncertainty
    evaluations: int

    @property
    def rmse(self) -> float:
        """Root mean square of all residuals, in the measured unit."""
        return float(np.sqrt(np.mean(np.concatenate(self.residuals) ** 2)))

    @property
    def values(self) -> dict[str, float]:
        """The fitted values of the free parameters."""
        return {name: self.model.values[name] for name in self.names}

    @property
    def covariance(self) -> Signal:
        """Covariance of the fitted values, in their units, shape (names, names)."""
        slope = self.scaling.slope(self.coordinates)
        return np.asarray(slope @ self.uncertainty.covariance @ slope.T)

    @property
    def deviation(self) -> Signal:
        """Standard deviation of each scaled coordinate (relative where positive), shape (names,)."""
        return np.asarray(np.sqrt(np.diagonal(self.uncertainty.covariance)))

    @property
    def ci95(self) -> dict[str, tuple[float, float]]:
        """95 % intervals, in the parameters' units; the whole range where nothing is known."""
        half = self.uncertainty.factor * np.sqrt(np.diagonal(self.covariance))
        half = np.where(self.uncertainty.undetermined, np.inf, half)
        intervals = {}
        for index, (name, value) in enumerate(self.values.items()):
            minimum, maximum = self.model.range(name)
            if self.scaling.relative[index] and value > 0.0:
                factor = math.exp(min(half[index] / value, 700.0))
                low, high = value / factor, value * factor
            else:
                low, high = value - half[index], value + half[index]
            intervals[name] = (float(max(low, minimum)), float(min(high, maximum)))
        return intervals

    @property
    def correlation(self) -> Signal:
        """Correlation of the fitted parameters, shape (names, names)."""
        spread = np.where(self.deviation > 0.0, self.deviation, 1.0)
        return np.asarray(self.uncertainty.covariance / np.outer(spread, spread))


def fit(
    model: Model,
    recordings: Sequence[Recording],
    free: Sequence[str],
    *,
    starts: int = 3,
    simplex: bool = True,
    tolerance: float = 1e-7,
    seed: int = 0,
    threads: int | None = None,
) -> Fit:
    """Fit the parameters `free` (flat dotted names) of `model` to `recordings`; the others stay as they are.

    The first start is `model` itself; while the RMSE stays above the noise, up to `starts` are tried, the
    further ones chosen among random points. Where the cost is too rough for its slope and `simplex` is true,
    a derivative-free search goes on from there.
    """
    if not free:
        raise InputError("There is no free parameter to fit; expected one or more. Free one.")
    problem = Problem(recordings, Scaling.of(model, free), threads)
    noise = float(np.sqrt(np.mean([noise_of(recording.time, recording.measured) ** 2 for recording in recordings])))
    goal = GOOD * noise * np.sqrt(problem.measured.size)
    best = _descend(problem, np.zeros(len(free)), tolerance, simplex)
    for start in _further_starts(problem, starts - 1, seed):
        if np.linalg.norm(problem.residual(best)) <= goal:
            break
        other = _descend(problem, start, tolerance, simplex)
        best = min(best, other, key=lambda point: float(np.linalg.norm(problem.residual(point))))
    return evaluate(problem, best)


def evaluate(problem: Problem, coordinates: Signal) -> Fit:
    """The fit that stands at `coordinates`, with its Jacobian and uncertainty."""
    residual = problem.residual(coordinates)
    jacobian = problem.sharp_jacobian(coordinates)
    residuals = problem.parts(residual)
    return Fit(
        problem.scaling.model(coordinates),
        problem.scaling.names,
        problem.scaling,
        coordinates,
        residuals,
        jacobian,
        uncertainty(jacobian, residuals),
        problem.evaluations,
    )


def _descend(problem: Problem, start: Signal, tolerance: float, simplex: bool) -> Signal:
    """Coordinates of a minimum near `start`: wide difference steps first, then as fine as noise allows."""
    point = _least_squares(problem, start, max(tolerance, COARSE_TOLERANCE), COARSE_STEP)
    point = _least_squares(problem, point, tolerance, FINE_STEP)
    if not simplex or not _is_rough(problem, point):
        return point
    return _least_squares(problem, _simplex(problem, point), tolerance, FINE_STEP)


def _least_squares(problem: Problem, start: Signal, tolerance: float, step: float) -> Signal:
    lower, upper = problem.scaling.lower, problem.scaling.upper
    margin = 1e-9 * (upper - lower)
    solution = optimize.least_squares(
        problem.residual,
        np.clip(start, lower + margin, upper - margin),
        lambda point: problem.jacobian(point, step),
        (lower, upper),
        ftol=tolerance,
        xtol=1e-9,
        gtol=1e-12,
        max_nfev=30,
    )
    return np.asarray(solution.x)


def _is_rough(problem: Problem, point: Signal) -> bool:
    """Whether the slope at `point` promises a reduction that the descent did not find."""
    residual, jacobian = problem.residual(point), problem.jacobian(point, FINE_STEP)
    inside = (point > problem.scaling.lower + 1e-6) & (point < problem.scaling.upper - 1e-6)
    if not inside.any():
        return False
    change = np.linalg.lstsq(jacobian[:, inside], residual, rcond=RANK)[0]
    promised = float(np.sum((jacobian[:, inside] @ change) ** 2))
    return promised > ROUGH * float(residual @ residual)


def _simplex(problem: Problem, point: Signal) -> Signal:
    """The lowest point that a derivative-free search finds around `point`."""
    search = optimize.minimize(
        lambda other: float(np.sum(problem.residual(other) ** 2)),
        point,
        method="Nelder-Mead",
        bounds=list(zip(problem.scaling.lower, problem.scaling.upper, strict=True)),
        options={
            "maxfev": 40 * point.size,
            "initial_simplex": np.vstack([point, point + 0.02 * np.eye(point.size)]),
            "xatol": 1e-5,
            "fatol": 0.0,
        },
    )
    return np.asarray(search.x)


def _further_starts(problem: Problem, count: int, seed: int) -> list[Signal]:
    """The `count` best of random starts, best first; none are drawn where none are wanted."""
    if count <= 0:
        return []
    random = np.random.default_rng(seed)
    points = SPREAD * random.standard_normal((4 * count, len(problem.scaling.names)))
    points = np.clip(points, problem.scaling.lower, problem.scaling.upper)
    costs = np.sum(problem.residuals(list(points)) ** 2, axis=1)
    return [points[index] for index in np.argsort(costs)[:count]]
