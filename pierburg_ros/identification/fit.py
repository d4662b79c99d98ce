"""Fits of an actuator's parameters to whole recordings, by a simulation that is pulled to them ever more weakly."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.errors import InputError
from pierburg_ros.inference.balance import Balance, balance_of
from pierburg_ros.inference.coordinates import in_order
from pierburg_ros.inference.covariance import Covariance, at_least_effective
from pierburg_ros.inference.data import Data, all_fitted
from pierburg_ros.inference.evidence import EXPLAINED, rms
from pierburg_ros.inference.explanation import Explanation
from pierburg_ros.inference.fit import Fit, Fitter, rungs
from pierburg_ros.inference.intervals import by_run, slopes_at
from pierburg_ros.inference.polish import polished
from pierburg_ros.inference.shortlist import balanced
from pierburg_ros.plant import Model
from pierburg_ros.recording import Recording
from pierburg_ros.workers import workers

FEWEST_MOMENTS = 20
"""Moments of motion for each parameter from which a balance gives a start. Derived: neighbouring moments share most of
a window, so that these are some five independent ones."""


@dataclass(frozen=True)
class Identified:
    """A fitted model with the uncertainty of its free parameters.

    `covariance` and `slopes`, shape (samples, names), are for the coordinates of the search: relative changes for
    positive base parameters. `slopes` are in units of the noise. `per_unit` is one unit of the sensor in the unit of
    the recordings, 1 but for an angle recorded in the place of a Hall voltage.
    """

    fit: Fit
    covariance: Covariance
    slopes: Signal
    per_unit: float

    @property
    def fitter(self) -> Fitter:
        """What made the fit."""
        return self.fit.fitter

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
    def unit(self) -> float:
        """The noise in the measured unit."""
        return self.fitter.data.noise * abs(self.per_unit)

    @property
    def noise(self) -> float:
        """Standard deviation of the residual, in the measured unit, with the degrees of freedom of the fit."""
        return self.covariance.noise * self.unit

    @cached_property
    def residuals(self) -> tuple[Signal, ...]:
        """Measured minus simulated, one array for each run, in the measured unit.

        The simulation is that of a replay: it runs free where the actuator forgets its beginning.
        """
        data = self.fitter.data
        return tuple(data.by_run(self.fitter.replaying.residual(self.model) * data.noise * self.per_unit))

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
        coordinates = self.fitter.coordinates(self.fit.explanation)
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


def fit(model: Model, recordings: Sequence[Recording], free: Sequence[str], jobs: int | None = None) -> Identified:
    """Fit the parameters `free` (dotted names) of `model` to `recordings`; the others stay as they are.

    One fit starts from `model` itself, one from the balance of torques along the motion; `jobs` fits run at a time.
    """
    if not free:
        raise InputError("There is no free parameter to fit; expected one or more. Free one.")
    fitter = fitter_of(recordings, model)
    starts = [model.values, *balanced_starts(fitter, free)]
    with workers(jobs) as pool:
        found = list(pool.map(lambda start: climbed(fitter, Explanation(tuple(free)), start), starts))
    return identified(min(found, key=lambda each: each.chi2), recordings)


def fitter_of(recordings: Sequence[Recording], model: Model) -> Fitter:
    """What fits `model` to all samples of `recordings`, with the strongest pull."""
    data = all_fitted(recordings, model)
    return Fitter(data, model, constants(data, model)[0])


def constants(data: Data, model: Model) -> tuple[float, ...]:
    """The time constants of the pull [s], one after the other, for what `model` is, whatever its description says."""
    numbers = data.actuator.parameters
    own = {name: replace(each, default=model.values[name]) for name, each in numbers.items()}
    return rungs(replace(data.actuator, parameters=own), data.period)


def climbed(fitter: Fitter, explanation: Explanation, values: dict[str, float]) -> Fit:
    """The fit of an explanation from some `values`, pulled ever more weakly.

    Where only noise is left then, and the actuator forgets its beginning, a last fit runs free: it is the most precise.
    """
    first, *others = constants(fitter.data, fitter.nominal)
    found = fitter.pulled(first).fit(explanation, values)
    for constant in others:
        found = fitter.pulled(constant).fit(explanation, found.values)
    if found.ratio > EXPLAINED or not fitter.data.actuator.forgets:
        return found
    free = polished(fitter.pulled(math.inf).fit(explanation, found.values))
    return free if free.ratio <= EXPLAINED else found


def balanced_starts(fitter: Fitter, free: Sequence[str]) -> list[dict[str, float]]:
    """The values with which torques balance along the motion of the recordings; none where these tell too little."""
    nominal, balance = fitter.nominal, own_balance(fitter)
    if balance.size < FEWEST_MOMENTS * len(free):
        return []
    values, _ = balanced(balance, nominal, free, nominal.values, nominal.active_effects)
    return [in_order(values, nominal)]


def own_balance(fitter: Fitter) -> Balance:
    """The balance along the motion of all recordings."""
    return balance_of(fitter.data, fitter.nominal, constants(fitter.data, fitter.nominal)[0])


def identified(found: Fit, recordings: Sequence[Recording]) -> Identified:
    """A fit with the uncertainty of its values."""
    slopes, data = slopes_at(found, found.explanation), found.fitter.data
    turned = recordings[0].quantity == "position" and data.actuator.quantity == "hall_voltage"
    return Identified(found, at_least_effective(slopes, by_run(found)), slopes, data.per_unit if turned else 1.0)
