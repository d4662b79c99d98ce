"""The strength that recordings exclude at 95 %, of every effect that can act and is not named."""

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
from pierburg_ros.estimation.likelihood import TIED
from pierburg_ros.inference.explanation import Explanation
from pierburg_ros.inference.least_squares import BRIEF, FULL
from pierburg_ros.workers import workers

ONE_SIDED = 2.71
"""Rise of chi2 at a strength that is excluded at 95 %, one-sided. Derived: the square of 1.645, the 95 % quantile of
the normal distribution."""
STARTS = 6
"""Number of starts that are scanned for one way to act: places, frequencies, phases. Work: each costs up to `STEPS`
simulations; not varied."""
STEPS = 4
"""Number of strengths that are simulated for one start. Derived: chi2 rises about with the square of the strength, so
each simulation gives the next strength. Four come within a tenth wherever this law holds to a third."""
AS_FORESEEN = 0.1
"""Largest sum of squares by which a simulation may deviate from the linear prediction that sets the limit, as a share
of the predicted rise. Derived: where the rise is the allowed one, its error is at most 2 sqrt(0.1) + 0.1, 0.73 of the
rise. The strength is then off by sqrt(1.73), which is less than `WIDENED`."""
WIDENED = 1.5
"""Factor by which a strength is raised after a fit of the other parameters has shown it to be possible. Chosen: a limit
is then too cautious by this factor at most; not varied."""
ATTEMPTS = 6
"""Strengths at which the other parameters are fitted before the effect counts as not excluded. Work: each costs half a
brief descent; together they reach up to 58 times the linear estimate."""

SHARE, LEAST = 0.25, 5.0
"""Time that the limits may take: a share of the time before them, or [s] if that is more. Work: they take 1 to 3 s. One
limit took 75 s after a search of 3 s, because the effect made the model chatter; not varied."""


@dataclass(frozen=True)
class Limit:
    """The strength of an effect from which it contradicts the recordings at 95 %.

    `value` is that of its `parameter`, in the parameter's unit. `above`: the effect is stronger if its parameter (a
    stiffness) is smaller, so the true value lies above `value` and not below.
    """

    effect: str
    parameter: str
    value: float
    above: bool


@dataclass(frozen=True)
class Limits:
    """The limits found, and the ids of effects whose limits were not tested for lack of time."""

    found: Sequence[Limit] = ()
    untested: Sequence[str] = ()


@dataclass(frozen=True)
class _Foreseen:
    """The linear prediction for a case: the factor on its strength that is excluded, and the residual there.

    A unit of the factor makes a `change` of the residual, and the base parameters are refitted linearly. The `residual`
    at the factor then has a chi2 that is just `possible`: `allowed` above the least for any strength. Factors beyond
    the `largest` are not tested.
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
        """Rise of chi2 above its least; more than `allowed` if the factor is the smallest that is tested."""
        return _squared(self.residual) - self.possible + self.allowed

    def missed(self, fit: Fit) -> float:
        """Sum of squares by which the residual of a fit there deviates from the prediction."""
        return _squared(fit.solution.residual - self.residual)


def limits(
    found: Found,
    final: Fit,
    progress: Progress = lambda _: None,
    jobs: int | None = None,
    deadline: Deadline | None = None,
) -> Limits:
    """The limit of every effect that `final` does not name, where these recordings set one.

    The search raises the strength until the likelihood has fallen by what 95 % allows (profile likelihood). The base
    parameters that the recordings distinguish are refitted linearly, and by a fit where a simulation at the limit shows
    that this is not enough. What `final` leaves is part of the likelihood, as a discrepancy. If an effect may act at
    several places, frequencies or phases, the weakest limit counts. At the `deadline`, or once the limits have taken
    their share of the time, those found by then are kept.
    """
    deadline = deadline or Deadline()
    own = deadline.at_most(max(SHARE * deadline.spent, LEAST))
    strengths: dict[tuple[str, str], list[Case]] = {}
    for case in _cases(found, final):
        if case.variant.effect not in final.explanation.effects:
            strengths.setdefault((case.variant.effect, case.parameter), []).append(case)
    # the slowest begin first: simulations that are stiff, or that stop and go
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
    """The weakest limit over the ways in which an effect may act by one strength; None where one way has none."""
    foreseen = [_foreseen(estimator, base, case) for case in cases]
    known = [each for each in foreseen if each is not None]
    if len(known) < len(foreseen):
        return None
    weakest = max(known, key=lambda each: each.case.strength(each.factor))
    return _confirmed(estimator, base, weakest)


def _base(found: Found, final: Fit) -> tuple[Estimator, Fit]:
    """The estimator with the likelihood for limits, and `final` with all base parameters free that the recordings
    distinguish."""
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
    """Each way to act with a single strength, from starts spread over all; a start of strength 0 cannot grow and is
    left out.

    If the input was recorded behind a filter, the recording itself gives the filter's time. An effect that acts late
    then has no limit: the filter may be shorter.
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
    """Rise of chi2 up to which a strength is possible."""
    return (TIED if EFFECT[case.variant.effect].jumps else ONE_SIDED) * max(base.ratio**2, 1.0)


def _foreseen(estimator: Estimator, base: Fit, case: Case) -> _Foreseen | None:
    """The strength of a start that is excluded while the base parameters are refitted linearly; None where none is.

    A change s u, proportional to the strength s, leaves (r - s u)^2, least at s = u r / u^2. A strength is excluded if
    it is larger by the square root of the allowed rise over the norm of u. A strength too small for a search is not
    tested, since it may take the simulator for ever. A strength too large for it is not tested either.
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
    """The linear change of the base parameters after a change of the residual; directions hardly distinguished stay
    unchanged."""
    slopes = base.solution.jacobian
    scale = np.maximum(np.linalg.norm(slopes, axis=0), 1e-300)
    return np.asarray(np.linalg.lstsq(slopes / scale, change, rcond=INDEPENDENT)[0] / scale)


def _confirmed(estimator: Estimator, base: Fit, foreseen: _Foreseen) -> Limit | None:
    """The limit, if the base parameters do not make the strength possible; None where they always do."""
    case = foreseen.case
    held = Held(estimator, base, case)
    value = held.value(_factor(held, base, foreseen))
    return None if value is None else Limit(case.variant.effect, case.parameter, abs(value), case.above)


def _factor(held: Held, base: Fit, foreseen: _Foreseen) -> float:
    """The factor on the strength that is excluded; infinite where none is.

    One simulation tests the linear prediction. If it deviates, fits of the base parameters find the factor.
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
    """The factor at which the other parameters do not make the strength possible; infinite where they always do.

    A fit at a possible strength gives the direction in which the others follow, and how much larger the strength may
    be. A descent in that direction may end early. Further ones then start along the predicted `way`, and from the
    unmoved parameters.
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
