"""The strength that recordings exclude at 95 %, of every effect that is not named and able to act."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.deadline import Deadline
from pierburg_ros.diagnosis.limits.held import Case, Held
from pierburg_ros.diagnosis.search.candidates import starts_of
from pierburg_ros.diagnosis.search.found import Found
from pierburg_ros.diagnosis.search.linear import difference, projection
from pierburg_ros.diagnosis.search.together import INDEPENDENT
from pierburg_ros.diagnosis.search.tried import Progress, staged
from pierburg_ros.effects import EFFECT
from pierburg_ros.effects.effect import Start
from pierburg_ros.estimation.data import with_validation
from pierburg_ros.estimation.discrepancy import Kalman
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.estimation.explanation import Explanation
from pierburg_ros.estimation.least_squares import BRIEF, FULL
from pierburg_ros.estimation.likelihood import TIED
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
AS_FORESEEN = 0.1
"""Share of the foreseen rise up to which a simulation may miss what linear steps foresee, as a sum of squares, for that
to set the limit. Derived: where the rise is what is allowed it is off by 2 sqrt(0.1) + 0.1 at most, 0.73 of itself,
and the strength by sqrt(1.73), which is less than `WIDENED`."""
WIDENED = 1.5
"""Factor by which a strength grows that a fit of the other parameters has shown to be possible after all. Chosen: a
limit is then at most so much too cautious; not varied."""
ATTEMPTS = 6
"""Strengths at which the others are fitted before the effect counts as not excluded. Work: each costs half a brief
descent; together up to 58 times the linear estimate."""

SHARE, LEAST = 0.25, 5.0
"""Time that limits take at most, as a share of that before them, and [s] in any case. Work: they take 1 to 3 s, but
where an effect makes the model chatter one of them took 75 s after a search of 3 s; not varied."""


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
class _Foreseen:
    """What linear steps foresee of a case: the factor on its strength that is excluded, and what is there.

    A unit of the factor makes a `change` of the residual. With what the base parameters do to follow it, the `residual`
    there has a chi2 that is just `possible`: `allowed` above the least for any strength. Factors beyond the `largest`
    are not looked at.
    """

    case: Case
    factor: float
    change: Signal
    residual: Signal
    possible: float
    allowed: float
    largest: float

    @property
    def rise(self) -> float:
        """How far chi2 rises above its least: by more than is allowed at the least strength that is looked at."""
        return _squared(self.residual) - self.possible + self.allowed

    def missed(self, fit: Fit) -> float:
        """The sum of squares by which a fit there misses what is foreseen."""
        return _squared(fit.solution.residual - self.residual)


def limits(
    found: Found,
    final: Fit,
    progress: Progress = lambda _: None,
    jobs: int | None = None,
    deadline: Deadline | None = None,
) -> Limits:
    """The limit of every effect that `final` does not name, where these recordings set one.

    The strength is raised until the likelihood has fallen by what 95 % allows, while the base parameters that the
    recordings tell apart follow (profile likelihood): linearly, and fitted where a simulation at the limit shows that
    this is not enough. What `final` leaves is part of the likelihood, as a discrepancy. Of several places, rhythms or
    phases at which an effect may act, the weakest limit counts. At the `deadline`, or once they have taken their share
    of the time, those found by then are kept.
    """
    deadline = deadline or Deadline()
    own = deadline.at_most(max(SHARE * deadline.spent, LEAST))
    strengths: dict[tuple[str, str], list[Case]] = {}
    for case in _cases(found, final):
        if case.variant.effect not in final.explanation.effects:
            strengths.setdefault((case.variant.effect, case.parameter), []).append(case)
    # what takes longest begins first: a simulation that is stiff, or stops and goes
    slow_first = sorted(strengths, key=lambda key: not (EFFECT[key[0]].jumps or strengths[key][0].above))
    tested: dict[tuple[str, str], Limit | None] = {}
    tell = staged(progress, "what is ruled out", len(strengths))

    def test() -> None:
        with workers(jobs, own) as pool:
            estimator, base = next(iter(pool.map(lambda final: _base(found, final), [final])))

            def limit(key: tuple[str, str]) -> None:
                tell(f"limit of {key[0]}")
                tested[key] = _limit(estimator, base, strengths[key])

            for _ in pool.map(limit, slow_first):
                pass

    own.attempt(test, None)
    set_by = [limit for key in strengths if (limit := tested.get(key)) is not None]
    missing = dict.fromkeys(effect for effect, parameter in strengths if (effect, parameter) not in tested)
    return Limits(set_by, list(missing))


def _limit(estimator: Estimator, base: Fit, cases: Sequence[Case]) -> Limit | None:
    """The weakest limit among the ways in which an effect may act by one strength."""
    foreseen = [_foreseen(estimator, base, case) for case in cases]
    known = [each for each in foreseen if each is not None]
    if len(known) < len(foreseen):
        return None
    weakest = max(known, key=lambda each: each.case.strength(each.factor))
    return _confirmed(estimator, base, weakest)


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


def _cases(found: Found, final: Fit) -> Iterator[Case]:
    """Each way to act with a single strength, from starts spread over all there are; one of nothing cannot grow.

    Behind a filter of the input, whose time the recording itself tells, what is late has no limit: the filter may be
    shorter.
    """
    for variant, starts in starts_of(found.data, final.model).items():
        effect = EFFECT[variant.effect]
        strengths = [name for name in effect.strength if name in variant.free]
        if len(strengths) == 1 and not (effect.late and found.data.input_filtered):
            for start in _spread([start for start in starts if start[strengths[0]] != 0.0]):
                yield Case(variant, start, strengths[0])


def _spread(starts: Sequence[Start]) -> Sequence[Start]:
    stride = max(math.ceil(len(starts) / STARTS), 1)
    return starts[::stride]


def _allowed(case: Case, base: Fit) -> float:
    """Rise of chi2 within which a strength is possible."""
    return (TIED if EFFECT[case.variant.effect].jumps else ONE_SIDED) * max(base.ratio**2, 1.0)


def _foreseen(estimator: Estimator, base: Fit, case: Case) -> _Foreseen | None:
    """At what strength of a start it is excluded while the base parameters follow linearly; None where at none.

    A change that goes by the strength, s u, leaves (r - s u)^2: least at u r / u^2, and by the square root of what is
    allowed beyond that over the norm of u it is excluded. A strength too small for a search is not looked at, since it
    may take the simulator for ever; nor is one too large.
    """
    projected = projection(base)
    residual = projected(base.solution.residual)
    least, largest = case.factors(estimator.nominal, estimator.data.duration)
    allowed, factor = _allowed(case, base), 1.0
    for _ in range(STEPS):
        changed = difference(estimator, base, case.variant, case.at(factor))
        if changed is None:
            return None
        change = changed / factor
        unit = projected(change)
        size = float(unit @ unit)
        if size * factor**2 < 1e-6:
            return None
        best = max(float(unit @ residual) / size, 0.0)
        following = max(best + math.sqrt(allowed / size), least)
        if following > largest:
            return None
        settled = abs(math.log(following / factor)) < 0.1
        factor = following
        if settled:
            break
    possible = base.chi2 - size * best**2 + allowed
    return _Foreseen(case, factor, change, base.solution.residual - factor * unit, possible, allowed, largest)


def _moved(base: Fit, change: Signal) -> Signal:
    """How the base parameters follow a change of the residual: not where next to nothing tells them apart."""
    slopes = base.solution.jacobian
    scale = np.maximum(np.linalg.norm(slopes, axis=0), 1e-300)
    return np.asarray(np.linalg.lstsq(slopes / scale, change, rcond=INDEPENDENT)[0] / scale)


def _confirmed(estimator: Estimator, base: Fit, foreseen: _Foreseen) -> Limit | None:
    """The limit where the base parameters do not make the strength possible; None where they always do."""
    case = foreseen.case
    held = Held(estimator, base, case)
    value = held.value(_factor(held, base, foreseen))
    return None if value is None else Limit(case.variant.effect, case.parameter, abs(value), case.above)


def _factor(held: Held, base: Fit, foreseen: _Foreseen) -> float:
    """The factor on the strength that is excluded, infinite where none is.

    One simulation tells whether all is as foreseen; if not, fits of the base parameters do.
    """
    way = _moved(base, foreseen.change)
    still = np.zeros_like(way)
    there = held.fit(foreseen.factor, way, 0)
    if there is not None and (missed := foreseen.missed(there)) < AS_FORESEEN * foreseen.rise:
        short = max(foreseen.possible - there.chi2 + missed, 0.0)
        return foreseen.factor * math.sqrt(1.0 + short / foreseen.allowed)
    unmoved = held.fit(foreseen.factor, still, 0)
    nearer = there is not None and (unmoved is None or there.chi2 <= unmoved.chi2)
    return _excluded(held, foreseen, way if nearer else still)


def _excluded(held: Held, foreseen: _Foreseen, way: Signal) -> float:
    """The factor at which the others do not make the strength possible, infinite where they always do.

    Of a strength that is possible they tell in what way they go for a larger one, and how much larger it may be. Where
    a descent on that way ends early, one on the `way` that is foreseen, or from where they are, may not.
    """
    factor, ways, possible, excluded = foreseen.factor, [way], 0.0, math.inf
    for _ in range(ATTEMPTS):
        fit = held.nearest(factor, ways, BRIEF // 2 if len(ways) == 1 else FULL, foreseen.possible)
        if fit is not None and fit.chi2 > foreseen.possible:
            excluded = factor
        else:
            possible, growth = factor, WIDENED
            if fit is not None:
                rise = max(foreseen.allowed - (foreseen.possible - fit.chi2), 1e-300)
                growth = min(max(math.sqrt(foreseen.allowed / rise), WIDENED), WIDENED**2)
                ways = [held.way(fit, factor), way, np.zeros_like(way)]
        if excluded <= WIDENED * possible or (math.isfinite(excluded) and possible == 0.0):
            break
        factor = math.sqrt(possible * excluded) if math.isfinite(excluded) else possible * growth
        if factor > foreseen.largest:
            break
    return excluded


def _squared(signal: Signal) -> float:
    return float(signal @ signal)
