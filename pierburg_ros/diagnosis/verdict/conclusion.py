"""The result of a search: the verdict, the model, and the fits it is compared with. Nothing is fitted here."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from pierburg_ros.diagnosis.remainder.left_out import LeftOut
from pierburg_ros.diagnosis.remainder.remainder import Remainder
from pierburg_ros.diagnosis.remainder.shape import Shape
from pierburg_ros.diagnosis.schema import Verdict
from pierburg_ros.diagnosis.search.found import Found
from pierburg_ros.diagnosis.search.weighing import Weight
from pierburg_ros.diagnosis.verdict.ties import Alternative, alternatives
from pierburg_ros.effects import ROUNDING, STEP
from pierburg_ros.estimation.estimator import Fit, adequate
from pierburg_ros.estimation.intervals import Estimate
from pierburg_ros.estimation.likelihood import OFF_GRID
from pierburg_ros.inference.explanation import Explanation, Variant
from pierburg_ros.plant import Model

FEWEST = 2.0**-8
"""Smallest step of a converter that is named beside a remainder, as a share of what is large for the sensor. Chosen:
eight bits, fewer than converters in use have; finer steps are far below the remainder. Not varied."""


@dataclass(frozen=True)
class Support:
    """How far an effect is believed, between 0 and 1, and the numbers that support it.

    `without` is the best explanation without it, of as many quantities or fewer. `gain` is by how much that fits worse
    in chi2, in effective samples. `left_out` is the evidence of recordings left out of the fit. `weight` is the
    effect's weight beside a remainder. All are None where the effect is detected in the samples themselves.
    """

    confidence: float
    gain: float | None = None
    without: Fit | None = None
    left_out: LeftOut | None = None
    weight: Weight | None = None


@dataclass(frozen=True)
class Conclusion:
    """The chosen fit with its alternatives, and the nominal and recalibrated fits it is compared with.

    `final` is the chosen explanation with its last values, `estimates` holds their intervals, and `supports` goes by
    the ids of its effects. `doubted` are the effects that are not probable enough to be named beside a
    remainder. `shape` is the rest as a torque, if that is confirmed.
    """

    verdict: Verdict
    chosen: Fit
    final: Fit
    nominal: Fit
    recalibrated: Fit
    alternatives: list[Alternative]
    estimates: dict[str, Estimate]
    supports: Mapping[str, Support]
    shape: Shape | None = None
    doubted: Mapping[str, Weight] = field(default_factory=dict)

    @property
    def model(self) -> Model:
        """The corrected model: with the named physics, and the shape of the rest where there is one."""
        return self.final.model if self.shape is None else self.shape.model


def conclude(found: Found, rest: Remainder | None = None) -> Conclusion:
    """The conclusion of a search, with what is known of the `rest` where no explanation accounts for all."""
    verdict, nominal = verdict_on(found.chosen), found.fits[Explanation()]
    if rest is not None:
        supports = {effect: _by_recordings(left_out) for effect, left_out in rest.left_out.items()}
        supports.update({effect: Support(weight.confidence, weight=weight) for effect, weight in rest.weights.items()})
        base, shape, step = rest.base, rest.shape, _coarse(found)
        if step:
            base, supports[ROUNDING.id] = _rounded(base, step), Support(1.0)
            shape = shape and replace(shape, model=shape.model.with_values({STEP: step}))
        ties = _tied(base, rest.weights)
        return Conclusion(
            verdict, base, base, nominal, found.recalibrated, ties, rest.estimates, supports, shape, rest.doubted
        )
    chosen, final = found.chosen, found.final
    supports = {variant.effect: _by_evidence(found, variant) for variant in chosen.explanation.variants}
    if step := found.data.step:
        chosen, final = _rounded(chosen, step), _rounded(final, step)
        supports[ROUNDING.id] = Support(1.0)
    return Conclusion(
        verdict_on(chosen),
        chosen,
        final,
        nominal,
        found.recalibrated,
        alternatives(found),
        found.estimates,
        supports,
    )


def _tied(base: Fit, weights: Mapping[str, Weight]) -> list[Alternative]:
    """The alternatives to each effect of `base` beside a remainder."""
    own = (variant for variant in base.explanation.variants if variant.effect in weights)
    return [Alternative(variant, names) for variant in own for names in weights[variant.effect].instead]


def verdict_on(chosen: Fit) -> Verdict:
    """The verdict that follows from a chosen explanation."""
    if not adequate(chosen):
        return "unexplained"
    if chosen.explanation.variants:
        return "missing_physics"
    return "parameter_drift" if chosen.explanation.size else "consistent"


def _coarse(found: Found) -> float:
    """The step of the converter [measured unit] if it is worth a name beside a remainder, otherwise 0."""
    step, known = found.data.step, found.nominal.values[STEP]
    return step if step > max(FEWEST * found.data.scales.reading, (1.0 + OFF_GRID) * known) else 0.0


def _rounded(fit: Fit, step: float) -> Fit:
    """`fit` with its model's samples rounded to `step`; its residual is that of the smooth model."""
    variant = Variant(ROUNDING.id, (), ((STEP.removeprefix(f"{ROUNDING.id}."), step),))
    values = {STEP: step}
    switch = fit.switch and replace(fit.switch, model=fit.switch.model.with_values(values))
    explanation, model = fit.explanation.plus(variant), fit.model.with_values(values)
    return replace(fit, explanation=explanation, values={**fit.values, **values}, model=model, switch=switch)


def _by_evidence(found: Found, variant: Variant) -> Support:
    """Support by the weight of the explanations with an effect among all of the chosen size; each weighs exp(-chi2 /
    2).

    The gain is by how much the best explanation without the effect, of the same size or less, fits worse.
    """
    chosen = found.chosen
    size, repetition = chosen.explanation.size, chosen.repetition
    weights, others = {True: 0.0, False: 0.0}, []
    for fit in found.fits.values():
        acts = variant.effect in fit.explanation.effects
        lag = (fit.misfit - chosen.misfit) / repetition
        if fit.explanation.size == size:
            weights[acts] += math.exp(-0.5 * min(max(lag, 0.0), 1400.0))
        if fit.explanation.size <= size and not acts:
            others.append((lag, fit))
    lacks, without = min(others, key=lambda other: other[0])
    return Support(weights[True] / (weights[True] + weights[False]), gain=lacks, without=without)


def _by_recordings(left_out: LeftOut) -> Support:
    """Support by recordings left out; few parts leave doubt, so Laplace's rule of succession gives the confidence."""
    return Support((left_out.helped + 1) / (left_out.parts + 2), left_out=left_out)
