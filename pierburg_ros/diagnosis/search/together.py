"""Parameters that drift together: as many as recordings distinguish, then as few as fit equally well.

A description made of guesses is wrong in more numbers than can be added one by one. A quantity that is added before
they are right makes up for their errors.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from concurrent.futures import Executor

import numpy as np
from scipy.linalg import qr

from pierburg_ros.arrays import Flags, Signal
from pierburg_ros.diagnosis.search.attempts import Attempts, far_below
from pierburg_ros.diagnosis.search.needed import needed
from pierburg_ros.estimation.estimator import Estimator, Fit, adequate
from pierburg_ros.inference.explanation import Explanation, Variant, without

INDEPENDENT = 1e-3
"""Share of a parameter's change of the signal that the other parameters cannot make; below it, the parameter adds
nothing. Derived: one-sided differences of 0.05 % show an exact tie as up to 5e-4."""
FEWER = 4
"""Number of combinations of fewer drifting parameters that are fitted at each count, the best by a linear step. Work:
each is a full fit; not varied."""
Begun = tuple[Explanation, dict[str, float]]
"""An explanation and the values from which it is fitted."""


def drift_together(attempts: Attempts) -> bool:
    """Let all parameters drift that recordings distinguish; gives whether an adequate explanation is found.

    Effects are added as long as each leaves far less error. Then only as many parameters drift as have to. If a
    remainder of any shape could replace one of the effects, they have only adapted to it, and are forgotten.
    """
    best = attempts.keep(recalibrated(attempts, attempts.pool))
    while not adequate(best):
        larger = min(_with_an_effect(best, attempts), key=lambda fit: fit.chi2, default=best)
        if not adequate(larger) and not far_below(larger, best):
            return False
        best = larger
    if needed(best, attempts, attempts.pool) is not best:
        attempts.forget_deeper()
        return False
    _in_the_place_of_two(_with_fewer(best, attempts), attempts)
    return True


def recalibrated(attempts: Attempts, pool: Executor) -> Fit:
    """The nominal structure with as many of its parameters re-estimated as the recordings distinguish.

    The fits start from the nominal values and from the best fit so far with drifts only.
    """
    estimator = attempts.whole
    explanation = drifting_apart(estimator, attempts.drifts)
    starts = [attempts.nominal.values, attempts.least_drifted(but=explanation).values]
    fits = [*pool.map(lambda start: estimator.fit(explanation, start), starts), attempts.fits.get(explanation)]
    return min(filter(None, fits), key=lambda fit: fit.chi2)


def _with_an_effect(seed: Fit, attempts: Attempts) -> list[Fit]:
    """Full fits of the effects that are most promising on top of `seed`."""
    acting = [each for each in attempts.screened(seed) if isinstance(each.addition, Variant)]
    return attempts.race(acting, most=attempts.beam.ahead // 3)


def _with_fewer(best: Fit, attempts: Attempts) -> Fit:
    """Fit the effects of an adequate `best` with ever fewer drifts; gives the last fit that is adequate."""
    for count in range(len(best.explanation.drifted) - 1, -1, -1):
        begins = drifting_fewer(best, attempts.whole, attempts.drifts, count)[:FEWER]
        fewer = min(attempts.pool.map(lambda begin: attempts.add(*begin), begins), key=lambda fit: fit.chi2)
        if not adequate(fewer):
            break
        best = fewer
    return best


def _in_the_place_of_two(best: Fit, attempts: Attempts) -> None:
    """Fit the most promising additions in place of any two drifts of `best`: one effect may do what both do."""
    pairs = list(itertools.combinations(best.explanation.drifted, 2))
    if best.explanation.size > 2 and pairs:
        rests = (without(without(best.explanation, one), other) for one, other in pairs)
        attempts.fit_most_promising([attempts.add(rest, best.values) for rest in rests])


def drifting_apart(estimator: Estimator, drifts: Sequence[str]) -> Explanation:
    """As many of the `drifts` as the recordings distinguish, by their changes of the signal at nominal values."""
    jacobian = estimator.at(Explanation(tuple(drifts))).solution.jacobian
    marks = jacobian / np.maximum(np.linalg.norm(jacobian, axis=0), 1e-12)
    _, triangle, order = qr(marks, mode="economic", pivoting=True)
    count = int(np.sum(np.abs(np.diag(triangle)) > INDEPENDENT))
    names = {drifts[index] for index in order[:count]}
    return Explanation(tuple(name for name in drifts if name in names))


def drifting_fewer(fit: Fit, estimator: Estimator, drifts: Sequence[str], count: int) -> list[Begun]:
    """The effects of a `fit` with only `count` of the `drifts`, the best combinations first.

    All combinations are evaluated by one linear step at the values of the fit. The other parameters return to nominal;
    those in the combination, and the effects, make up for it. The combination with the least growth of the residual is
    best. In logarithms this is exact for parameters that the recordings show only by their products and ratios.
    """
    everything = Explanation(tuple(drifts), fit.explanation.variants)
    at, coordinates = estimator.at(everything, fit.values), estimator.coordinates(everything)
    begin = at.solution.point
    back = coordinates.point(estimator.nominal.values) - begin
    triangle = np.asarray(qr(at.solution.jacobian, mode="r")[0])[: begin.size]
    found: list[tuple[float, Begun]] = []
    for chosen in itertools.combinations(range(len(drifts)), count):
        free = np.arange(begin.size) >= len(drifts)
        free[list(chosen)] = True
        step, growth = _returned(triangle, back, free)
        values = coordinates.values(np.clip(begin + step, *coordinates.bounds))
        own = Explanation(tuple(everything.drifted[place] for place in chosen), everything.variants)
        found.append((growth, (own, {**estimator.nominal.values, **values})))
    return [each for _, each in sorted(found, key=lambda one: one[0])]


def needless(fit: Fit, estimator: Estimator, worth: float) -> tuple[str, ...]:
    """The drifts of a `fit` by this `estimator` that may return to nominal for less than `worth` each, in chi2.

    They return one after another, the one that costs least first, by one linear step of all others.
    """
    explanation = fit.explanation
    back = estimator.coordinates(explanation).point(estimator.nominal.values) - fit.solution.point
    triangle = np.asarray(qr(fit.solution.jacobian, mode="r")[0])[: back.size]
    drifted, free = explanation.drifted, np.ones(back.size, dtype=bool)
    for count in range(1, len(drifted) + 1):
        left = [int(place) for place in np.flatnonzero(free[: len(drifted)])]
        growths = {place: _returned(triangle, back, free & (np.arange(back.size) != place))[1] for place in left}
        least = min(left, key=lambda place: growths[place])
        if growths[least] >= worth * count:
            break
        free[least] = False
    return tuple(name for name, kept in zip(drifted, free, strict=False) if not kept)


def _returned(triangle: Signal, back: Signal, free: Flags) -> tuple[Signal, float]:
    """The linear step in which all but the `free` quantities go `back`, and how chi2 grows; shapes (quantities,)."""
    step = np.where(free, 0.0, back)
    if free.any():
        step[free] = np.linalg.lstsq(triangle[:, free], -triangle @ step, rcond=None)[0]
    return step, float(np.sum(np.square(triangle @ step)))
