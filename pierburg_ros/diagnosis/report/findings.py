"""The conclusion in the terms of diagnosis.json."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from pierburg_ros.actuators import Actuator
from pierburg_ros.actuators.gauge import in_ratio
from pierburg_ros.arrays import Flags, Signal
from pierburg_ros.diagnosis.evidence import quality
from pierburg_ros.diagnosis.evidence.motion import motion_of
from pierburg_ros.diagnosis.limits.limits import Limit, Limits
from pierburg_ros.diagnosis.location.locations import locations
from pierburg_ros.diagnosis.location.regimes import regimes
from pierburg_ros.diagnosis.location.windows import SHORTEST, windows
from pierburg_ros.diagnosis.remainder.resemblance import resemblance
from pierburg_ros.diagnosis.remainder.shape import Shape
from pierburg_ros.diagnosis.report import words
from pierburg_ros.diagnosis.report.horizons import horizons
from pierburg_ros.diagnosis.report.tried import distinct, identifier, statuses
from pierburg_ros.diagnosis.schema import (
    BaseParameter,
    Candidate,
    CannotAct,
    Change,
    Diagnosis,
    Doubted,
    Effect,
    Errors,
    Estimate,
    Evidence,
    Excluded,
    FitQuality,
    Location,
    NotTestable,
    Regime,
    Remaining,
    ResidualTorque,
    RuledOut,
    TorqueOverTime,
)
from pierburg_ros.diagnosis.search.found import Found
from pierburg_ros.diagnosis.search.selection import gain
from pierburg_ros.diagnosis.search.weighing import Weight
from pierburg_ros.diagnosis.verdict.conclusion import Conclusion
from pierburg_ros.diagnosis.verdict.shares import Shares
from pierburg_ros.effects import DECLARED, EFFECT, EFFECTS
from pierburg_ros.estimation.data import Data, rms
from pierburg_ros.estimation.discrepancy import Kalman
from pierburg_ros.estimation.likelihood import SIGNIFICANT
from pierburg_ros.estimation.run import Run, Switch
from pierburg_ros.inference.coordinates import without_effects
from pierburg_ros.inference.explanation import AFTER, WHEN, Variant
from pierburg_ros.plant import Model


def document(
    found: Found,
    conclusion: Conclusion,
    parts: Shares,
    limits: Limits,
    marks: Mapping[str, float],
    stopped: bool = False,
) -> Diagnosis:
    """The whole document, with the `marks` of effects by id; `stopped`: the search had to end before it was done."""
    data, actuator = found.data, found.data.actuator
    named, parameters_found = effects(conclusion, parts), parameters(found, conclusion)
    fit, changed, hidden = fit_quality(found, conclusion), changes(conclusion), not_testable(marks)
    short = quality.limits_of(data.runs, actuator, data.noise)
    text = words.summary(conclusion.verdict, named, parameters_found, changed, fit, actuator.unit, stopped)
    unsure = doubted(conclusion)
    text = words.unsure({each.id: each.confidence or 0.0 for each in unsure}, text)
    text = words.needless(found.needless if conclusion.verdict == "unexplained" else (), text)
    text = words.remarked(data.remarks, words.warned(data, conclusion.verdict, words.provisional(text, stopped)))
    places, ranges = located(data, conclusion)
    return Diagnosis(
        schema=2,
        recordings=list({run.number: run.name for run in data.runs}.values()),
        quantity=actuator.quantity,
        unit=actuator.unit,
        input=actuator.input,
        motion=actuator.motion,
        verdict=conclusion.verdict,
        summary=words.cautioned(short, text),
        stopped=stopped,
        effects=named,
        doubted=unsure,
        parameters=parameters_found,
        changes=changed,
        locations=places,
        regimes=ranges,
        fit=fit,
        candidates=candidates(found, conclusion),
        not_testable=hidden,
        ruled_out=[ruled_out(limit, actuator) for limit in limits.found],
        remaining=remaining(data, conclusion, parts),
        excluded=excluded(data),
        cannot_act=cannot_act(actuator),
        residual_torque=residual_torque(conclusion.shape),
        data_quality=quality.data_quality(data.runs, actuator, data.noise, (*data.warnings, *data.remarks)),
        advice=[
            *words.advice(conclusion.verdict, named, parameters_found, hidden, short, actuator.has_stops),
            *words.untested(limits.untested),
        ],
    )


def effects(conclusion: Conclusion, parts: Shares) -> list[Effect]:
    """The effects of the chosen explanation, with their parameters, ties and reasons."""
    final, unit = conclusion.final, conclusion.final.model.actuator.shown
    found = []
    for variant in final.explanation.variants:
        declared = EFFECT[variant.effect]
        values = {name: final.model.values[f"{variant.effect}.{name}"] for name in declared.names}
        parameters = {
            name: _estimate(conclusion, f"{variant.effect}.{name}", values[name], unit(declared.parameter(name).unit))
            for name in declared.names
            if name in variant.free or values[name] != 0.0
        }
        ties = ties_of(conclusion, variant)
        support = conclusion.supports[variant.effect]
        share = parts.effects.get(variant.effect)
        found.append(
            Effect(
                id=variant.effect,
                confidence=support.confidence,
                parameters=parameters,
                indistinguishable_from=ties,
                share=share.beside if share else None,
                share_alone=share.alone if share else None,
                evidence=_evidence(support.weight),
                explanation=words.effect_explanation(
                    variant.effect, parameters, ties, words.reason(support, conclusion.final.model.actuator.unit)
                ),
            )
        )
    return found


def doubted(conclusion: Conclusion) -> list[Doubted]:
    """The effects that are not probable enough to be named beside a remainder, the most probable first."""
    found = [
        Doubted(
            id=effect,
            confidence=weight.confidence,
            indistinguishable_from=[list(names) for names in weight.instead],
            evidence=_evidence(weight),
            explanation=words.by_weight(weight),
        )
        for effect, weight in conclusion.doubted.items()
    ]
    return sorted(found, key=lambda each: -(each.confidence or 0.0))


def _evidence(weight: Weight | None) -> Evidence | None:
    if weight is None or weight.apart is None:
        return None
    return Evidence(carried=weight.carried, explains=weight.explained, apart=weight.apart)


def _estimate(conclusion: Conclusion, name: str, value: float, unit: str) -> Estimate:
    known = conclusion.estimates.get(name)
    if known is None:
        return Estimate(value=value, unit=unit, ci95=None, identifiable=True)
    return Estimate(value=known.value, unit=unit, ci95=(known.low, known.high), identifiable=known.identifiable)


def ties_of(conclusion: Conclusion, quantity: str | Variant) -> list[list[str]]:
    """The alternatives to a quantity of the chosen explanation."""
    return [list(tie.instead) for tie in conclusion.alternatives if tie.quantity == quantity]


def parameters(found: Found, conclusion: Conclusion) -> dict[str, BaseParameter]:
    """Every base parameter, and those of effects that the actuator always has.

    Each has its nominal value, its value in the chosen explanation, and whether it drifted. Where a residual remains, a
    parameter may be moved without being distinguished from its nominal value: that is no drift.
    """
    actuator = found.data.actuator
    final = conclusion.final
    result = {}
    for name in dict.fromkeys((*actuator.parameters, *found.drifts)):
        declared = actuator.parameters[name] if name in actuator.parameters else DECLARED[name]
        known, nominal = conclusion.estimates.get(name), found.nominal.values[name]
        told = known is None or not known.low <= nominal <= known.high
        drifted = (name in final.explanation.drifted and told) or name == final.explanation.changed
        identifiable = known.identifiable if known else name in conclusion.recalibrated.explanation.drifted
        result[name] = BaseParameter(
            nominal=nominal,
            value=final.model.values[name],
            unit=actuator.shown(declared.unit),
            ci95=(known.low, known.high) if known else None,
            identifiable=identifiable,
            drifted=drifted,
            indistinguishable_from=[*ties_of(conclusion, name), *_in_ratio(actuator, name)] if drifted else [],
        )
    return result


def _in_ratio(actuator: Actuator, name: str) -> list[list[str]]:
    """The fixed parameters that may have drifted in place of a parameter."""
    fixed = in_ratio(actuator, name)
    return [list(fixed)] if fixed else []


def changes(conclusion: Conclusion) -> list[Change]:
    """The parameter that changed in the middle of the recording, if one did, and the interval of the moment."""
    name = conclusion.final.explanation.changed
    if name is None:
        return []
    values, known = conclusion.final.values, conclusion.estimates.get(name + WHEN)
    time, ends = (0.5 * (known.low + known.high), (known.low, known.high)) if known else (values[name + WHEN], None)
    return [Change(parameter=name, time=time, time_ci95=ends, before=values[name], after=values[name + AFTER])]


def fit_quality(found: Found, conclusion: Conclusion) -> FitQuality:
    """Errors before and after, on samples that were fitted, and on samples that neither fit nor choice has used."""
    data = found.data

    def errors(samples: Flags) -> Errors:
        return Errors(
            nominal_rmse=rmse(data, samples, conclusion.nominal.model),
            recalibrated_rmse=rmse(data, samples, conclusion.recalibrated.model),
            final_rmse=rmse(data, samples, conclusion.model, conclusion.final.switch),
        )

    models = [
        (conclusion.nominal.model, None),
        (conclusion.recalibrated.model, None),
        (conclusion.model, conclusion.final.switch),
    ]
    return FitQuality(
        noise_floor=data.noise,
        training=errors(data.train),
        validation=errors(data.test),
        horizons=horizons(data, models),
    )


def rmse(data: Data, samples: Flags, model: Model, switch: Switch | None = None) -> float | None:
    """Root mean squared error on some samples, measured unit; None where there are none."""
    residual = data.residual(model, switch)[samples]
    return rms(residual) * data.noise if residual.size else None


def candidates(found: Found, conclusion: Conclusion, most: int = 30) -> list[Candidate]:
    """The explanations tried, each name once, the best first: error on test samples, evidence, status."""
    data, chosen = found.data, conclusion.chosen
    status = statuses(found, chosen)
    return [
        Candidate(
            id=identifier(fit),
            validation_rmse=rmse(data, data.test, fit.model, fit.switch),
            evidence=gain(conclusion.recalibrated, fit),
            status=status[identifier(fit)],
        )
        for fit in distinct(found, chosen)[:most]
    ]


def not_testable(marks: Mapping[str, float]) -> list[NotTestable]:
    """Effects that could act at a plausible strength without a mark in these recordings."""
    return [
        NotTestable(id=effect, why=words.untestable(mark), record=EFFECT[effect].record)
        for effect, mark in marks.items()
        if mark < SIGNIFICANT
    ]


def ruled_out(limit: Limit, actuator: Actuator) -> RuledOut:
    """A strength that is excluded, with its unit."""
    unit = actuator.shown(EFFECT[limit.effect].parameter(limit.parameter).unit)
    side = {"above" if limit.above else "below": limit.value}
    return RuledOut(id=limit.effect, parameter=limit.parameter, unit=unit, **side)


def remaining(data: Data, conclusion: Conclusion, parts: Shares) -> Remaining:
    """The remainder of the first recording under the written model, as a share and in words."""
    residual = data.residual(conclusion.model, conclusion.final.switch)
    discrepancy = Kalman(data, data.train).most_likely(residual)
    run = data.longest
    left = run.measured - run.simulated(conclusion.model, conclusion.final.switch)
    return Remaining(share=parts.remains, looks_like=resemblance(data, run, left, discrepancy))


def excluded(data: Data) -> list[Excluded]:
    """The spans of every recording that were left out."""
    names = {run.number: run.name for run in data.runs}
    return [
        Excluded(start=each.span[0], end=each.span[1], why=f"{names.get(each.number, 'a recording')}: {each.why}")
        for each in data.left_out
    ]


def cannot_act(actuator: Actuator) -> list[CannotAct]:
    """Effects that are tested in other kinds of actuator and cannot act in this one."""
    obstacles = {effect.id: actuator.obstacle(effect) for effect in EFFECTS if effect.variants}
    return [CannotAct(id=effect, why=why) for effect, why in obstacles.items() if why]


def located(data: Data, conclusion: Conclusion) -> tuple[list[Location], list[Regime]]:
    """Windows and regimes of the first recording in which the mismatch concentrates; none where there is no mismatch.

    Windows are where the named effects move the signal or, if none is named, where the error is.
    """
    if conclusion.verdict in ("consistent", "parameter_drift"):
        return [], []
    run, final = data.longest, conclusion.final
    motion = motion_of(run, data.actuator, data.noise)
    residual = run.measured - run.simulated(conclusion.recalibrated.model)
    mark = residual
    if final.explanation.variants:
        bare = without_effects(final.model, [variant.effect for variant in final.explanation.variants])
        mark = run.simulated(final.model, final.switch) - run.simulated(bare)
    found = windows(motion.time, mark**2, shortest=SHORTEST * data.scales.time)
    return locations(motion, residual, found), regimes(motion, residual)


def residual_torque(shape: Shape | None) -> ResidualTorque | None:
    """The remainder as a torque over angle and velocity, and over time; None where there is none."""
    if shape is None or shape.model.residual_torque is None:
        return None
    grid = {key: np.asarray(values).tolist() for key, values in shape.model.residual_torque.items()}
    time, torque = shape.over_time
    return ResidualTorque(
        **grid, shape=shape.words, over_time=TorqueOverTime(time=time.tolist(), torque=torque.tolist())
    )


def signals(run: Run, conclusion: Conclusion) -> dict[str, Signal]:
    """Time [s], measured, command, and the simulations of a run by the three models, each (samples,)."""
    place = np.maximum(np.searchsorted(run.inputs.time, run.time, side="right") - 1, 0)
    return {
        "time": run.time,
        "measured": run.measured,
        "command": run.inputs.command[place],
        "nominal": run.simulated(conclusion.nominal.model),
        "recalibrated": run.simulated(conclusion.recalibrated.model),
        "final": run.simulated(conclusion.model, conclusion.final.switch),
    }
