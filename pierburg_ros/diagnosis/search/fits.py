"""Fits of explanations to the training samples, from starts that a linear screening has found promising."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.diagnosis.evidence.data import EvidenceData, Switch
from pierburg_ros.diagnosis.evidence.resolution import counted
from pierburg_ros.diagnosis.search.explanation import AFTER, WHEN, Coordinates, Explanation, Variant
from pierburg_ros.effects import DECLARED, EFFECT
from pierburg_ros.effects.effect import HIGHEST_SHARE
from pierburg_ros.errors import InputError
from pierburg_ros.estimation.least_squares import Solution, minimise
from pierburg_ros.plant import Model

Start = Mapping[str, float]

STRIDES = {name: p.stride for name, p in DECLARED.items() if p.stride is not None}
"""Strengths that a linear step scales, and the largest factor: events jump with delays and gaps, and what is right for
a small one says little about a large one. Their starts lie close enough."""
BELOW = {name: p.below for name, p in DECLARED.items() if p.below is not None}
"""Parameters that stay below another one."""
REDATED = 4.0
"""How far around its first estimate the moment of a change is looked for again [s]."""


@dataclass(frozen=True)
class Fit:
    """An explanation with its best values by dotted name, the model with them, and the one that takes over if any.

    `half_step` is half a step of the converter over the noise, 0 where steps are fine.
    """

    explanation: Explanation
    values: dict[str, float]
    model: Model
    switch: Switch | None
    solution: Solution
    half_step: float

    @property
    def chi2(self) -> float:
        """Sum of squared training residuals over the noise variance."""
        return self.solution.cost

    @property
    def misfit(self) -> float:
        """What of `chi2` is evidence against the explanation: all, unless steps of the converter are coarse."""
        return counted(self.solution.residual, self.half_step)

    @property
    def ratio(self) -> float:
        """Training error over the noise, as far as it is evidence."""
        return float(np.sqrt(self.misfit / self.solution.residual.size))


def repetition(fit: Fit) -> float:
    """Samples that count as one: 1 + 2 sum of the positive autocorrelation of the residual, at least 1.

    White residuals count in full; a residual with structure left counts by its independent stretches.
    """
    residual = fit.solution.residual
    centred = residual - residual.mean()
    size = 1 << int(np.ceil(np.log2(2 * centred.size)))
    spectrum = np.abs(np.fft.rfft(centred, size)) ** 2
    correlation = np.fft.irfft(spectrum, size)[: centred.size // 4]
    correlation = correlation / max(float(correlation[0]), 1e-30)
    negative = np.flatnonzero(correlation < 0.02)
    last = int(negative[0]) if negative.size else correlation.size
    return float(1.0 + 2.0 * correlation[1:last].sum())


def spread(fit: Fit) -> float:
    """Rise of chi2 that stands for one standard deviation: 1 where the residual is white noise."""
    return max(1.0, fit.ratio**2) * repetition(fit)


class Search:
    """Fits explanations of one set of recordings by one nominal model."""

    def __init__(self, data: EvidenceData, nominal: Model) -> None:
        self.data = data
        self.nominal = nominal
        self._training = data.training

    def residual(self, model: Model, switch: Switch | None = None) -> Signal:
        """Training residual of `model` in units of the noise; large where it cannot be simulated."""
        return self._finite(model, switch)[self._training]

    def chi2_at(self, explanation: Explanation, values: Mapping[str, float]) -> float:
        """Chi2 of an explanation with given values on the training samples."""
        residual = self.residual(*self.models(explanation, values))
        return float(residual @ residual)

    def choosing_misfit(self, fit: Fit) -> float:
        """What counts as evidence of chi2 on the samples that choose; 0 where there are none."""
        return counted(self._finite(fit.model, fit.switch)[self.data.choosing], self.data.half_step)

    def _finite(self, model: Model, switch: Switch | None) -> Signal:
        return np.nan_to_num(self.data.residual(model, switch), nan=1e3, posinf=1e3, neginf=-1e3)

    def fit(
        self,
        explanation: Explanation,
        start: Start | None = None,
        iterations: int = 25,
        forgiving: bool = False,
        steps: Signal | None = None,
        held: str | None = None,
    ) -> Fit:
        """Best values of an explanation from `start`, dotted values; what it lacks starts nominal.

        A forgiving fit counts large errors by their logarithm, so that a slip at the wrong moment does not
        decide; it ends with the forgiving cost and wants an ordinary fit after it. `steps` are the differences
        of the Jacobian, shape (free quantities,), in the coordinates of the search. The quantity `held` stays at its
        start.
        """
        coordinates = self.coordinates(explanation)
        begin = coordinates.point({**self.nominal.values, **(start or {})})

        def cost(point: Signal) -> Signal:
            residual = self.residual(*self.models(explanation, coordinates.values(point)))
            return _forgiven(residual) if forgiving else residual

        lower, upper = coordinates.bounds()
        if held is not None:
            place = explanation.names.index(held)
            lower[place] = upper[place] = begin[place]
        steps = coordinates.steps() if steps is None else steps
        solution = minimise(cost, begin, lower, upper, steps, iterations)
        values = coordinates.values(solution.point)
        model, switch = self.models(explanation, values)
        return Fit(explanation, {**model.values, **values}, model, switch, solution, self.data.half_step)

    def coordinates(self, explanation: Explanation) -> Coordinates:
        """The coordinates in which an explanation is searched."""
        return Coordinates(explanation.names, self.nominal, float(self.data.runs[0].time[-1]))

    def models(self, explanation: Explanation, values: Mapping[str, float]) -> tuple[Model, Switch | None]:
        """The model with `values`, and the one that takes over where the explanation has a change."""
        own = {name: value for name, value in values.items() if "@" not in name}
        model = self.model({**explanation.fixed, **own})
        if explanation.changed is None:
            return model, None
        name = explanation.changed
        after = self.model({**explanation.fixed, **own, name: values[name + AFTER]})
        return model, Switch(after, values[name + WHEN])

    def linearised(self, fit: Fit) -> Fit:
        """`fit` with residual and Jacobian on the samples of this search."""
        return self.fit(fit.explanation, fit.values, 0)

    def model(self, values: Mapping[str, float]) -> Model:
        """The nominal model with `values`, pairs that must keep an order put in order."""
        changed = dict(values)
        for name in changed.keys() & BELOW.keys():
            limit = changed.get(BELOW[name], self.nominal.values[BELOW[name]])
            if changed[name] >= limit:
                changed[name] = HIGHEST_SHARE * limit
        return self.nominal.with_values(changed)

    def screened(self, base: Fit, variant: Variant, starts: Sequence[Start]) -> list[tuple[float, dict[str, float]]]:
        """Starts by the cost [units of chi2] that a linear step from `base` along them promises, best first.

        Each start is simulated once on top of `base`; what re-fitting the base could do about it is projected
        out; two starts that differ in phase alone count as one with a free phase.
        """
        projected = _projection(base)
        residual = projected(base.solution.residual)
        promised = []
        for group in _in_quadrature(starts):
            columns, used = [], []
            for start in group:
                own = {f"{variant.effect}.{name}": value for name, value in start.items()}
                try:
                    columns.append(base.solution.residual - self.residual(*self._added(base, variant, own)))
                except InputError:
                    continue
                used.append(own)
            if not columns:
                continue
            change = projected(np.stack(columns, axis=1))
            scale = np.asarray(np.linalg.lstsq(change, residual, rcond=None)[0], dtype=np.float64)
            left = residual - change @ scale
            promised.append((float(left @ left), _scaled(base.model, variant, used, scale)))
        return sorted(promised, key=lambda pair: pair[0])

    def stepped(self, fit: Fit) -> float:
        """The chi2 that one linear step from `fit` promises."""
        left = _projection(fit)(fit.solution.residual)
        return float(left @ left)

    def marks(self, base: Fit, variant: Variant, starts: Sequence[Start]) -> list[float]:
        """Sum of squares [noise^2] that each start leaves in the simulated signal after a linear re-fit of `base`."""
        projected = _projection(base)
        sizes = []
        for start in starts:
            own = {f"{variant.effect}.{name}": value for name, value in start.items()}
            try:
                change = projected(base.solution.residual - self.residual(*self._added(base, variant, own)))
            except InputError:
                continue
            sizes.append(float(change @ change))
        return sizes

    def _added(self, base: Fit, variant: Variant, own: dict[str, float]) -> tuple[Model, Switch | None]:
        """The models of `base` with an effect added."""
        added = {**own, **dict(_dotted(variant))}
        model = base.model.with_values(EFFECT[variant.effect].counted(added, base.model.values))
        if base.switch is None:
            return model, None
        after = base.switch.model
        added = EFFECT[variant.effect].counted(added, after.values)
        return model, Switch(after.with_values(added), base.switch.time)

    def dated(self, fit: Fit) -> Fit:
        """A fit with a change, its moment looked for again among those around it: the cost has many dips there."""
        name = f"{fit.explanation.changed}{WHEN}"
        best, moment = fit.chi2, fit.values[name]
        for shift in np.arange(-REDATED, REDATED + 0.1, 0.25):
            values = {**fit.values, name: fit.values[name] + shift}
            chi2 = self.chi2_at(fit.explanation, self._within(fit.explanation, values))
            if chi2 < best:
                best, moment = chi2, values[name]
        return self.fit(fit.explanation, {**fit.values, name: moment})

    def _within(self, explanation: Explanation, values: Mapping[str, float]) -> dict[str, float]:
        coordinates = self.coordinates(explanation)
        return coordinates.values(coordinates.point(values))

    def change_starts(self, base: Fit, name: str, most: int) -> list[dict[str, float]]:
        """Values before and after a change of parameter `name`, and its time, that a linear step promises."""
        run = self.data.runs[0]
        time = run.time[run.training]
        probe = self.fit(Explanation((*base.explanation.drifted, name), base.explanation.variants), base.values, 0)
        slope = probe.solution.jacobian[: time.size, len(base.explanation.drifted)]
        residual = base.solution.residual[: time.size]
        before, weight = np.cumsum(slope * residual), np.cumsum(slope * slope) + 1e-9
        after, rest = before[-1] - before, weight[-1] - weight + 1e-9
        gain = before**2 / weight + after**2 / rest
        starts: list[dict[str, float]] = []
        for index in np.argsort(gain)[::-1]:
            if all(abs(time[index] - start[name + WHEN]) > 0.05 * time[-1] for start in starts):
                shift = np.clip([-before[index] / weight[index], -after[index] / rest[index]], -0.5, 0.5)
                nominal = base.values[name]
                starts.append({
                    **base.values, name: nominal * float(np.exp(shift[0])),
                    name + AFTER: nominal * float(np.exp(shift[1])), name + WHEN: float(time[index]),
                })  # fmt: skip
            if len(starts) == most:
                break
        return starts


def _projection(fit: Fit) -> Callable[[Signal], Signal]:
    """Projection of residuals, shape (samples,) or (samples, some), on what re-fitting `fit` cannot change."""
    basis = np.linalg.qr(fit.solution.jacobian)[0]
    return lambda residual: residual - basis @ (basis.T @ residual)


def _forgiven(residual: Signal) -> Signal:
    """Residuals [noise] with their size beyond three noises replaced by its logarithm."""
    return np.sign(residual) * 3.0 * np.log1p(np.abs(residual) / 3.0)


def _dotted(variant: Variant) -> dict[str, float]:
    return {f"{variant.effect}.{name}": value for name, value in variant.fixed}


def _in_quadrature(starts: Sequence[Start]) -> list[list[Start]]:
    groups: dict[tuple[tuple[str, float], ...], list[Start]] = {}
    for start in starts:
        key = tuple(sorted((name, value) for name, value in start.items() if name != "phase"))
        groups.setdefault(key, []).append(start)
    return list(groups.values())


def _scaled(model: Model, variant: Variant, used: list[dict[str, float]], scale: Signal) -> dict[str, float]:
    """The start with the strength, and with two starts in quadrature the phase, that the linear step asks for."""
    values = {**model.values, **EFFECT[variant.effect].counted(used[0], model.values)}
    if len(used) == 2:
        name = f"{variant.effect}.amplitude"
        values[name] = used[0][name] * float(np.hypot(*scale))
        values[f"{variant.effect}.phase"] = float(np.arctan2(scale[1], scale[0]))
        return values
    for name in used[0].keys() & STRIDES.keys():
        values[name] = used[0][name] * float(np.clip(scale[0], 1.0 / STRIDES[name], STRIDES[name]))
    return values
