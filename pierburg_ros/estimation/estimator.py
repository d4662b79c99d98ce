"""Fits of explanations to recordings: bounded least squares of the measured signal."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.discrepancy import Discrepancy, Kalman
from pierburg_ros.estimation.likelihood import (
    EXPLAINED,
    FORMULATION,
    SIGNIFICANT,
    beyond,
    counted,
    repetition,
    structure,
)
from pierburg_ros.estimation.prior import improbability
from pierburg_ros.estimation.rests import cut_at_rests
from pierburg_ros.estimation.run import Switch
from pierburg_ros.inference.coordinates import Coordinates, in_order
from pierburg_ros.inference.explanation import AFTER, WHEN, Explanation
from pierburg_ros.inference.least_squares import FULL, TOLERANCE, Map, Solution, jacobian, minimise
from pierburg_ros.plant import Model

FORGIVEN = 3.0
"""Number of noises beyond which errors count by their logarithm in a forgiving fit. Derived: of white noise only 0.27 %
lies beyond."""


@dataclass(frozen=True)
class Fit:
    """An explanation with its best values by dotted name, the model with them, and the switch to another model, if any.

    `half_step` is half a step of the converter over the noise, 0 where steps are fine. `unlike` [noise, root mean
    square] is an error that is correlated in time and yet no evidence: that part of the noise (`Data`), and the
    difference between correct simulations. `rounding` is what steps of the converter add while the shaft rests.
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
        """The part of `chi2` that is evidence against the explanation: all, unless converter steps are coarse."""
        return counted(self.solution.residual, self.half_step)

    @property
    def ratio(self) -> float:
        """Training error over the noise, without the part that is no evidence."""
        return float(np.sqrt(self.misfit / self.solution.residual.size))

    @cached_property
    def repetition(self) -> float:
        """Number of samples of the residual that count as one, 1 for white noise."""
        return repetition(self.solution.residual)

    @cached_property
    def structure(self) -> float:
        """Evidence in the residual for an error that is correlated in time, in -2 log likelihood."""
        return structure(beyond(self.solution.residual, self.half_step), float(np.hypot(self.unlike, self.rounding)))

    @property
    def spread(self) -> float:
        """Rise of chi2 for one standard deviation: 1 where the residual is white noise."""
        return max(1.0, self.ratio**2) * self.repetition


def adequate(fit: Fit) -> bool:
    """Whether an explanation is adequate: it leaves only noise, of a size that may be estimated too low.

    A residual that is correlated in time counts as one more quantity, with the same threshold.
    """
    return fit.ratio < EXPLAINED and fit.structure < SIGNIFICANT


class Estimator:
    """Fits explanations by one nominal model to the training samples of some recordings.

    `over` maps a function over the columns of a Jacobian: on several cores where a fit has them to itself. With a
    `discrepancy`, residuals count as innovations: without the error that it predicts from earlier samples. With a
    `unit` [noise], residuals count in this unit, and the prior of the values counts as well (`prior.py`).
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
        """The same for recordings cut where the shaft rests: the cost is smoother, the values are only nearly right."""
        return self.on(cut_at_rests(self.data))

    @cached_property
    def first_part(self) -> Estimator:
        """The same for the first part of each run."""
        return self.on(self.data.first_part)

    def on(self, data: Data) -> Estimator:
        """The same for other data."""
        return Estimator(data, self.nominal, self.over, self.discrepancy, self.unit)

    def residual(self, model: Model, switch: Switch | None = None) -> Signal:
        """Training residual of `model` [noise], or its innovations; large where the model cannot be simulated."""
        residual = self.data.residual(model, switch)
        return residual[self._train] if self._filter is None else self._filter(residual)

    def chi2_at(self, explanation: Explanation, values: Mapping[str, float]) -> float:
        """Chi2 of an explanation with given values on the training samples."""
        residual = self.residual(*self.models(explanation, values))
        return float(residual @ residual)

    def validation_misfit(self, fit: Fit) -> float:
        """The part of chi2 on validation samples that is evidence; 0 where there are none."""
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
        """The fit of an explanation from `start`, values by dotted name; values that it lacks start at nominal.

        A forgiving fit counts large errors by their logarithm, so that a slip at the wrong moment does not decide. It
        ends with the forgiving cost, and needs an ordinary fit after it. `steps` are the differences of the Jacobian,
        shape (free quantities,), in the coordinates of the search. The quantity `held` stays at its start, the others
        within `reach` of theirs, in coordinates. A descent ends where an iteration lowers the cost by less than
        `tolerance` of it, or where the cost is at most `enough`. It begins with known `slopes`, if given.
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
        """An explanation at given `values`, without a search; values that are missing are nominal."""
        return self.fit(explanation, values, 0)

    def restated(self, fit: Fit) -> Fit:
        """`fit` with residual and Jacobian on the training samples of this estimator."""
        return self.at(fit.explanation, fit.values)

    def residual_at(self, explanation: Explanation, coordinates: Coordinates, point: Signal) -> Signal:
        """Training residual at a point of the search [noise]; with a `unit`, in that unit and followed by the prior."""
        residual = self.residual(*self.models(explanation, coordinates.values(point)))
        if self.unit is None:
            return residual
        return np.concatenate([residual / self.unit, improbability(coordinates, point)])

    def coordinates(self, explanation: Explanation) -> Coordinates:
        """The coordinates in which an explanation is searched."""
        return Coordinates(explanation.names, self.nominal, self.data.duration)

    def models(self, explanation: Explanation, values: Mapping[str, float]) -> tuple[Model, Switch | None]:
        """The model with `values`, and the switch to another one where the explanation has a change."""
        own = {**explanation.fixed, **{name: value for name, value in values.items() if "@" not in name}}
        model = self.model(own)
        if explanation.changed is None:
            return model, None
        name = explanation.changed
        return model, Switch(self.model({**own, name: values[name + AFTER]}), values[name + WHEN])

    def model(self, values: Mapping[str, float]) -> Model:
        """The nominal model with `values`; pairs that must keep an order are put in order."""
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
    """Residuals [noise] whose size counts by its logarithm beyond about `FORGIVEN`."""
    return np.sign(residual) * FORGIVEN * np.log1p(np.abs(residual) / FORGIVEN)
