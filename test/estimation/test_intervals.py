"""Intervals against closed forms: where the cost is a parabola, and where its valley bends."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
import pytest
from support.recordings import NOMINAL

from pierburg_ros.arrays import Signal
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.estimator import Estimator
from pierburg_ros.estimation.intervals import estimates
from pierburg_ros.estimation.likelihood import SURE
from pierburg_ros.inference.explanation import Explanation
from pierburg_ros.inference.slopes import FINE

X, Y = "spring_preload", "coulomb_friction"
WIDE = 1e4
NOISE = np.random.default_rng(2).standard_normal(400)


@dataclass(frozen=True)
class Values:
    """In place of a model: its values alone."""

    values: dict[str, float]


class Plane:
    """Coordinates that are the values themselves."""

    bounds = (np.full(2, -WIDE), np.full(2, WIDE))
    steps = np.full(2, 1e-5)

    def point(self, values: Mapping[str, float]) -> Signal:
        return np.array([values[X], values[Y]])

    def values(self, point: Signal) -> dict[str, float]:
        return {X: float(point[0]), Y: float(point[1])}


class Known(Estimator):
    """An estimator of two numbers whose residual is given, beside white noise that they do not touch."""

    def __init__(self, given: Callable[[float, float], list[float]]) -> None:
        self.nominal = NOMINAL
        self.given = given
        self.data = Data(NOMINAL.actuator, (), noise=1.0)
        self.over = map
        self.unit = None

    def coordinates(self, explanation: Explanation) -> Plane:  # type: ignore[override]
        return Plane()

    def models(self, explanation: Explanation, values: Mapping[str, float]) -> tuple[Values, None]:  # type: ignore[override]
        return Values(dict(values)), None

    def residual(self, model: Values, switch: None = None) -> Signal:  # type: ignore[override]
        return np.concatenate([NOISE, self.given(model.values[X], model.values[Y])])


def interval(residual: Callable[[float, float], list[float]], name: str) -> tuple[float, float]:
    estimator = Known(residual)
    found = estimates(estimator, estimator.fit(Explanation((X, Y)), {X: 1.0, Y: 1.0}))[name]
    return found.low, found.high


@pytest.mark.parametrize(("name", "deviation"), [(X, 2.0), (Y, 0.5)])
def test_a_parabola_has_the_interval_of_its_curvature(name: str, deviation: float) -> None:
    low, high = interval(lambda x, y: [(x - 1.0) / 2.0, (y - 1.0) / 0.5], name)
    assert (high - low) / 2.0 == pytest.approx(SURE * deviation, rel=0.02)


def test_a_bent_valley_is_followed_to_its_end() -> None:
    """With y = x^2 nearly exact and x = 1 +- 10, y reaches (1 + 19.6)^2 = 424; its slope at 1 promises 40."""
    low, high = interval(lambda x, y: [100.0 * (y - x * x), (x - 1.0) / 10.0], Y)
    assert 200.0 < high < 430.0
    assert low < 0.5


def test_a_rough_cost_does_not_shorten_the_interval() -> None:
    """Ripples at x = 1 promise a deviation of 0.07, yet up to the walls at -3 and 3 chi2 rises by 0.09 at most."""

    def rippled(x: float, y: float) -> list[float]:
        return [0.3 * math.sin(50.0 * (x - 1.0)), 100.0 * max(abs(x) - 3.0, 0.0), y - 1.0]

    low, high = interval(rippled, X)
    assert 2.0 < high < 3.1
    assert -3.1 < low < -1.0


def test_a_quantity_without_a_slope_reaches_to_the_ends_of_its_plateau() -> None:
    """Nothing changes from 0.5 to 3; beyond, chi2 jumps. The ends are found to the step of slopes."""
    low, high = interval(lambda x, y: [100.0 * float(not 0.5 < x < 3.0), y - 1.0], X)
    assert low == pytest.approx(0.5, abs=3.0 * FINE * WIDE)
    assert high == pytest.approx(3.0, abs=3.0 * FINE * WIDE)


def test_a_quantity_that_nothing_depends_on_reaches_to_its_bounds() -> None:
    assert interval(lambda x, y: [y - 1.0], X) == (-WIDE, WIDE)
