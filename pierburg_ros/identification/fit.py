"""Fits of an actuator's parameters to whole recordings, from several starts, as exact as the noise allows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.errors import InputError
from pierburg_ros.estimation.data import data_of, rms
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.estimation.intervals import covariance
from pierburg_ros.estimation.likelihood import EXPLAINED
from pierburg_ros.estimation.refinement import COARSEST, refined
from pierburg_ros.inference.slopes import FINE
from pierburg_ros.inference.covariance import RANK, Covariance
from pierburg_ros.inference.explanation import Explanation
from pierburg_ros.plant import Model
from pierburg_ros.recording.recording import Recording
from pierburg_ros.workers import workers

ITERATIONS = 30
"""Number of iterations after which a descent that still gains ends. Work: it bounds a fit that continues only for a
tolerance of 1e-7; not varied."""
NOTICEABLE = 1e-3
"""Share of the cost below which a gain no longer counts. A descent with wide differences then ends; a cost is rough
where one more linear step predicts a larger gain. Derived: in 30,000 samples chance alone changes the cost by 0.8 %,
one parameter by 3e-5."""
SPREAD = 0.4
"""Standard deviation of further starts, in coordinates: 40 % of a positive parameter. Chosen: about what a parameter of
another specimen may differ by; not varied."""


@dataclass(frozen=True)
class Identified:
    """A fitted model with the uncertainty of its free parameters.

    `covariance` and `slopes`, shape (samples, names), are for the coordinates of the search: relative changes for
    positive base parameters. `slopes` are in units of the noise.
    """

    estimator: Estimator
    fit: Fit
    covariance: Covariance
    slopes: Signal

    @property
    def model(self) -> Model:
        """The fitted model."""
        return self.fit.model

    @property
    def names(self) -> tuple[str, ...]:
        """Dotted names of the free parameters."""
        return self.fit.explanation.names

    @property
    def values(self) -> dict[str, float]:
        """The fitted values of the free parameters."""
        return {name: self.fit.values[name] for name in self.names}

    @property
    def noise(self) -> float:
        """Standard deviation of the residual, in the measured unit, with the degrees of freedom of the fit."""
        return self.covariance.noise * self.estimator.data.noise

    @cached_property
    def residuals(self) -> tuple[Signal, ...]:
        """Measured minus simulated, one array for each run, in the measured unit."""
        lengths = [run.time.size for run in self.estimator.data.runs]
        return tuple(np.split(self.fit.solution.residual * self.estimator.data.noise, np.cumsum(lengths)[:-1]))

    @property
    def rmse(self) -> float:
        """Root mean square of all residuals, in the measured unit."""
        return rms(np.concatenate(self.residuals))

    @property
    def deviation(self) -> Signal:
        """Standard deviation of each coordinate (relative where positive), shape (names,)."""
        return np.asarray(np.sqrt(np.diagonal(self.covariance.matrix)))

    @cached_property
    def ci95(self) -> dict[str, tuple[float, float]]:
        """95 % intervals, in the parameters' units; the whole range where nothing is known."""
        coordinates = self.estimator.coordinates(self.fit.explanation)
        reach = np.diag(self.covariance.factor * self.deviation)
        ends = [
            (coordinates.values(self.fit.solution.point - move), coordinates.values(self.fit.solution.point + move))
            for move in reach
        ]
        return {
            name: self.model.range(name) if unknown else (low[name], high[name])
            for name, unknown, (low, high) in zip(self.names, self.covariance.undetermined, ends, strict=True)
        }

    @property
    def correlation(self) -> Signal:
        """Correlation of the fitted parameters, shape (names, names)."""
        spread = np.where(self.deviation > 0.0, self.deviation, 1.0)
        return np.asarray(self.covariance.matrix / np.outer(spread, spread))


def fit(
    model: Model,
    recordings: Sequence[Recording],
    free: Sequence[str],
    *,
    starts: int = 3,
    refine: bool = True,
    tolerance: float = 1e-7,
    seed: int = 0,
    jobs: int | None = None,
) -> Identified:
    """Fit the parameters `free` (dotted names) of `model` to `recordings`; the others stay as they are.

    The first start is `model` itself. While the RMSE stays above the noise, up to `starts` are tried; the further ones
    are chosen among random points. Where the cost is too rough for its slope and `refine` is true, the fit searches for
    other local minima from there. `jobs` simulations run at a time, by default one for each core.
    """
    if not free:
        raise InputError("There is no free parameter to fit; expected one or more. Free one.")
    with workers(jobs) as pool:
        estimator = Estimator(data_of(recordings, model), model, pool.map)
        return _fitted(estimator, Explanation(tuple(free)), starts, refine, tolerance, seed)


def _fitted(
    estimator: Estimator, explanation: Explanation, starts: int, refine: bool, tolerance: float, seed: int
) -> Identified:
    best = _descend(estimator, estimator.at(explanation), tolerance, refine)
    for start in _further_starts(estimator, explanation, starts - 1, seed):
        if best.ratio <= EXPLAINED:
            break
        best = min(best, _descend(estimator, start, tolerance, refine), key=lambda fit: fit.chi2)
    known, slopes = covariance(estimator, best)
    return Identified(Estimator(estimator.data, estimator.nominal), best, known, slopes)


def _descend(estimator: Estimator, start: Fit, tolerance: float, refine: bool) -> Fit:
    """A minimum near `start`: wide differences first, to look across stick and slip, then as fine as noise allows."""
    coordinates = estimator.coordinates(start.explanation)
    wide, fine = COARSEST * coordinates.steps, np.full(coordinates.steps.size, FINE)

    def descended(fit: Fit, steps: Signal, until: float) -> Fit:
        return estimator.fit(fit.explanation, fit.values, ITERATIONS, steps=steps, tolerance=until)

    found = descended(descended(start, wide, max(tolerance, NOTICEABLE)), fine, tolerance)
    if refine and _is_rough(found, *coordinates.bounds):
        found = descended(refined(estimator, found), fine, tolerance)
    return found


def _is_rough(fit: Fit, lower: Signal, upper: Signal) -> bool:
    """Whether the slope at a fit predicts a reduction that the descent did not find."""
    point, residual, slopes = fit.solution.point, fit.solution.residual, fit.solution.jacobian
    inside = (point > lower + 1e-6) & (point < upper - 1e-6)
    if not inside.any():
        return False
    change = np.linalg.lstsq(slopes[:, inside], residual, rcond=RANK)[0]
    return bool(np.sum((slopes[:, inside] @ change) ** 2) > NOTICEABLE * fit.chi2)


def _further_starts(estimator: Estimator, explanation: Explanation, count: int, seed: int) -> list[Fit]:
    """The `count` best of random starts, best first; empty where `count` is not positive."""
    if count <= 0:
        return []
    coordinates = estimator.coordinates(explanation)
    middle = coordinates.point(estimator.nominal.values)
    points = middle + SPREAD * np.random.default_rng(seed).standard_normal((4 * count, middle.size))
    fits = [estimator.at(explanation, coordinates.values(np.clip(point, *coordinates.bounds))) for point in points]
    return sorted(fits, key=lambda fit: fit.chi2)[:count]
