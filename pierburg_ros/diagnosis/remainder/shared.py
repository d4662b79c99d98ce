"""Physics that several recordings share, where no explanation accounts for all: chosen on recordings left out.

A model of a real actuator lacks more than one effect, and with a low noise floor no explanation is ever adequate. The
search then accepts an effect if, fitted on the other recordings, it lowers the error on the recordings left out. The
residual counts by its independent stretches, not by its samples, so that the prior of the values keeps its influence.
The same score removes an effect again if effects added later make it superfluous: it had replaced them. An effect that
adapts easily replaces others with values that no actuator has. The search then rejects it, whatever it gains.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass

import numpy as np

from pierburg_ros.deadline import Deadline, OutOfTime
from pierburg_ros.diagnosis.remainder.left_out import (
    Folds,
    LeftOut,
    Parts,
    believing,
    folds_of,
    gain,
    helps,
    parts_of,
    said_of,
)
from pierburg_ros.diagnosis.search.candidates import starts_of
from pierburg_ros.diagnosis.search.found import Found
from pierburg_ros.diagnosis.search.linear import promised
from pierburg_ros.diagnosis.search.race import ROUNDS
from pierburg_ros.diagnosis.search.screening import STARTS_TRIED
from pierburg_ros.diagnosis.search.tried import Progress
from pierburg_ros.effects import EFFECT
from pierburg_ros.effects.effect import Start
from pierburg_ros.estimation.data import Data, all_training
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.estimation.refinement import lowered
from pierburg_ros.inference.explanation import Explanation, canonical, without
from pierburg_ros.plant import Model
from pierburg_ros.workers import workers

TRIED = 6
"""Candidates of each round that are tested on recordings left out. Work: each costs as many brief descents as there are
parts; not varied."""
SETTLING = 3
"""How often a fit is continued, each time weighted by the residual of the one before. Work: each is a whole fit; not
varied."""


@dataclass(frozen=True)
class Round:
    """A fit with the effects added so far, and its error on recordings left out.

    `said` is the evidence of these for each effect when it was added, by id.
    """

    fit: Fit
    parts: Parts
    said: Mapping[str, LeftOut]


@dataclass(frozen=True)
class Bench:
    """The recordings, all training and also divided into parts; the model that is extended; the workers that fit."""

    data: Data
    folds: Folds
    nominal: Model
    pool: Executor

    def settled(self, explanation: Explanation, start: Mapping[str, float]) -> Fit:
        """The fit, repeated so that its weights match the residual that it leaves; its residual is in units of the
        noise.

        Each time it goes to the lowest local minimum near by. Values along a valley that recordings hardly distinguish
        predict other recordings differently.
        """
        plain = Estimator(self.data, self.nominal)
        fit = plain.at(explanation, start)
        for _ in range(SETTLING):
            counting = believing(self.data, self.nominal, fit.solution.residual)
            fit = plain.restated(lowered(counting, counting.fit(explanation, fit.values)))
        return fit

    def best(self, explanation: Explanation, starts: Sequence[Mapping[str, float]]) -> Fit:
        """The best of the settled fits from some starts."""
        return min(self.pool.map(lambda start: self.settled(explanation, start), starts), key=lambda fit: fit.ratio)

    def parts(self, fit: Fit) -> Parts:
        """The error of a fit on recordings left out."""
        return parts_of(self.nominal, self.folds, fit, self.pool.map)


Shared = tuple[Fit, dict[str, LeftOut]]
"""A fit with effects, and the evidence of recordings left out for each, by id."""


def shared_effects(
    found: Found, progress: Progress, jobs: int | None = None, deadline: Deadline | None = None
) -> Shared:
    """A fit with the effects that each lower the error on recordings left out, added one by one.

    Effects that the others make superfluous are removed again. The parameters that recordings distinguish are fitted
    beside them, from their nominal and from the recalibrated values. They leave their prior values only as far as the
    residual requires. At the `deadline` the last round is returned; OutOfTime where there is none.
    """
    rounds: list[Round] = []
    deadline = deadline or Deadline()
    data = all_training(found.data)
    with workers(jobs, deadline) as pool:
        bench = Bench(data, folds_of(data), found.nominal, pool)
        deadline.attempt(lambda: rounds.extend(_rounds(bench, found, progress)), None)
    if not rounds:
        raise OutOfTime
    return rounds[-1].fit, dict(rounds[-1].said)


def _rounds(bench: Bench, found: Found, progress: Progress) -> Iterator[Round]:
    """The fit without effects, and one more for each effect that is added; a removed effect does not come back."""
    last = _first(bench, found)
    yield last
    added = set[str]()
    while tasks := [task for task in _tasks(bench, found, last.fit) if task[0].effects[-1] not in added]:
        tried = [(bench.parts(fit), fit) for fit in _grown(bench, last.fit, tasks)]
        believed = [each for each in tried if each[0].plausible and helps(last.parts, each[0], len(tasks))]
        if not believed:
            break
        _, fit = max(believed, key=lambda each: gain(last.parts, each[0]))
        progress(fit.explanation.label)
        added.add(fit.explanation.effects[-1])
        larger = _with_last(bench, last, fit)
        if larger.parts.plausible:
            last = thinned(bench, larger, len(tasks))
            yield last


def _first(bench: Bench, found: Found) -> Round:
    """The round without effects."""
    fit = bench.best(found.recalibrated.explanation, (found.nominal.values, found.recalibrated.values))
    return Round(fit, bench.parts(fit), {})


def _with_last(bench: Bench, before: Round, grown: Fit) -> Round:
    """The round in which the last effect of `grown` is added.

    The parameters start from their present and from their nominal values: they may have adapted to the missing effect.
    """
    fit = bench.best(grown.explanation, (grown.values, undrifted(grown, bench.nominal)))
    parts = bench.parts(fit)
    said = said_of(bench.folds, before.parts, parts)
    return Round(fit, parts, {**before.said, grown.explanation.effects[-1]: said})


def undrifted(fit: Fit, nominal: Model) -> dict[str, float]:
    """The values of a fit, with nominal values for all drifted parameters, also those of effects that the actuator
    always has."""
    own = fit.explanation
    return {**fit.values, **{name: nominal.values[name] for name in own.drifted}}


def thinned(bench: Bench, whole: Round, candidates: int) -> Round:
    """A round without the effects that no longer help beside those added later; the one with the least gain goes
    first."""
    earlier = whole.fit.explanation.variants[:-1]
    if not earlier:
        return whole
    smaller = [without(whole.fit.explanation, variant) for variant in earlier]
    fits = list(bench.pool.map(lambda explanation: bench.settled(explanation, whole.fit.values), smaller))
    parts = [bench.parts(fit) for fit in fits]
    gains = [gain(each, whole.parts) for each in parts]
    least = int(np.argmin(gains))
    if helps(parts[least], whole.parts, candidates):
        return whole
    said = {effect: told for effect, told in whole.said.items() if effect != earlier[least].effect}
    return thinned(bench, Round(fits[least], parts[least], said), candidates)


def _grown(bench: Bench, chosen: Fit, tasks: Sequence[tuple[Explanation, Sequence[Start]]]) -> list[Fit]:
    """First fits with one more effect: the best of all that may be added, best first."""
    seen = bench.pool.map(lambda task: _brief_fit(bench, chosen, task), tasks)
    return sorted((fit for fit in seen if fit), key=lambda fit: fit.chi2)[:TRIED]


def _tasks(bench: Bench, found: Found, chosen: Fit) -> list[tuple[Explanation, Sequence[Start]]]:
    """The explanations with one more effect, and its starts; effects tied to the time of one recording cannot be
    shared."""
    variants = starts_of(bench.data, chosen.model).items()
    grown = ((chosen.explanation.plus(variant), starts) for variant, starts in variants)
    return [
        (explanation, starts)
        for explanation, starts in grown
        if not EFFECT[explanation.variants[-1].effect].dated and canonical(explanation, found.drifts) is not None
    ]


def _brief_fit(bench: Bench, chosen: Fit, task: tuple[Explanation, Sequence[Start]]) -> Fit | None:
    """The best of the first fits with one more effect, from the starts for which a linear step promises most."""
    grown, starts = task
    best = promised(Estimator(bench.data, bench.nominal), chosen, grown.variants[-1], starts)[:STARTS_TRIED]
    counting = believing(bench.data, bench.nominal, chosen.solution.residual)
    fits = [counting.fit(grown, {**chosen.values, **start}, ROUNDS) for _, start in best]
    return min(fits, key=lambda fit: fit.chi2) if fits else None
