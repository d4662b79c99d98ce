"""How likely a fit makes the recordings when its remainder is part of the likelihood."""

from __future__ import annotations

from collections.abc import Iterable
from concurrent.futures import Executor
from dataclasses import dataclass

from pierburg_ros.diagnosis.search.selection import PROMISING
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.discrepancy import Discrepancy, Kalman
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.estimation.prior import implausible
from pierburg_ros.inference.least_squares import BRIEF
from pierburg_ros.plant import Model


@dataclass(frozen=True)
class Scored:
    """A fit, its most likely discrepancy, and `cost`: minus twice the log likelihood of both together."""

    fit: Fit
    discrepancy: Discrepancy
    cost: float

    @property
    def left(self) -> float:
        """How much less likely the residual is than white noise of the sensor's size, in -2 log likelihood."""
        return self.cost - self.fit.solution.residual.size


def scored(data: Data, fit: Fit, near: Discrepancy | None = None) -> Scored:
    """`fit`, not fitted again, with its most likely discrepancy; the search for that may begin `near` a known one."""
    kalman = Kalman(data, data.train)
    residual = data.residual(fit.model, fit.switch)
    discrepancy = kalman.most_likely(residual, near=near)
    return Scored(fit, discrepancy, kalman.evidence(discrepancy, residual))


def unseen(data: Data, fit: Fit) -> float:
    """Minus twice the log likelihood of the validation samples, given the training samples.

    The discrepancy is the most likely one on both: the remainder may be larger where nothing was fitted.
    """
    residual, both = data.residual(fit.model, fit.switch), Kalman(data, data.train | data.validation)
    discrepancy = both.most_likely(residual)
    return both.evidence(discrepancy, residual) - Kalman(data, data.train).evidence(discrepancy, residual)


def estimator_beside(data: Data, nominal: Model, discrepancy: Discrepancy) -> Estimator:
    """An estimator with a `discrepancy`: its cost counts innovations, and how far values lie from plausible ones."""
    return Estimator(data, nominal, discrepancy=discrepancy, unit=1.0)


def settled(data: Data, nominal: Model, fit: Fit) -> Scored:
    """`fit` with its most likely discrepancy, fitted again with it as long as the recordings become more likely.

    It ends when one more fit gains no more than chance gives one quantity.
    """
    best = scored(data, fit)
    while True:
        estimator = estimator_beside(data, nominal, best.discrepancy)
        again = scored(data, estimator.fit(fit.explanation, best.fit.values, BRIEF), best.discrepancy)
        gain, best = best.cost - again.cost, min(best, again, key=lambda each: each.cost)
        if gain < PROMISING:
            return best


def plausible(fits: Iterable[Fit], data: Data, nominal: Model, pool: Executor) -> list[Scored]:
    """`fits`, settled, without those with effect values that few actuators have: effects that adapt often have such."""
    found = pool.map(lambda fit: settled(data, nominal, fit), fits)
    return [each for each in found if not strange(each.fit, data, nominal)]


def strange(fit: Fit, data: Data, nominal: Model) -> set[str]:
    """Names of the effects' parameters with values that few actuators have."""
    coordinates = Estimator(data, nominal).coordinates(fit.explanation)
    return {name for name in implausible(coordinates, coordinates.point(fit.values)) if "." in name}
