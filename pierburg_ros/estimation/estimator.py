"""Fits of explanations to recordings: bounded least squares of the measured signal."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.estimation.coordinates import Coordinates, in_order
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.discrepancy import Discrepancy, Kalman
from pierburg_ros.estimation.explanation import AFTER, WHEN, Explanation
from pierburg_ros.estimation.least_squares import FULL, TOLERANCE, Map, Solution, jacobian, minimise
from pierburg_ros.estimation.likelihood import FORMULATION, beyond, counted, repetition, structure
from pierburg_ros.estimation.prior import improbability
from pierburg_ros.estimation.rests import cut_at_rests
from pierburg_ros.estimation.run import Switch
from pierburg_ros.plant import Model

FORGIVEN = 3.0
"""Errors beyond so many noises count by their logarithm where a fit forgives. Derived: of white noise only 0.27 % lies
beyond."""


@dataclass(frozen=True)
class Fit:
    """An explanation with its best values by dotted name, the model with them, and the one that takes over if any.

    `half_step` is half a step of the converter over the noise, 0 where steps are fine. `unlike` [noise, root mean
    square] is what lasts and yet is no evidence: what of the noise does (`Data`), and what simulations may differ by;
    `rounding` what steps of the converter add while the shaft rests.
    `refined`: the cost has been searched for other local minima.
    """

    explanation: Explanation
    values: dict[str, float]
    model: Model
    switch: Switch | None
    solution: Solution
    half_step: float
    unlike: float = 0.0
    rounding: float = 0.0
    refined: bool = False

    @property
    def chi2(self) -> float:
        """Sum of squared training residuals over the noise variance."""
        return self.solution.cost

    @cached_property
    def misfit(self) -> float:
        """What of `chi2` is evidence against the explanation: all, unless steps of the converter are coarse."""
        return counted(self.solution.residual, self.half_step)

    @property
    def ratio(self) -> float:
        """Training error over the noise, as far as it is evidence."""
        return float(np.sqrt(self.misfit / self.solution.residual.size))

    @cached_property
    def repetition(self) -> float:
        """Samples of the residual that count as one, 1 for white noise."""
        return repetition(self.solution.residual)

    @cached_property
    def structure(self) -> float:
        """What speaks for an error that lasts in the residual, in -2 log likelihood."""
        return structure(beyond(self.solution.residual, self.half_step), float(np.hypot(self.unlike, self.rounding)))

    @property
    def spread(self) -> float:
        """Rise of chi2 that stands for one standard deviation: 1 where the residual is white noise."""
        return max(1.0, self.ratio**2) * self.repetition


class Estimator:
    """Fits explanations by one nominal model to the training samples of some recordings.

    `over` maps a function over the columns of a Jacobian: on several cores where a fit has them to itself. With a
    `discrepancy` residuals count by what it does not predict from the samples before: their innovations. With a `unit`
    [noise] they count in that, and beside them by how far values lie from what is plausible (`prior.py`).
    """

    def __init__(
        self,
        data: Data,
        nominal: Model,
        over: Map = map,
        discrepancy: Discrepancy | None = None,
        unit: float | None = None,
    ) -> None:
        self.data = data
        self.discrepancy = discrepancy
        self.unit = unit
        self.over = over
        self.nominal = nominal
        self._train = data.train
        self._validation = data.validation
        self._filter = Kalman(data, self._train).filtered(discrepancy) if discrepancy else None

    @cached_property
    def between_rests(self) -> Estimator:
        """The same for recordings cut where the shaft rests: costs are smoother, values only nearly right."""
        return Estimator(cut_at_rests(self.data), self.nominal, self.over, self.discrepancy, self.unit)

    def residual(self, model: Model, switch: Switch | None = None) -> Signal:
        """Training residual of `model` in units of the noise, or its innovations; large where there is none."""
        residual = self.data.residual(model, switch)
        return residual[self._train] if self._filter is None else self._filter(residual)

    def chi2_at(self, explanation: Explanation, values: Mapping[str, float]) -> float:
        """Chi2 of an explanation with given values on the training samples."""
        residual = self.residual(*self.models(explanation, values))
        return float(residual @ residual)

    def validation_misfit(self, fit: Fit) -> float:
        """What counts as evidence of chi2 on the samples that validate; 0 where there are none."""
        residual = self.data.residual(fit.model, fit.switch)[self._validation]
        return counted(residual, self.data.half_step)

    def fit(
        self,
        explanation: Explanation,
        start: Mapping[str, float] | None = None,
        iterations: int = FULL,
        *,
        forgiving: bool = False,
        steps: Signal | None = None,
        held: str | None = None,
        tolerance: float = TOLERANCE,
        slopes: Signal | None = None,
        enough: float = -np.inf,
        reach: float = np.inf,
    ) -> Fit:
        """Best values of an explanation from `start`, dotted values; what it lacks starts nominal.

        A forgiving fit counts large errors by their logarithm, so that a slip at the wrong moment does not
        decide; it ends with the forgiving cost and wants an ordinary fit after it. `steps` are the differences
        of the Jacobian, shape (free quantities,), in the coordinates of the search. The quantity `held` stays at its
        start, the others within their `reach` of it, in coordinates. A descent ends where an iteration lowers the cost
        by less than `tolerance` of it, or where the cost is `enough`; it begins with known `slopes`, if given.
        """
        coordinates = self.coordinates(explanation)
        begin = coordinates.point({**self.nominal.values, **(start or {})})
        lower, upper = (np.clip(bound, begin - reach, begin + reach) for bound in coordinates.bounds)
        if held is not None:
            place = explanation.names.index(held)
            lower[place] = upper[place] = begin[place]

        def cost(point: Signal) -> Signal:
            residual = self.residual_at(explanation, coordinates, point)
            return forgiven(residual) if forgiving else residual

        steps = coordinates.steps if steps is None else steps
        solution = minimise(cost, begin, lower, upper, steps, iterations, tolerance, self.over, slopes, enough)
        return self._fitted(explanation, coordinates, solution)

    def at(self, explanation: Explanation, values: Mapping[str, float] | None = None) -> Fit:
        """An explanation with given `values`, not searched for better ones; what they lack is nominal."""
        return self.fit(explanation, values, 0)

    def restated(self, fit: Fit) -> Fit:
        """`fit` with residual and Jacobian on the training samples of these recordings."""
        return self.at(fit.explanation, fit.values)

    def residual_at(self, explanation: Explanation, coordinates: Coordinates, point: Signal) -> Signal:
        """Training residual at a point of the search, in units of the noise; with a `unit` in that, then the prior."""
        residual = self.residual(*self.models(explanation, coordinates.values(point)))
        if self.unit is None:
            return residual
        return np.concatenate([residual / self.unit, improbability(coordinates, point)])

    def coordinates(self, explanation: Explanation) -> Coordinates:
        """The coordinates in which an explanation is searched."""
        return Coordinates(explanation.names, self.nominal, self.data.duration)

    def models(self, explanation: Explanation, values: Mapping[str, float]) -> tuple[Model, Switch | None]:
        """The model with `values`, and the one that takes over where the explanation has a change."""
        own = {**explanation.fixed, **{name: value for name, value in values.items() if "@" not in name}}
        model = self.model(own)
        if explanation.changed is None:
            return model, None
        name = explanation.changed
        return model, Switch(self.model({**own, name: values[name + AFTER]}), values[name + WHEN])

    def model(self, values: Mapping[str, float]) -> Model:
        """The nominal model with `values`, pairs that must keep an order put in order."""
        return self.nominal.with_values(in_order(values, self.nominal))

    def slopes(self, fit: Fit, steps: Signal) -> Signal:
        """Derivative of the training residual at a fit, by differences of `steps`, shape (samples, quantities)."""
        coordinates = self.coordinates(fit.explanation)

        def residual(point: Signal) -> Signal:
            return self.residual_at(fit.explanation, coordinates, point)

        return jacobian(residual, fit.solution.point, fit.solution.residual, *coordinates.bounds, steps, self.over)

    def _fitted(self, explanation: Explanation, coordinates: Coordinates, solution: Solution) -> Fit:
        values = coordinates.values(solution.point)
        model, switch = self.models(explanation, values)
        data = self.data
        formulation = FORMULATION * data.scales.reading if explanation.variants else 0.0
        unlike = float(np.hypot(data.unlike, formulation)) / data.noise
        rounding = data.rounding / data.noise
        return Fit(explanation, {**model.values, **values}, model, switch, solution, data.half_step, unlike, rounding)


def forgiven(residual: Signal) -> Signal:
    """Residuals [noise] with their size beyond `FORGIVEN` replaced by its logarithm."""
    return np.sign(residual) * FORGIVEN * np.log1p(np.abs(residual) / FORGIVEN)
