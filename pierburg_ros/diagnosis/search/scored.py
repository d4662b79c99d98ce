"""How likely a fit makes the recordings when what it leaves is part of the likelihood."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.discrepancy import Discrepancy, Kalman, evidence
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.estimation.least_squares import BRIEF
from pierburg_ros.plant import Model


@dataclass(frozen=True)
class Scored:
    """A fit with the most likely discrepancy beside it, and `cost`: minus twice the log likelihood of the two.

    `unseen` is the same of the samples that validate, when those that train are known, with the discrepancy that is
    most likely on both: what remains there may be larger. `errors` are the mean squares [noise^2] of the residual on
    those that train and on those that validate.
    """

    fit: Fit
    discrepancy: Discrepancy
    cost: float
    unseen: float = 0.0
    errors: tuple[float, float] = (0.0, 0.0)

    def explains(self, without: Scored) -> float:
        """By which share the mean square of the error is smaller than `without` what this fit has more.

        On samples that train or on those that validate, whichever gain less.
        """
        pairs = zip(self.errors, without.errors, strict=True)
        return 1.0 - max(own / max(other, 1e-300) for own, other in pairs)

    @property
    def left(self) -> float:
        """How much less likely the residual is than white noise of the sensor's size, in -2 log likelihood."""
        return self.cost - self.fit.solution.residual.size


def scored(data: Data, fit: Fit) -> Scored:
    """`fit` as it is, with its most likely discrepancy."""
    kalman = Kalman(data, data.train)
    residual = data.residual(fit.model, fit.switch)
    discrepancy = kalman.most_likely(residual)
    cost = evidence(kalman.filtered(discrepancy), residual)
    both = Kalman(data, data.train | data.validation)
    larger = both.most_likely(residual)
    unseen = evidence(both.filtered(larger), residual) - evidence(kalman.filtered(larger), residual)
    errors = _mean_square(residual[data.train]), _mean_square(residual[data.validation])
    return Scored(fit, discrepancy, cost, unseen, errors)


def _mean_square(residual: Signal) -> float:
    """Mean square of a residual, 0 where there are no samples."""
    return float(np.mean(np.square(residual))) if residual.size else 0.0


def settled(data: Data, nominal: Model, fit: Fit) -> Scored:
    """`fit` with its most likely discrepancy, or fitted again with that, whichever is likelier."""
    first = scored(data, fit)
    estimator = Estimator(data, nominal, discrepancy=first.discrepancy)
    again = scored(data, estimator.fit(fit.explanation, fit.values, BRIEF))
    return min(first, again, key=lambda each: each.cost)
