"""An effect held at a fixed strength while the base parameters are refitted: whether they can make it possible."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.effects import EFFECT
from pierburg_ros.effects.effect import Start
from pierburg_ros.errors import InputError
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.inference.coordinates import Coordinates
from pierburg_ros.inference.explanation import Variant
from pierburg_ros.plant import Model

TRUSTED = 1.0
"""Largest change of the other parameters in coordinates, which are mostly logarithms: first by a linear step, then by a
fit. Derived: a straight line says nothing about a value e times as large. Measured: beside static friction a descent
tried a Stribeck velocity a hundred times too large. A limit of a compliant gear took 75 s instead of 0.2 (n = 1)."""


@dataclass(frozen=True)
class Case:
    """One way in which an effect may act: its variant, a start, and the parameter that is its strength."""

    variant: Variant
    start: Start
    parameter: str

    @property
    def above(self) -> bool:
        """Whether a smaller value makes it stronger."""
        return EFFECT[self.variant.effect].parameter(self.parameter).inverse

    def at(self, factor: float) -> Start:
        """The start with its strength multiplied by `factor`."""
        value = self.start[self.parameter]
        return {**self.start, self.parameter: value / factor if self.above else value * factor}

    def factors(self, nominal: Model, duration: float) -> tuple[float, float]:
        """The smallest and the largest factor at which the strength is within the range of a search."""
        axis = Coordinates((f"{self.variant.effect}.{self.parameter}",), nominal, duration).axes[0]
        own = abs(self.start[self.parameter])
        low, high = max(axis.value(axis.lower), 0.0), axis.value(axis.upper)
        return (own / high, own / low) if self.above else (low / own, high / own)

    def strength(self, factor: float) -> float:
        """Size of the strength at a factor; larger where the effect is stronger."""
        value = abs(self.at(factor)[self.parameter])
        return 1.0 / max(value, 1e-300) if self.above else value


class Held:
    """An effect held at a strength, beside `base` parameters that are refitted.

    A value that is counted from a base parameter is held by its excess over that. Otherwise the parameter would absorb
    it.
    """

    def __init__(self, estimator: Estimator, base: Fit, case: Case) -> None:
        self._estimator, self._base, self._case = estimator, base, case
        self._effect, own = EFFECT[case.variant.effect], (*case.start.items(), *case.variant.fixed)
        fixed = tuple((name, value) for name, value in own if name != case.parameter)
        self._explanation = base.explanation.plus(Variant(case.variant.effect, (case.parameter,), fixed))
        self._name = f"{case.variant.effect}.{case.parameter}"
        self._place = self._explanation.names.index(self._name)
        self._slopes = np.insert(base.solution.jacobian, self._place, 0.0, axis=1)

    def nearest(self, factor: float, ways: Sequence[Signal], iterations: int, enough: float) -> Fit | None:
        """The fit of lowest chi2 from some `ways`, or the first whose chi2 is `enough`."""
        fits: list[Fit] = []
        for way in ways:
            fit = self.fit(factor, way, iterations, enough)
            if fit is not None:
                fits.append(fit)
                if fit.chi2 <= enough:
                    break
        return min(fits, key=lambda fit: fit.chi2, default=None)

    def fit(self, factor: float, way: Signal, iterations: int, enough: float = -math.inf) -> Fit | None:
        """The other parameters fitted with a factor on the strength, from `base` moved by the factor times a `way`.

        None where there is no such model.
        """
        coordinates = self._estimator.coordinates(self._base.explanation)
        point = self._base.solution.point + np.clip(factor * way, -TRUSTED, TRUSTED)
        others = {**self._base.values, **coordinates.values(np.clip(point, *coordinates.bounds))}
        start = {**others, **self._values(factor, others)}
        try:
            return self._estimator.fit(
                self._explanation,
                start,
                iterations,
                held=self._name,
                slopes=self._slopes if iterations else None,
                enough=enough,
                reach=TRUSTED,
            )
        except InputError:
            return None

    def way(self, fit: Fit, factor: float) -> Signal:
        """The change of the other parameters in a `fit`, per unit of the factor."""
        return np.asarray(np.delete(fit.solution.point, self._place) - self._base.solution.point) / factor

    def value(self, factor: float) -> float | None:
        """The strength at a factor, counted from `base`; None where it is infinite or beyond what is declared."""
        declared = self._effect.parameter(self._case.parameter)
        if not math.isfinite(factor):
            return None
        value = self._values(factor, self._base.model.values)[self._name]
        return value if declared.minimum <= value <= declared.maximum else None

    def _values(self, factor: float, others: Mapping[str, float]) -> dict[str, float]:
        own = (*self._case.at(factor).items(), *self._case.variant.fixed)
        return self._effect.counted({f"{self._effect.id}.{name}": value for name, value in own}, others)
