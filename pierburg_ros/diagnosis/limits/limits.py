"""The strength that recordings exclude at 95 %, of every effect that is not named and able to act."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from pierburg_ros.deadline import Deadline
from pierburg_ros.diagnosis.search.candidates import starts_of
from pierburg_ros.diagnosis.search.found import Found
from pierburg_ros.diagnosis.search.linear import difference, projection
from pierburg_ros.diagnosis.search.tried import Progress, staged
from pierburg_ros.effects import EFFECT
from pierburg_ros.effects.effect import Start
from pierburg_ros.errors import InputError
from pierburg_ros.estimation.coordinates import Coordinates
from pierburg_ros.estimation.data import with_validation
from pierburg_ros.estimation.discrepancy import Kalman
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.estimation.explanation import Explanation, Variant
from pierburg_ros.estimation.least_squares import BRIEF
from pierburg_ros.estimation.likelihood import TIED
from pierburg_ros.plant import Model
from pierburg_ros.workers import workers

ONE_SIDED = 2.71
"""Rise of chi2 at a strength that is excluded with 95 %, to one side. Derived: the square of 1.645, the 95 % quantile
of the normal distribution."""
STARTS = 6
"""Starts of one way to act that are scanned: places, rhythms, phases. Work: each costs up to `STEPS` simulations; not
varied."""
STEPS = 4
"""Strengths that are simulated for one start. Derived: the rise goes by about the square of the strength, so each
simulation tells the next one; four come within a tenth wherever that holds to a third."""
WIDENED = 1.5
"""Factor by which a strength grows that a fit of the other parameters has shown to be possible after all. Chosen: a
limit is then at most so much too cautious; not varied."""
ATTEMPTS = 5
"""How often it grows before the effect counts as not excluded. Work: each costs half a brief descent; 7.6 times the
linear estimate."""


@dataclass(frozen=True)
class Limit:
    """The strength of an effect from which on it contradicts the recordings with 95 %.

    `value` of its `parameter`, in the parameter's unit. `above`: the effect is the stronger the smaller its parameter
    (a stiffness), so that the truth lies above the value and not below.
    """

    effect: str
    parameter: str
    value: float
    above: bool


@dataclass(frozen=True)
class Limits:
    """The limits found, and the ids of effects for whose limits there was no time."""

    found: Sequence[Limit] = ()
    untested: Sequence[str] = ()


@dataclass(frozen=True)
class _Case:
    """One way in which an effect may act: its variant, a start, and the parameter of it that is its strength."""

    variant: Variant
    start: Start
    parameter: str

    @property
    def above(self) -> bool:
        """Whether a smaller value makes it stronger."""
        return EFFECT[self.variant.effect].parameter(self.parameter).inverse

    def at(self, factor: float) -> Start:
        """The start with its strength multiplied."""
        value = self.start[self.parameter]
        return {**self.start, self.parameter: value / factor if self.above else value * factor}

    def factors(self, nominal: Model, duration: float) -> tuple[float, float]:
        """The least and the largest factor at which the strength is within what a search would look at."""
        axis = Coordinates((f"{self.variant.effect}.{self.parameter}",), nominal, duration).axes[0]
        own = abs(self.start[self.parameter])
        low, high = max(axis.value(axis.lower), 0.0), axis.value(axis.upper)
        return (own / high, own / low) if self.above else (low / own, high / own)


def limits(
    found: Found,
    final: Fit,
    progress: Progress = lambda _: None,
    jobs: int | None = None,
    deadline: Deadline | None = None,
) -> Limits:
    """The limit of every effect that `final` does not name, where these recordings set one.

    The strength is raised until the likelihood has fallen by what 95 % allows, while the base parameters that the
    recordings tell apart follow: linearly first, and at the limit by a fit (profile likelihood). What `final` leaves is
    part of the likelihood, as a discrepancy. Of several places, rhythms or phases at which an effect may act, the
    weakest limit counts. At the `deadline` those found by then are kept.
    """
    deadline = deadline or Deadline()
    strengths: dict[tuple[str, str], list[_Case]] = {}
    for case in _cases(found, final):
        if case.variant.effect not in final.explanation.effects:
            strengths.setdefault((case.variant.effect, case.parameter), []).append(case)
    # a simulation takes the longer the stiffer, and what takes longest begins first
    stiff_first = sorted(strengths, key=lambda key: not strengths[key][0].above)
    tested: dict[tuple[str, str], Limit | None] = {}
    tell = staged(progress, "what is ruled out", len(strengths))

    def test() -> None:
        with workers(jobs, deadline) as pool:
            estimator, base = next(iter(pool.map(lambda final: _base(found, final), [final])))

            def limit(key: tuple[str, str]) -> None:
                tell(f"limit of {key[0]}")
                tested[key] = _limit(estimator, base, strengths[key])

            for _ in pool.map(limit, stiff_first):
                pass

    deadline.attempt(test, None)
    set_by = [limit for key in strengths if (limit := tested.get(key)) is not None]
    missing = dict.fromkeys(effect for effect, parameter in strengths if (effect, parameter) not in tested)
    return Limits(set_by, list(missing))


def _limit(estimator: Estimator, base: Fit, cases: Sequence[_Case]) -> Limit | None:
    """The weakest limit among the ways in which an effect may act by one strength."""
    factors = [(case, _linear(estimator, base, case)) for case in cases]
    return _confirmed(estimator, base, *max(factors, key=lambda pair: _strength(*pair)))


def _base(found: Found, final: Fit) -> tuple[Estimator, Fit]:
    """`final` with all base parameters free that the recordings tell apart, and the likelihood that limits go by."""
    data = with_validation(found.data)
    residual = data.residual(final.model, final.switch)
    discrepancy = Kalman(data, data.train).most_likely(residual)
    estimator = Estimator(data, found.nominal, discrepancy=discrepancy)
    own = final.explanation
    free = {*own.drifted, *found.recalibrated.explanation.drifted} - {own.changed}
    variants = tuple(variant for variant in own.variants if EFFECT[variant.effect].rounds is None)
    explanation = Explanation(tuple(name for name in found.drifts if name in free), variants, own.changed)
    return estimator, estimator.fit(explanation, final.values, BRIEF)


def _cases(found: Found, final: Fit) -> Iterator[_Case]:
    """Each way to act with a single strength, from starts spread over all there are; one of nothing cannot grow.

    Behind a filter of the input, whose time the recording itself tells, what is late has no limit: the filter may be
    shorter.
    """
    for variant, starts in starts_of(found.data, final.model).items():
        effect = EFFECT[variant.effect]
        strengths = [name for name in effect.strength if name in variant.free]
        if len(strengths) == 1 and not (effect.late and found.data.input_filtered):
            for start in _spread([start for start in starts if start[strengths[0]] != 0.0]):
                yield _Case(variant, start, strengths[0])


def _spread(starts: Sequence[Start]) -> Sequence[Start]:
    stride = max(math.ceil(len(starts) / STARTS), 1)
    return starts[::stride]


def _strength(case: _Case, factor: float) -> float:
    """Size of the strength at a factor, larger where the effect is stronger."""
    value = abs(case.at(factor)[case.parameter])
    return 1.0 / max(value, 1e-300) if case.above else value


def _allowed(case: _Case, base: Fit) -> float:
    """Rise of chi2 within which a strength is possible."""
    return (TIED if EFFECT[case.variant.effect].jumps else ONE_SIDED) * max(base.ratio**2, 1.0)


def _linear(estimator: Estimator, base: Fit, case: _Case) -> float:
    """Factor on the strength of a start at which it is excluded while the base parameters follow linearly.

    Infinite where no strength is. A change that goes by the strength, s u, leaves (r - s u)^2: least at u r / u^2, and
    by the square root of what is allowed beyond that over the norm of u it is excluded. A strength too small for a
    search is not looked at, since it may take the simulator for ever; nor is one too large.
    """
    projected = projection(base)
    residual = projected(base.solution.residual)
    least, largest = case.factors(estimator.nominal, estimator.data.duration)
    allowed, factor = _allowed(case, base), 1.0
    for _ in range(STEPS):
        changed = difference(estimator, base, case.variant, case.at(factor))
        if changed is None:
            return math.inf
        unit = projected(changed) / factor
        size = float(unit @ unit)
        if size * factor**2 < 1e-6:
            return math.inf
        best = max(float(unit @ residual) / size, 0.0)
        following = max(best + math.sqrt(allowed / size), least)
        if following > largest:
            return math.inf
        if abs(math.log(following / factor)) < 0.1:
            return following
        factor = following
    return factor


def _confirmed(estimator: Estimator, base: Fit, case: _Case, factor: float) -> Limit | None:
    """The limit where a fit of the base parameters does not make the strength possible; None where it always does."""
    effect = EFFECT[case.variant.effect]
    declared = effect.parameter(case.parameter)
    allowed = _allowed(case, base)
    for _ in range(ATTEMPTS if math.isfinite(factor) else 0):
        own = {f"{effect.id}.{name}": value for name, value in (*case.at(factor).items(), *case.variant.fixed)}
        values = effect.counted(own, base.model.values)
        value = values[f"{effect.id}.{case.parameter}"]
        if not declared.minimum <= value <= declared.maximum:
            return None
        if _excluded(estimator, base, case, values, allowed):
            return Limit(effect.id, case.parameter, abs(value), case.above)
        factor *= WIDENED
    return None


def _excluded(estimator: Estimator, base: Fit, case: _Case, values: dict[str, float], allowed: float) -> bool:
    """Whether the fit of all but an effect at given `values` stays worse than `base` by more than is allowed."""
    fixed = tuple((name.partition(".")[2], value) for name, value in values.items())
    held = Variant(case.variant.effect, (), fixed)
    explanation = Explanation(base.explanation.drifted, (*base.explanation.variants, held), base.explanation.changed)
    try:
        possible, slopes = base.chi2 + allowed, base.solution.jacobian
        start = {**base.values, **values}
        fit = estimator.fit(explanation, start, BRIEF // 2, slopes=slopes, enough=possible)
    except InputError:
        return False
    return fit.chi2 > possible
