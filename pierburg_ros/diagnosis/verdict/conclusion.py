"""What the exploration amounts to: the verdict, the model, and the fits it is held against."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import qr

from pierburg_ros.diagnosis.evidence.data import EvidenceData, Switch, after_choice, rms
from pierburg_ros.diagnosis.report.words import by_evidence, by_grid
from pierburg_ros.diagnosis.schema import Verdict
from pierburg_ros.diagnosis.search.candidates import is_rough
from pierburg_ros.diagnosis.search.explanation import Explanation, Variant
from pierburg_ros.diagnosis.search.explore import Exploration
from pierburg_ros.diagnosis.search.fits import Fit, Search, repetition
from pierburg_ros.diagnosis.search.intervals import Estimate, estimates
from pierburg_ros.diagnosis.search.refinement import polished
from pierburg_ros.diagnosis.search.selection import EXPLAINED
from pierburg_ros.diagnosis.verdict.ties import Alternative, alternatives, explore_alternatives
from pierburg_ros.effects import ROUNDING, STEP
from pierburg_ros.plant import Model

INDEPENDENT = 1e-3
"""A parameter whose mark in the signal, beyond those of the others, is smaller than this share of its own adds none."""


@dataclass(frozen=True)
class Support:
    """Why an effect is believed, and how far: between 0 and 1."""

    confidence: float
    reason: str


@dataclass(frozen=True)
class Conclusion:
    """The chosen fit with its alternatives, and the nominal and recalibrated ones it is held against.

    `final` is the chosen explanation with its last values, `estimates` with their intervals; `supports` goes by the ids
    of its effects.
    """

    verdict: Verdict
    chosen: Fit
    final: Fit
    nominal: Fit
    recalibrated: Fit
    alternatives: list[Alternative]
    estimates: dict[str, Estimate]
    supports: dict[str, Support]


def conclude(exploration: Exploration) -> Conclusion:
    """What an exploration that has been run amounts to."""
    explore_alternatives(exploration, exploration.preferred())
    chosen = exploration.preferred()
    tied = alternatives(exploration, chosen)
    final, known = settled(exploration, chosen) if chosen.ratio <= EXPLAINED else (chosen, {})
    if step := exploration.data.step:
        chosen, final = rounded(chosen, step), rounded(final, step)
        exploration.fits[chosen.explanation] = chosen
    return Conclusion(
        verdict_on(chosen),
        chosen,
        final,
        exploration.fits[Explanation()],
        recalibrated(exploration),
        tied,
        known,
        {variant.effect: _support(exploration, chosen, variant) for variant in chosen.explanation.variants},
    )


def settled(exploration: Exploration, chosen: Fit) -> tuple[Fit, dict[str, Estimate]]:
    """The chosen explanation fitted to all samples but those that judge, and its intervals.

    Where the cost is rough, it is looked over again: a fit may account for all in a dent beside the lowest.
    """
    search = Search(after_choice(exploration.data), exploration.nominal)
    fit = search.fit(chosen.explanation, chosen.values)
    if is_rough(fit.explanation):
        exploration.progress(f"{fit.explanation.label}, last values")
        fit = polished(search, fit)
    return fit, estimates(search, fit)


def rounded(fit: Fit, step: float) -> Fit:
    """`fit` with its model's samples rounded to `step`; what it leaves is that of the smooth one."""
    variant = Variant(ROUNDING.id, (), ((STEP.removeprefix(f"{ROUNDING.id}."), step),))
    values = {STEP: step}
    switch = fit.switch and replace(fit.switch, model=fit.switch.model.with_values(values))
    model = fit.model.with_values(values)
    return replace(
        fit, explanation=fit.explanation.plus(variant), values={**fit.values, **values}, model=model, switch=switch
    )


def _support(exploration: Exploration, chosen: Fit, variant: Variant) -> Support:
    if not variant.free:
        return Support(1.0, by_grid())
    return Support(_confidence(exploration, chosen, variant), by_evidence(_gain(exploration, chosen, variant)))


def _gain(exploration: Exploration, chosen: Fit, variant: Variant) -> float:
    """How many effective chi2 the best explanation without an effect, of the same size or less, lacks."""
    rivals = [
        fit
        for fit in exploration.fits.values()
        if variant.effect not in fit.explanation.effects and fit.explanation.size <= chosen.explanation.size
    ]
    return (min(fit.misfit for fit in rivals) - chosen.misfit) / repetition(chosen)


def _confidence(exploration: Exploration, chosen: Fit, variant: Variant) -> float:
    """Weight of the explanations with an effect among all of the chosen size, each weighing exp(-chi2 / 2)."""
    weights = {True: 0.0, False: 0.0}
    for fit in exploration.fits.values():
        if fit.explanation.size == chosen.explanation.size:
            lag = max((fit.misfit - chosen.misfit) / repetition(chosen), 0.0)
            weights[variant.effect in fit.explanation.effects] += math.exp(-0.5 * min(lag, 1400.0))
    return weights[True] / (weights[True] + weights[False])


def verdict_on(chosen: Fit) -> Verdict:
    """The verdict that a chosen explanation stands for."""
    if chosen.ratio > EXPLAINED:
        return "unexplained"
    if chosen.explanation.variants:
        return "missing_physics"
    return "parameter_drift" if chosen.explanation.size else "consistent"


def recalibrated(exploration: Exploration) -> Fit:
    """The nominal structure with as many of its parameters re-estimated as the recordings tell apart."""
    nominal = exploration.search.fit(Explanation(exploration.drifts), None, 0)
    marks = nominal.solution.jacobian / np.maximum(np.linalg.norm(nominal.solution.jacobian, axis=0), 1e-12)
    _, triangle, order = qr(marks, mode="economic", pivoting=True)
    count = int(np.sum(np.abs(np.diag(triangle)) > INDEPENDENT))
    names = {exploration.drifts[index] for index in order[:count]}
    explanation = Explanation(tuple(name for name in exploration.drifts if name in names))
    best_drift = min(
        (fit for fit in exploration.fits.values() if not fit.explanation.variants and not fit.explanation.changed),
        key=lambda fit: fit.chi2,
    )
    starts = [exploration.nominal.values, best_drift.values]
    return min((exploration.search.fit(explanation, start) for start in starts), key=lambda fit: fit.chi2)


def rmse(data: EvidenceData, model: Model, switch: Switch | None, training: bool) -> float | None:
    """Root mean squared error on training or on judging samples, measured unit; None where there are none."""
    residual = data.residual(model, switch)[data.training if training else data.judging]
    return rms(residual) * data.noise if residual.size else None
