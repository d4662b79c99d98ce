"""Physics that several recordings share, where no explanation accounts for all: chosen on recordings left out.

A real actuator lacks more than one thing, and with a low noise floor nothing is ever adequate. An effect is
then believed if, fitted on the other recordings, it lowers the error on the recordings left out.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.diagnosis.search.candidates import starts_of
from pierburg_ros.diagnosis.search.found import Found
from pierburg_ros.diagnosis.search.linear import promised
from pierburg_ros.diagnosis.search.race import ROUNDS
from pierburg_ros.diagnosis.search.tried import Progress
from pierburg_ros.effects import EFFECT
from pierburg_ros.effects.effect import Start
from pierburg_ros.estimation.data import Data, all_training, rms
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.estimation.explanation import Explanation, Variant, canonical, without

FOLDS = 4
"""Parts into which the recordings are divided, each left out in turn. Work: every effect looked at is fitted once more
for each part; not varied."""
TRIED = 6
"""Candidates of each round that are held against recordings left out. Work: each costs `FOLDS` brief descents; not
varied."""
WORTH = 0.85
"""An effect must bring the error on recordings left out below this share of what it was. Chosen: more than the tenth
by which errors differ anyway; not varied. The one test is a servo's n = 8 runs."""
MOST = 5
"""Most effects that recordings left out may confirm. Work: splits of real runs (n = 4) ended at three or fewer."""


@dataclass(frozen=True)
class LeftOut:
    """What recordings left out of the fit say of an effect.

    Their root-mean-square error [measured unit] `without` it and `beside` the others with it, and in how many of the
    `parts` it `helped`.
    """

    without: float
    beside: float
    helped: int
    parts: int


Folds = list[tuple[Data, Data]]
"""Pairs of what is fitted and what is left out."""


def shared_effects(found: Found, pool: Executor, progress: Progress) -> tuple[Fit, dict[str, LeftOut]]:
    """A fit with the effects that each lower the error on recordings left out, and what speaks for each, by id.

    They are added one by one.

    The parameters are fitted again from the recalibrated ones and from their nominal values: what blocks do not tell
    apart may have led them astray.
    """
    data = all_training(found.data)
    estimator, folds = Estimator(data, found.nominal), _folds(data)
    settled = (
        _settled(estimator, start) for start in (found.recalibrated, estimator.fit(found.recalibrated.explanation))
    )
    chosen = min(settled, key=lambda fit: fit.chi2)
    error = rms(_errors(estimator, folds, chosen))
    while len(chosen.explanation.variants) < MOST:
        tasks = _tasks(found, data, chosen)
        seen = pool.map(_brief_fit, itertools.repeat(estimator), itertools.repeat(chosen), tasks)
        fits = sorted((fit for fit in seen if fit), key=lambda fit: fit.chi2)[:TRIED]
        left_out = pool.map(_errors, itertools.repeat(estimator), itertools.repeat(folds), fits)
        best, fit = min(zip(map(rms, left_out), fits, strict=True), key=lambda pair: pair[0])
        progress(fit.explanation.label)
        if best > WORTH * error:
            break
        error, chosen = best, _settled(estimator, fit)
    beside = _errors(estimator, folds, chosen)
    variants = chosen.explanation.variants
    said = pool.map(lambda lost: _left_out(estimator, folds, chosen, lost, beside), variants)
    return chosen, dict(zip(chosen.explanation.effects, said, strict=True))


def _settled(estimator: Estimator, fit: Fit) -> Fit:
    """The fit carried on until it is at rest: twice, since its damping starts afresh."""
    return estimator.fit(fit.explanation, estimator.fit(fit.explanation, fit.values).values)


def _folds(data: Data) -> Folds:
    count = min(FOLDS, data.runs[-1].number + 1)
    pairs = []
    for fold in range(count):
        left = tuple(run for run in data.runs if run.number % count == fold)
        rest = tuple(run for run in data.runs if run.number % count != fold)
        pairs.append((replace(data, runs=rest), replace(data, runs=left)))
    return pairs


def _tasks(found: Found, data: Data, chosen: Fit) -> list[tuple[Explanation, Sequence[Start]]]:
    """What may be added, with its starts: effects that belong to one recording's time cannot be shared."""
    grown = ((chosen.explanation.plus(variant), starts) for variant, starts in starts_of(data, chosen.model).items())
    return [
        (explanation, starts)
        for explanation, starts in grown
        if not EFFECT[explanation.variants[-1].effect].dated and canonical(explanation, found.drifts) is not None
    ]


def _brief_fit(estimator: Estimator, chosen: Fit, task: tuple[Explanation, Sequence[Start]]) -> Fit | None:
    grown, starts = task
    best = promised(estimator, chosen, grown.variants[-1], starts)[:2]
    fits = [estimator.fit(grown, {**chosen.values, **start}, ROUNDS) for _, start in best]
    return min(fits, key=lambda fit: fit.chi2) if fits else None


def _errors(estimator: Estimator, folds: Folds, fit: Fit) -> Signal:
    """RMSE of each part of the recordings, simulated by a fit to the others, measured unit, shape (parts,)."""
    errors = []
    for fitted, left in folds:
        own = Estimator(fitted, estimator.nominal).fit(fit.explanation, fit.values, ROUNDS)
        errors.append(rms(left.residual(own.model)) * estimator.data.noise)
    return np.array(errors)


def _left_out(estimator: Estimator, folds: Folds, chosen: Fit, variant: Variant, beside: Signal) -> LeftOut:
    """What the parts left out say of an effect; `beside` are their errors with all effects."""
    bare = _settled(estimator, replace(chosen, explanation=without(chosen.explanation, variant)))
    lacking = _errors(estimator, folds, bare)
    return LeftOut(rms(lacking), rms(beside), int(np.sum(beside < lacking)), len(folds))
