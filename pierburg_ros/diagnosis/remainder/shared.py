"""Physics that several recordings share, where no explanation accounts for all: chosen on recordings left out.

A real actuator lacks more than one thing, and with a low noise floor nothing is ever adequate. An effect is
then believed if, fitted on the other recordings, it lowers the error on the recordings left out. What remains counts
by its independent stretches, not by its samples, so that what is known of the values beforehand has its say.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.deadline import Deadline, OutOfTime
from pierburg_ros.diagnosis.search.candidates import starts_of
from pierburg_ros.diagnosis.search.found import Found
from pierburg_ros.diagnosis.search.linear import promised
from pierburg_ros.diagnosis.search.race import ROUNDS
from pierburg_ros.diagnosis.search.screening import STARTS_TRIED
from pierburg_ros.diagnosis.search.tried import Progress
from pierburg_ros.effects import EFFECT
from pierburg_ros.effects.effect import Start
from pierburg_ros.estimation.data import Data, all_training, rms
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.estimation.explanation import Explanation, canonical
from pierburg_ros.estimation.likelihood import repetition
from pierburg_ros.estimation.prior import improbability
from pierburg_ros.plant import Model
from pierburg_ros.workers import workers

FOLDS = 4
"""Parts into which the recordings are divided, each left out in turn. Work: every effect looked at is fitted once more
for each part; not varied."""
TRIED = 6
"""Candidates of each round that are held against recordings left out. Work: each costs `FOLDS` brief descents; not
varied."""
SETTLING = 3
"""How often a fit is carried on, each time against what the one before left. Work: each is a whole fit; not varied."""
BETTER = 0.9
"""Share of the error on recordings left out to which an effect must bring it where a simulation begins again and again.
Given: a name only where unseen recordings improve by a tenth."""
MOST = 5
"""Most effects that recordings left out may confirm. Work: splits of real runs (n = 4) ended at three or fewer."""


@dataclass(frozen=True)
class LeftOut:
    """What recordings left out of the fit say of an effect.

    Their error [measured unit], the geometric mean of root mean squares, `without` it and `beside` those added before,
    in how many of the `parts` it `helped`, and the names of the recordings in these.
    """

    without: float
    beside: float
    helped: int
    parts: int
    recordings: tuple[str, ...] = ()


Map = Callable[..., Iterable[Any]]
Folds = list[tuple[Data, Data]]
"""Pairs of what is fitted and what is left out."""


@dataclass(frozen=True)
class _Parts:
    """What a fit leaves of each part when it is fitted to the others: RMSE [noise] and independent stretches, shape
    (parts,); and how improbable its values are, in -2 log probability."""

    errors: Signal
    stretches: Signal
    improbable: float

    @property
    def mean(self) -> float:
        """Geometric mean of the errors: a part whose error is large in any case does not decide alone."""
        return float(np.exp(np.mean(np.log(self.errors))))


@dataclass(frozen=True)
class _Round:
    """A fit with the effects that have been added so far, and what it leaves of recordings left out."""

    fit: Fit
    parts: _Parts


Shared = tuple[Fit, dict[str, LeftOut]]
"""A fit with effects, and what recordings left out say of each, by id."""


def shared_effects(
    found: Found, progress: Progress, jobs: int | None = None, deadline: Deadline | None = None
) -> Shared:
    """A fit with the effects that each lower the error on recordings left out, added one by one.

    The parameters that recordings tell apart are fitted beside them, from their nominal values and from the
    recalibrated ones, as far as what remains speaks against what was known of them. At the `deadline` it is what
    stood then; OutOfTime where that is nothing.
    """
    rounds: list[_Round] = []
    deadline = deadline or Deadline()
    with workers(jobs, deadline) as pool:
        deadline.attempt(lambda: rounds.extend(_rounds(found, pool, progress)), None)
    if not rounds:
        raise OutOfTime
    said = {
        after.fit.explanation.variants[-1].effect: _left_out(found.data, before.parts, after.parts)
        for before, after in pairwise(rounds)
    }
    return rounds[-1].fit, said


def _rounds(found: Found, pool: Executor, progress: Progress) -> Iterator[_Round]:
    """The fit without effects, and one more for each that is added."""
    data, nominal, recalibrated = all_training(found.data), found.nominal, found.recalibrated
    folds, starts = _folds(data), (nominal.values, recalibrated.values)
    settled = pool.map(lambda start: _settled(data, nominal, recalibrated.explanation, start), starts)
    chosen = min(settled, key=lambda fit: fit.ratio)
    parts = _parts(nominal, folds, chosen, pool.map)
    yield _Round(chosen, parts)
    while len(chosen.explanation.variants) < MOST:
        tasks = _tasks(found, data, chosen)
        fits = _grown(data, nominal, chosen, tasks, pool)
        left_out = list(pool.map(lambda fit: _parts(nominal, folds, fit), fits))
        gains = [_gain(parts, each) for each in left_out]
        best = int(np.argmax(gains))
        progress(fits[best].explanation.label)
        if gains[best] <= _by_chance(len(tasks)) or _needless(data, parts, left_out[best]):
            break
        chosen = _settled(data, nominal, fits[best].explanation, fits[best].values)
        parts = _parts(nominal, folds, chosen, pool.map)
        yield _Round(chosen, parts)


def _needless(data: Data, before: _Parts, after: _Parts) -> bool:
    """Whether recordings left out hardly improve where a simulation begins again and again.

    An error is forgotten there with each stretch, so it is no luck if it is small, and counts by itself.
    """
    return any(run.shooting for run in data.runs) and after.mean > BETTER * before.mean


def _believing(data: Data, nominal: Model, residual: Signal) -> Estimator:
    """What counts a residual like this [noise] as its independent stretches, beside what is known of the values."""
    size = max(rms(residual), 1.0)
    return Estimator(data, nominal, unit=size * math.sqrt(repetition(residual)))


def _settled(data: Data, nominal: Model, explanation: Explanation, start: Mapping[str, float]) -> Fit:
    """The fit carried on until what it leaves is what it is counted against; its residual in noises."""
    plain = Estimator(data, nominal)
    fit = plain.at(explanation, start)
    for _ in range(SETTLING):
        fit = plain.restated(_believing(data, nominal, fit.solution.residual).fit(explanation, fit.values))
    return fit


def _folds(data: Data) -> Folds:
    count = min(FOLDS, data.runs[-1].number + 1)
    pairs = []
    for fold in range(count):
        left = tuple(run for run in data.runs if run.number % count == fold)
        rest = tuple(run for run in data.runs if run.number % count != fold)
        pairs.append((replace(data, runs=rest), replace(data, runs=left)))
    return pairs


def _by_chance(candidates: int) -> float:
    """What the best of so many candidates gains in -2 log likelihood if none of them acts: about the largest of as many
    squares of normal variables."""
    return 2.0 * math.log(candidates)


def _grown(
    data: Data, nominal: Model, chosen: Fit, tasks: Sequence[tuple[Explanation, Sequence[Start]]], pool: Executor
) -> list[Fit]:
    """First fits with one more effect, the best of all that may be added."""
    seen = pool.map(lambda task: _brief_fit(data, nominal, chosen, task), tasks)
    return sorted((fit for fit in seen if fit), key=lambda fit: fit.chi2)[:TRIED]


def _tasks(found: Found, data: Data, chosen: Fit) -> list[tuple[Explanation, Sequence[Start]]]:
    """What may be added, with its starts: effects that belong to one recording's time cannot be shared."""
    grown = ((chosen.explanation.plus(variant), starts) for variant, starts in starts_of(data, chosen.model).items())
    return [
        (explanation, starts)
        for explanation, starts in grown
        if not EFFECT[explanation.variants[-1].effect].dated and canonical(explanation, found.drifts) is not None
    ]


