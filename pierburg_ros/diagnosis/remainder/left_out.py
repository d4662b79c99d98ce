"""The score of an effect that recordings share: the error of recordings left out of the fit, and the prior."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.diagnosis.search.race import ROUNDS
from pierburg_ros.estimation.data import Data, rms
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.estimation.likelihood import repetition
from pierburg_ros.estimation.prior import implausible, improbability
from pierburg_ros.plant import Model

FOLDS = 4
"""Number of parts into which the recordings are divided; each is left out in turn. Work: every effect that is tried is
fitted once more for each part; not varied."""
BETTER = 0.9
"""Largest share of the error on unseen data that anything reported of a remainder may leave: an effect, an effect with
its overtones, a residual torque. Given: a name only where unseen data improve by a tenth."""

Map = Callable[..., Iterable[Any]]
Folds = list[tuple[Data, Data]]
"""Pairs of data that are fitted and data that are left out."""


@dataclass(frozen=True)
class LeftOut:
    """The evidence for an effect from recordings left out of the fit.

    Their error is the geometric mean of root mean squares: `without` the effect, and with it `beside` those added
    before. The effect `helped` in so many of the `parts`, and `recordings` are the names in these. The error is in a
    `unit`; an empty one is the measured unit.
    """

    without: float
    beside: float
    helped: int
    parts: int
    recordings: tuple[str, ...] = ()
    unit: str = ""


@dataclass(frozen=True)
class Parts:
    """What a fit leaves of each part when it is fitted to the others.

    `errors` is the RMSE [noise] and `stretches` the number of independent stretches, shape (parts,). `improbable` is
    how improbable its values are, in -2 log probability. `plausible`: each value of its effects is one that 95 of 100
    actuators have.
    """

    errors: Signal
    stretches: Signal
    improbable: float
    plausible: bool = True

    @property
    def mean(self) -> float:
        """Geometric mean of the errors, so that a part whose error is large in any case does not decide alone."""
        return float(np.exp(np.mean(np.log(self.errors))))


def folds_of(data: Data) -> Folds:
    """The recordings divided into parts; each part is left out once."""
    count = min(FOLDS, data.runs[-1].number + 1)
    pairs = []
    for fold in range(count):
        left = tuple(run for run in data.runs if run.number % count == fold)
        rest = tuple(run for run in data.runs if run.number % count != fold)
        pairs.append((replace(data, runs=rest), replace(data, runs=left)))
    return pairs


def believing(data: Data, nominal: Model, residual: Signal) -> Estimator:
    """An estimator that counts a residual like this [noise] by its independent stretches, with the prior of the
    values."""
    size = max(rms(residual), 1.0)
    return Estimator(data, nominal, unit=size * math.sqrt(repetition(residual)))


def parts_of(nominal: Model, folds: Folds, fit: Fit, over: Map = map) -> Parts:
    """The error of a fit on each part, its values fitted again to the others."""

    def left_of(fold: tuple[Data, Data]) -> tuple[float, float]:
        fitted, left = fold
        again = believing(fitted, nominal, fitted.residual(fit.model)).fit(fit.explanation, fit.values, ROUNDS)
        residual = left.residual(again.model)
        return rms(residual), residual.size / repetition(residual)

    errors, stretches = zip(*over(left_of, folds), strict=True)
    coordinates = Estimator(folds[0][0], nominal).coordinates(fit.explanation)
    point = coordinates.point(fit.values)
    rows, own = improbability(coordinates, point), set(fit.explanation.names) - set(fit.explanation.drifted)
    plausible = not own & implausible(coordinates, point)
    return Parts(np.array(errors), np.array(stretches), float(rows @ rows), plausible)


def gain(smaller: Parts, larger: Parts) -> float:
    """The evidence of the parts left out and of the prior for the larger explanation, in -2 log likelihood.

    Each independent stretch counts as one sample of a normal variable of unknown size.
    """
    told = larger.stretches @ np.log(smaller.errors / larger.errors)
    return float(2.0 * told + smaller.improbable - larger.improbable)


def helps(smaller: Parts, larger: Parts, candidates: int) -> bool:
    """Whether the larger explanation, the best of so many candidates, is accepted over the smaller one."""
    return gain(smaller, larger) > by_chance(candidates) and larger.mean < BETTER * smaller.mean


def by_chance(candidates: int) -> float:
    """Gain of the best of so many candidates in -2 log likelihood if none of them acts.

    It is about the largest of as many squares of normal variables.
    """
    return 2.0 * math.log(candidates)


def said_of(folds: Folds, before: Parts, after: Parts) -> LeftOut:
    """The evidence of the parts left out for an effect when it was added."""
    helped = after.errors < before.errors
    told = zip(folds, helped, strict=True)
    recordings = tuple(name for (_, left), helps in told if helps for name in _names(left))
    noise = folds[0][0].noise
    return LeftOut(before.mean * noise, after.mean * noise, int(np.sum(helped)), helped.size, recordings)


def _names(data: Data) -> list[str]:
    """Names of the recordings."""
    return list({run.number: run.name for run in data.runs}.values())
