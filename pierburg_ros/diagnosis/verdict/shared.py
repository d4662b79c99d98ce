"""Physics that several recordings share, where no explanation accounts for all: chosen on recordings left out.

A real actuator lacks more than one thing, and with a low noise floor nothing is ever adequate. An effect is
then believed if, fitted on the other recordings, it lowers the error on the recordings left out.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace

import numpy as np
from threadpoolctl import threadpool_limits

from pierburg_ros.arrays import Signal
from pierburg_ros.diagnosis.evidence.data import EvidenceData, rms
from pierburg_ros.diagnosis.report.words import by_recordings_left_out
from pierburg_ros.diagnosis.search.candidates import starts_of
from pierburg_ros.diagnosis.search.explanation import Explanation, Variant, canonical, without
from pierburg_ros.diagnosis.search.explore import BRIEF, Exploration
from pierburg_ros.diagnosis.search.fits import Fit, Search
from pierburg_ros.diagnosis.verdict.conclusion import Support
from pierburg_ros.effects import EFFECTS
from pierburg_ros.effects.effect import Start

FOLDS = 4
"""Parts into which the recordings are divided, each left out in turn."""
LOOKED_AT = 6
"""Candidates of each round that are judged on recordings left out."""
WORTH = 0.85
"""An effect must bring the error on recordings left out below this share of what it was."""
MOST = 5
"""Most effects chosen."""
OWN_TIME = frozenset(effect.id for effect in EFFECTS if effect.dated)
"""Effects that belong to one recording's time and cannot be shared."""


@dataclass(frozen=True)
class Shared:
    """The chosen fit, and what speaks for each of its effects by id."""

    fit: Fit
    supports: dict[str, Support]


def select(exploration: Exploration, start: Fit) -> Shared:
    """Effects on top of `start` that lower the error on recordings left out, one by one.

    Its parameters are fitted again from there and from their nominal values: what blocks do not tell apart may have
    led them astray.
    """
    data = _whole(exploration.data)
    search = Search(data, exploration.nominal)
    folds = _folds(data)
    with threadpool_limits(1), ThreadPoolExecutor(2) as pool:
        settled = (_settled(search, fit) for fit in (start, search.fit(start.explanation)))
        chosen = min(settled, key=lambda fit: fit.chi2)
        error = rms(_left_out(search, folds, chosen))
        while len(chosen.explanation.variants) < MOST:
            tasks = _tasks(exploration, data, chosen)
            seen = pool.map(_look, itertools.repeat(search), itertools.repeat(chosen), tasks)
            looks = sorted((fit for fit in seen if fit), key=lambda fit: fit.chi2)[:LOOKED_AT]
            left_out = pool.map(_left_out, itertools.repeat(search), itertools.repeat(folds), looks)
            best, fit = min(zip(map(rms, left_out), looks, strict=True), key=lambda pair: pair[0])
            exploration.progress(fit.explanation.label)
            if best > WORTH * error:
                break
            error, chosen = best, _settled(search, fit)
        beside = _left_out(search, folds, chosen)
        supported = pool.map(lambda lost: _support(search, folds, chosen, lost, beside), chosen.explanation.variants)
        return Shared(chosen, dict(zip(chosen.explanation.effects, supported, strict=True)))


def _settled(search: Search, fit: Fit) -> Fit:
    """The fit carried on until it is at rest: twice, since its damping starts afresh."""
    return search.fit(fit.explanation, search.fit(fit.explanation, fit.values).values)


def _whole(data: EvidenceData) -> EvidenceData:
    """The data with every sample training: whole recordings are left out instead of blocks."""
    return replace(data, runs=tuple(run.trained_on(np.ones_like(run.training)) for run in data.runs))


def _folds(data: EvidenceData) -> list[tuple[EvidenceData, EvidenceData]]:
    """Pairs of what is fitted and what is left out."""
    count = min(FOLDS, len(data.runs))
    pairs = []
    for fold in range(count):
        left = tuple(run for i, run in enumerate(data.runs) if i % count == fold)
        rest = tuple(run for i, run in enumerate(data.runs) if i % count != fold)
        pairs.append((replace(data, runs=rest), replace(data, runs=left)))
    return pairs


def _tasks(exploration: Exploration, data: EvidenceData, chosen: Fit) -> list[tuple[Explanation, Sequence[Start]]]:
    tasks = []
    for variant, starts in starts_of(data, chosen.model).items():
        grown = chosen.explanation.plus(variant)
        if variant.free and variant.effect not in OWN_TIME and canonical(grown, exploration.drifts) is not None:
            tasks.append((grown, starts))
    return tasks


def _look(search: Search, chosen: Fit, task: tuple[Explanation, Sequence[Start]]) -> Fit | None:
    grown, starts = task
    promised = search.screened(chosen, grown.variants[-1], starts)[:2]
    fits = [search.fit(grown, {**chosen.values, **start}, BRIEF) for _, start in promised]
    return min(fits, key=lambda fit: fit.chi2) if fits else None


def _left_out(search: Search, folds: list[tuple[EvidenceData, EvidenceData]], fit: Fit) -> Signal:
    """RMSE of each part of the recordings, simulated by a fit to the others, measured unit, shape (parts,)."""
    errors = []
    for fitted, left in folds:
        own = Search(fitted, search.nominal).fit(fit.explanation, fit.values, BRIEF)
        errors.append(rms(left.residual(own.model)) * search.data.noise)
    return np.array(errors)


def _support(
    search: Search, folds: list[tuple[EvidenceData, EvidenceData]], chosen: Fit, variant: Variant, beside: Signal
) -> Support:
    """What the recordings left out say of an effect: in how many parts it helps beside the others.

    `beside` are the errors of the parts with all effects. Few parts leave doubt, so the confidence is that of
    Laplace's rule of succession.
    """
    bare = _settled(search, replace(chosen, explanation=without(chosen.explanation, variant)))
    lacking = _left_out(search, folds, bare)
    helped, parts = int(np.sum(beside < lacking)), len(folds)
    unit = search.data.actuator.unit
    reason = by_recordings_left_out(rms(lacking), rms(beside), unit, helped, parts)
    return Support((helped + 1) / (parts + 2), reason)