def _brief_fit(data: Data, nominal: Model, chosen: Fit, task: tuple[Explanation, Sequence[Start]]) -> Fit | None:
    """The best of the first fits of what may be added, from the starts that a linear step promises most."""
    grown, starts = task
    best = promised(Estimator(data, nominal), chosen, grown.variants[-1], starts)[:STARTS_TRIED]
    believing = _believing(data, nominal, chosen.solution.residual)
    fits = [believing.fit(grown, {**chosen.values, **start}, ROUNDS) for _, start in best]
    return min(fits, key=lambda fit: fit.chi2) if fits else None


def _parts(nominal: Model, folds: Folds, fit: Fit, over: Map = map) -> _Parts:
    def left_of(fold: tuple[Data, Data]) -> tuple[float, float]:
        fitted, left = fold
        believing = _believing(fitted, nominal, fitted.residual(fit.model))
        residual = left.residual(believing.fit(fit.explanation, fit.values, ROUNDS).model)
        return rms(residual), residual.size / repetition(residual)

    errors, stretches = zip(*over(left_of, folds), strict=True)
    coordinates = Estimator(folds[0][0], nominal).coordinates(fit.explanation)
    rows = improbability(coordinates, coordinates.point(fit.values))
    return _Parts(np.array(errors), np.array(stretches), float(rows @ rows))


def _gain(smaller: _Parts, larger: _Parts) -> float:
    """What the parts left out and the prior say for the larger explanation, in -2 log likelihood.

    Each stretch that says something new counts as one sample of a normal variable whose size is not known.
    """
    told = larger.stretches @ np.log(smaller.errors / larger.errors)
    return float(2.0 * told + smaller.improbable - larger.improbable)


def _left_out(data: Data, before: _Parts, after: _Parts) -> LeftOut:
    """What the parts left out said of an effect when it was added."""
    helped = after.errors < before.errors
    told = zip(_folds(data), helped, strict=True)
    recordings = tuple(name for (_, left), helps in told if helps for name in _names(left))
    return LeftOut(before.mean * data.noise, after.mean * data.noise, int(np.sum(helped)), helped.size, recordings)


def _names(data: Data) -> list[str]:
    """Names of the recordings."""
    return list({run.number: run.name for run in data.runs}.values())
