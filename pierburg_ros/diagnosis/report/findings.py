"""The conclusion in the terms of diagnosis.json."""

from __future__ import annotations

from pierburg_ros.actuators.actuator import UNITS
from pierburg_ros.diagnosis.report.words import effect_explanation, untestable
from pierburg_ros.diagnosis.schema import (
    BaseParameter,
    Candidate,
    Change,
    Effect,
    Errors,
    Estimate,
    FitQuality,
    NotTestable,
)
from pierburg_ros.diagnosis.search.candidates import starts_of
from pierburg_ros.diagnosis.search.explanation import AFTER, WHEN, Variant
from pierburg_ros.diagnosis.search.explore import Exploration
from pierburg_ros.diagnosis.search.fits import Fit
from pierburg_ros.diagnosis.search.selection import SIGNIFICANT, gain, tied
from pierburg_ros.diagnosis.verdict.conclusion import Conclusion, rmse
from pierburg_ros.diagnosis.verdict.ties import visibility
from pierburg_ros.effects import EFFECT
from pierburg_ros.plant import Model


def effects(conclusion: Conclusion) -> list[Effect]:
    """The effects of the chosen explanation, with their parameters, ties and reasons."""
    final = conclusion.final
    found = []
    for variant in final.explanation.variants:
        declared = EFFECT[variant.effect]
        values = {name: final.model.values[f"{variant.effect}.{name}"] for name in declared.names}
        parameters = {
            name: _estimate(conclusion, f"{variant.effect}.{name}", values[name], declared.parameter(name).unit)
            for name in declared.names
            if name in variant.free or values[name] != 0.0
        }
        ties = ties_of(conclusion, variant)
        support = conclusion.supports[variant.effect]
        found.append(
            Effect(
                id=variant.effect,
                confidence=support.confidence,
                parameters=parameters,
                indistinguishable_from=ties,
                explanation=effect_explanation(variant.effect, parameters, ties, support.reason),
            )
        )
    return found


def _estimate(conclusion: Conclusion, name: str, value: float, unit: str) -> Estimate:
    known = conclusion.estimates.get(name)
    if known is None:
        return Estimate(value=value, unit=unit, ci95=None, identifiable=True)
    return Estimate(value=known.value, unit=unit, ci95=(known.low, known.high), identifiable=known.identifiable)


def ties_of(conclusion: Conclusion, quantity: str | Variant) -> list[list[str]]:
    """What may stand for a quantity of the chosen explanation."""
    return [list(tie.instead) for tie in conclusion.alternatives if tie.quantity == quantity]


def parameters(exploration: Exploration, conclusion: Conclusion) -> dict[str, BaseParameter]:
    """Every base parameter: nominal, as the chosen explanation has it, and whether it drifted."""
    actuator = exploration.data.actuator
    final = conclusion.final
    result = {}
    for name in actuator.parameters:
        drifted = name in final.explanation.drifted or name == final.explanation.changed
        known = conclusion.estimates.get(name)
        identifiable = known.identifiable if known else name in conclusion.recalibrated.explanation.drifted
        result[name] = BaseParameter(
            nominal=exploration.nominal.values[name],
            value=final.model.values[name],
            unit=UNITS[name][0],
            ci95=(known.low, known.high) if known else None,
            identifiable=identifiable,
            drifted=drifted,
            indistinguishable_from=ties_of(conclusion, name) if drifted else [],
        )
    return result


def changes(chosen: Fit) -> list[Change]:
    """The parameter that changed in the middle of the recording, if one did."""
    name = chosen.explanation.changed
    if name is None:
        return []
    values = chosen.values
    return [Change(parameter=name, time=values[name + WHEN], before=values[name], after=values[name + AFTER])]


def fit_quality(exploration: Exploration, conclusion: Conclusion, final: Model) -> FitQuality:
    """Errors before and after, on samples that were fitted and on samples that were not."""
    data = exploration.data

    def errors(training: bool) -> Errors:
        return Errors(
            nominal_rmse=rmse(data, conclusion.nominal.model, None, training),
            recalibrated_rmse=rmse(data, conclusion.recalibrated.model, None, training),
            final_rmse=rmse(data, final, conclusion.final.switch, training),
        )

    return FitQuality(noise_floor=data.noise, training=errors(True), validation=errors(False))


def candidates(exploration: Exploration, conclusion: Conclusion, most: int = 30) -> list[Candidate]:
    """The explanations tried, the best first: error on unseen samples, evidence, status."""
    data, chosen = exploration.data, conclusion.chosen
    equals = {id(fit) for fit in tied(chosen, exploration.of_size(chosen.explanation.size), exploration.search)}
    ranked = sorted(exploration.fits.values(), key=lambda fit: (fit is not chosen, fit.chi2))
    return [
        Candidate(
            id=identifier(fit),
            validation_rmse=rmse(data, fit.model, fit.switch, False),
            evidence=gain(conclusion.recalibrated, fit),
            status="chosen" if fit is chosen else "tied" if id(fit) in equals else "rejected",
        )
        for fit in ranked[:most]
    ]


def identifier(fit: Fit) -> str:
    """Effect ids and parameter names joined by +; `nominal` for none."""
    change = (f"{fit.explanation.changed}{WHEN}",) if fit.explanation.changed else ()
    return "+".join((*fit.explanation.drifted, *change, *fit.explanation.effects)) or "nominal"


def not_testable(exploration: Exploration, conclusion: Conclusion) -> list[NotTestable]:
    """Effects that could act at a plausible strength without a mark in these recordings."""
    final = conclusion.final
    seen: dict[str, float] = {}
    for variant, starts in starts_of(exploration.data, final.model).items():
        if variant.effect in final.explanation.effects or not variant.free:
            continue
        mark = visibility(exploration, final, variant, [dict(start) for start in starts[:4]])
        seen[variant.effect] = max(seen.get(variant.effect, 0.0), mark)
    return [
        NotTestable(id=effect, why=untestable(mark), record=EFFECT[effect].record)
        for effect, mark in seen.items()
        if mark < SIGNIFICANT
    ]
