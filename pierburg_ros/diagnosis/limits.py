"""How strong an effect that is not named may be, and whether the recordings could show it at all.

The strength is raised until the likelihood has fallen by what 95 % allows (profile likelihood), while the parameters
follow: by a linear step, and by a short fit where that is possible. A residual that is larger than the noise, or
correlated in time, counts as much less as it says. What remains unexplained may hide an effect as large as itself.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import dataclass

import numpy as np

from pierburg_ros.actuators import Scales
from pierburg_ros.effects import EFFECT
from pierburg_ros.effects.effect import Start
from pierburg_ros.errors import InputError
from pierburg_ros.inference.coordinates import Coordinates, in_order
from pierburg_ros.inference.explanation import Variant
from pierburg_ros.inference.fit import Fit, excess
from pierburg_ros.inference.least_squares import beside
from pierburg_ros.inference.shortlist import added

ONE_SIDED = 2.71
"""Fall of -2 log likelihood at a strength that is excluded at 95 %, one-sided. Derived: the square of 1.645, the 95 %
quantile of the normal distribution."""
EXAMINED = 8
"""Starts of one way to act that are examined: places, frequencies, phases. Work: each costs a simulation, the weakest
of their limits counts."""
STRENGTHS_TRIED = 3
"""Further strengths that are simulated for it. Derived: the cost rises about with the square of the strength, so each
simulation gives the next one."""
SETTLED = 0.1
"""Relative change of a strength below which it is found. Chosen: a limit is told with two digits."""
WIDENED = 1.5
"""Factor by which a strength is raised while a fit of the parameters makes it possible. Chosen: a limit is then too
cautious by this factor at most."""
RAISED = 4
"""Times that a strength is raised before the effect counts as not excluded. Work: each costs a short fit."""
FOLLOWING = 3
"""Iterations of such a fit. Work: it starts from the linear step."""


@dataclass(frozen=True)
class Limit:
    """The strength [unit of the `parameter`] from which an effect contradicts the recordings at 95 %.

    `above`: the effect is the stronger the smaller its parameter (a stiffness), so the true value lies above `value`.
    """

    effect: str
    parameter: str
    value: float
    above: bool


@dataclass(frozen=True)
class Case:
    """One start of one way in which an effect may act, with the parameter that is its strength."""

    variant: Variant
    start: Start
    parameter: str

    @property
    def above(self) -> bool:
        """Whether a smaller value makes it stronger."""
        return EFFECT[self.variant.effect].parameter(self.parameter).inverse

    def at(self, factor: float) -> Start:
        """The start with its strength multiplied by a factor."""
        value = self.start[self.parameter]
        return {**self.start, self.parameter: value / factor if self.above else value * factor}

    def factors(self, fit: Fit) -> tuple[float, float]:
        """The smallest and the largest factor at which the strength is one that a search tries."""
        name = f"{self.variant.effect}.{self.parameter}"
        axis = Coordinates((name,), fit.fitter.nominal, fit.fitter.data.duration).axes[0]
        own = abs(self.start[self.parameter])
        low, high = max(axis.value(axis.lower), 1e-12 * own), axis.value(axis.upper)
        return (own / high, own / low) if self.above else (low / own, high / own)


@dataclass(frozen=True)
class Seen:
    """What the recordings say of an effect: its `limit`, if any, and the evidence that it could leave at most."""

    limit: Limit | None
    mark: float


def seen(fit: Fit, candidates: Sequence[tuple[Variant, list[dict[str, float]]]], pool: Executor) -> dict[str, Seen]:
    """What the recordings say of each effect among the `candidates` that a `fit`, with all drifts free, has not.

    `candidates` are ways to act with their starts, as `inference.shortlist.forms` gives them.
    """
    _ = fit.basis
    cases: dict[str, list[Case]] = {}
    for variant, starts in candidates:
        strengths = [name for name in EFFECT[variant.effect].strength if name in variant.free]
        if variant.effect not in fit.explanation.effects and len(strengths) == 1:
            few = spaced(apart(starts, variant, strengths[0], fit.fitter.nominal.scales))
            cases.setdefault(variant.effect, []).extend(Case(variant, start, strengths[0]) for start in few)
    found = pool.map(lambda several: _of_effect(fit, several), cases.values())
    return {effect: each for effect, each in zip(cases, found, strict=True) if each is not None}


def apart(starts: Sequence[Start], variant: Variant, strength: str, scales: Scales) -> list[Start]:
    """The starts whose other numbers are plausible, all if none are; what differs in `strength` alone is one start."""
    declared = {name: EFFECT[variant.effect].parameter(name).expected(scales) for name in variant.free}
    several = {
        tuple(value for name, value in start.items() if name != strength): start
        for start in starts
        if start[strength] != 0.0
    }.values()
    likely = [
        start
        for start in several
        if all(low <= start[name] <= high for name, (low, high) in declared.items() if name != strength)
    ]
    return likely or list(several)


def spaced(starts: Sequence[Start]) -> list[Start]:
    """`EXAMINED` of some starts, as far apart as they are listed."""
    number = min(len(starts), EXAMINED)
    return [starts[round(place)] for place in np.linspace(0.0, len(starts) - 1, number)]


def _of_effect(fit: Fit, cases: Sequence[Case]) -> Seen | None:
    """The weakest limit and the largest mark over the ways in which one effect may act by one of its strengths.

    The parameters follow the weakest by further steps, and by fits: the others are excluded before it.
    """
    every = [(case, _linear(fit, case, 1.0)) for case in cases if case.parameter == cases[0].parameter]
    known = [(case, each) for case, each in every if each is not None]
    if not known:
        return None
    mark = max(each.mark for _, each in known)
    if len(known) < len(every):
        return Seen(None, mark)
    weakest = min if cases[0].above else max
    case, linear = weakest(known, key=lambda each: abs(each[0].at(each[1].factor)[each[0].parameter]))
    return Seen(_followed(fit, case, linear), mark)


@dataclass(frozen=True)
class _Linear:
    """The factor of a start that a linear step of the parameters excludes, infinite for none, with its mark.

    A fit that leaves less than the chi2 `possible` allows the factor.
    """

    factor: float
    mark: float
    possible: float = math.inf


def _linear(fit: Fit, case: Case, factor: float) -> _Linear | None:
    """The strength that a linear step from one at a `factor` excludes; None where the effect cannot be added."""
    least, largest = case.factors(fit)
    left, counts_as_one = beside(fit.fitted, fit.basis), fit.repetition * max(fit.ratio**2, 1.0)
    allowed = ONE_SIDED * counts_as_one + excess(fit) * fit.fitted.size
    change = _change(fit, case, factor)
    if change is None:
        return None
    size = float(change @ change)
    if size <= 0.0:
        return _Linear(math.inf, 0.0)
    best = max(-float(change @ left) / size, 0.0)
    following = max(best + math.sqrt(allowed / size), least)
    excluded = following if following <= largest else math.inf
    return _Linear(excluded, size / counts_as_one, fit.chi2 - size * best**2 + allowed)


def _followed(fit: Fit, case: Case, linear: _Linear) -> Limit | None:
    """The limit that holds although the parameters follow by short fits; None where nothing is excluded."""
    factor, (_, largest) = linear.factor, case.factors(fit)
    for _ in range(STRENGTHS_TRIED):
        further = _linear(fit, case, factor) if math.isfinite(factor) else None
        if further is None:
            return None
        settled = abs(math.log(further.factor / factor)) < SETTLED
        linear, factor = further, further.factor
        if settled:
            break
    for _ in range(RAISED):
        if factor > largest:
            break
        if not _fits(fit, case, factor, linear.possible):
            return _limit(fit, case, factor)
        factor *= WIDENED
    return None


def _change(fit: Fit, case: Case, factor: float) -> np.ndarray | None:
    """What a unit of the factor changes in the residual beside all parameters; None where there is no such model."""
    fitter = fit.fitter
    try:
        models = fitter.models(fit.explanation, in_order(_values(fit, case, factor), fitter.nominal))
    except InputError:
        return None
    change = (fitter.residual(*models)[fitter.data.train] - fit.residual[fitter.data.train]) / factor
    return beside(change, fit.basis)


def _values(fit: Fit, case: Case, factor: float) -> dict[str, float]:
    """All values with the effect at a factor of its start, its other numbers as there."""
    return added(fit.values, case.variant, case.at(factor))


def _fits(fit: Fit, case: Case, factor: float, possible: float) -> bool:
    """Whether parameters, and the effect's other numbers, can make a strength possible: a short fit is below a chi2."""
    effect, strength = EFFECT[case.variant.effect], case.parameter
    if any(parameter.above for parameter in effect.parameters):
        # what is counted from a parameter would vanish in a fit of that parameter
        return False
    held = case.variant.holding(strength, case.at(factor)[strength])
    values = in_order(_values(fit, case, factor), fit.fitter.nominal)
    try:
        beside = fit.fitter.fit(fit.explanation.plus(held), values, FOLLOWING)
    except InputError:
        return False
    return beside.chi2 <= possible


def _limit(fit: Fit, case: Case, factor: float) -> Limit | None:
    """The strength at a factor, counted from the fit; None where it is beyond what is declared."""
    declared = EFFECT[case.variant.effect].parameter(case.parameter)
    value = _values(fit, case, factor)[f"{case.variant.effect}.{case.parameter}"]
    if not declared.minimum <= value <= declared.maximum:
        return None
    return Limit(case.variant.effect, case.parameter, abs(value), case.above)
