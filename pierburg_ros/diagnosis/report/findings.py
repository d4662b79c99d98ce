"""What was found, in the terms of diagnosis.json."""

from __future__ import annotations

import math
from collections.abc import Sequence

from pierburg_ros.actuators import Actuator
from pierburg_ros.actuators.gauge import in_ratio
from pierburg_ros.arrays import Flags, Signal
from pierburg_ros.diagnosis import quality, remains
from pierburg_ros.diagnosis.cleaning.cleaned import Cleaned
from pierburg_ros.diagnosis.found import Found
from pierburg_ros.diagnosis.limits import Limit
from pierburg_ros.diagnosis.location.locations import locations
from pierburg_ros.diagnosis.location.regimes import regimes
from pierburg_ros.diagnosis.location.windows import SHORTEST_LOCATION, windows
from pierburg_ros.diagnosis.motion import motion_of
from pierburg_ros.diagnosis.report import words
from pierburg_ros.diagnosis.report.tried import identifier, rms_or_none, statuses
from pierburg_ros.diagnosis.schema import (
    BaseParameter,
    Candidate,
    CannotAct,
    Change,
    Diagnosis,
    Doubted,
    Effect,
    Effort,
    Errors,
    Estimate,
    Excluded,
    FitQuality,
    Horizon,
    Location,
    NotTestable,
    Regime,
    Remaining,
    RuledOut,
    Verdict,
)
from pierburg_ros.effects import EFFECT, EFFECTS, ROUNDING, STEP
from pierburg_ros.inference.choice import Name, Score, taken
from pierburg_ros.inference.data import Data
from pierburg_ros.inference.evidence import SIGNIFICANT
from pierburg_ros.inference.explanation import AFTER, WHEN
from pierburg_ros.inference.fit import Fit, rms_of, strongest

HORIZONS = (0.1, 0.3, 1.0, 3.0)
"""Times over which a model predicts [s]. Given: the times that the report promises."""
LISTED = 30
"""Most explanations that are listed. Chosen: more help no reader."""


def document(found: Found, cleaned: Sequence[Cleaned]) -> Diagnosis:
    """The whole document on recordings that were `cleaned`."""
    data = found.data
    actuator, runs = data.actuator, data.runs
    named, parameters_found = effects(found), parameters(found)
    fit, changed, hidden = fit_quality(found), changes(found), not_testable(found)
    short = [
        limit
        for limit in quality.limits_of(runs, actuator, data.noise)
        if limit.kind != "slow_sampling" or not short_times_show(found)
    ]
    places, ranges = located(found)
    left = remaining(found)
    remarks = [*data.warnings, *(f"{each.recording.name}: {remark}" for each in cleaned for remark in each.remarks)]
    unsure = doubted(found)
    text = words.summary(found, named, parameters_found, changed, fit, left, unsure)
    return Diagnosis(
        schema=3,
        recordings=list({run.number: run.name for run in runs}.values()),
        quantity=actuator.quantity,
        unit=actuator.unit,
        input=actuator.input,
        motion=actuator.motion,
        verdict=verdict(found),
        summary=" ".join([*remarks, text]),
        model_of=found.model_of,
        effort=effort(found),
        effects=named,
        doubted=unsure,
        re_estimated_share=found.shares.re_estimated,
        parameters=parameters_found,
        changes=changed,
        locations=places,
        regimes=ranges,
        fit=fit,
        candidates=candidates(found),
        not_testable=hidden,
        ruled_out=[ruled_out(each.limit, found) for each in found.seen.values() if each.limit is not None],
        remaining=left,
        excluded=excluded(cleaned, actuator),
        cannot_act=cannot_act(found.data),
        residual_torque=remains.document(found.model, found.lacking, left.looks_like),
        data_quality=quality.data_quality(runs, actuator, data.noise, short, remarks),
        advice=words.advice(found, named, parameters_found, hidden, short),
    )


def short_times_show(found: Found) -> bool:
    """Whether a limit is told of every effect whose strength is a time, so that sampling hides none of them."""
    timed = [
        each.limit
        for effect, each in found.seen.items()
        if all(EFFECT[effect].parameter(name).unit == "s" for name in EFFECT[effect].strength)
    ]
    return bool(timed) and None not in timed


def verdict(found: Found) -> Verdict:
    """The verdict of the choice; steps of a converter are an effect too."""
    own = found.choice.verdict
    return "missing_physics" if found.step and own in ("consistent", "parameter_drift") else own


def effort(found: Found) -> Effort:
    """How much was simulated, of how much that was allowed."""
    own = found.inferred.effort
    return Effort(simulations=own.simulations, budget=own.budget.efforts, stopped_by=own.stopped_by)


def effects(found: Found) -> list[Effect]:
    """The effects of the chosen explanation, with their parameters, ties and reasons."""
    own, listed = found.choice.handed, []
    for variant in own.explanation.variants:
        declared, name = EFFECT[variant.effect], found.choice.names[variant.effect]
        values = {each: own.values[f"{variant.effect}.{each}"] for each in declared.names}
        shown = {
            each: _estimate(found, f"{variant.effect}.{each}", values[each])
            for each in declared.names
            if values[each] != 0.0 or (each in variant.free and not declared.parameter(each).moment)
        }
        ties, share = ties_of(found, variant.effect), found.shares.effects.get(variant.effect)
        listed.append(
            Effect(
                id=variant.effect,
                confidence=name.confidence,
                parameters=shown,
                indistinguishable_from=ties,
                share=share.beside if share else None,
                share_alone=share.alone if share else None,
                explanation=words.effect_explanation(variant.effect, shown, ties, words.reason(name)),
            )
        )
    return listed + ([converter(found)] if found.step else [])


def converter(found: Found) -> Effect:
    """The steps of a converter, seen in the samples themselves."""
    declared = ROUNDING.parameters[0]
    step = Estimate(value=found.step, unit=found.data.actuator.unit_of(STEP), ci95=None, identifiable=True)
    shown = {declared.name: step}
    text = words.effect_explanation(ROUNDING.id, shown, [], words.BY_GRID)
    return Effect(id=ROUNDING.id, confidence=1.0, parameters=shown, explanation=text)


def doubted(found: Found) -> list[Doubted]:
    """Effects that are not named, the most probable first, with their values where they gain most."""
    return [
        Doubted(
            id=effect,
            confidence=name.confidence,
            share=taken(found.choice.described, name.fit) if not found.choice.explained else None,
            parameters={
                each: Estimate(
                    value=name.fit.values[f"{effect}.{each}"],
                    unit=found.data.actuator.unit_of(f"{effect}.{each}"),
                    ci95=None,
                    identifiable=False,
                )
                for each in EFFECT[effect].names
                if name.fit.values[f"{effect}.{each}"] != 0.0
            },
            explanation=words.reason(name),
        )
        for effect, name in worth_telling(found).items()
    ]


def worth_telling(found: Found) -> dict[str, Name]:
    """The doubted effects that anyone would want to know of."""
    return {
        effect: name
        for effect, name in found.choice.doubted.items()
        if name.confidence > 0.01 and effect not in found.choice.alternatives
    }


def _estimate(found: Found, name: str, value: float) -> Estimate:
    known, unit = found.intervals.get(name), found.data.actuator.unit_of(name)
    if known is None:
        return Estimate(value=value, unit=unit, ci95=None, identifiable=True)
    return Estimate(
        value=known.value,
        unit=unit,
        ci95=known.ci95,
        identifiable=known.identifiable,
        at_bound=known.at_bound,
        tied_with=list(found.tied_with.get(name, ())),
    )


def ties_of(found: Found, quantity: str) -> list[list[str]]:
    """The alternatives to a quantity of the chosen explanation."""
    return [list(names) for names in found.choice.ties.get(quantity, ())]


def parameters(found: Found) -> dict[str, BaseParameter]:
    """Every base parameter, and those of effects that the actuator always has.

    One has drifted if the chosen explanation changes it and its interval leaves out the value of the description.
    """
    actuator, own = found.data.actuator, found.choice.handed
    nominal, result = own.fitter.nominal, {}
    for name in dict.fromkeys((*actuator.parameters, *found.inferred.free)):
        known, described = found.intervals.get(name), nominal.values[name]
        moved = name in own.explanation.drifted and not _within(described, known.ci95 if known else None)
        drifted = moved or name == own.explanation.changed
        result[name] = BaseParameter(
            nominal=described,
            value=own.model.values[name],
            unit=actuator.unit_of(name),
            ci95=known.ci95 if known else None,
            identifiable=known.identifiable if known else name in found.inferred.drifts,
            drifted=drifted,
            indistinguishable_from=[*ties_of(found, name), *_in_ratio(actuator, name)] if drifted else [],
            tied_with=list(found.tied_with.get(name, ())),
            held=words.held(name, found),
            at_bound=known.at_bound if known else False,
        )
    return result


def _within(value: float, ends: tuple[float, float] | None) -> bool:
    return ends is not None and ends[0] <= value <= ends[1]


def _in_ratio(actuator: Actuator, name: str) -> list[list[str]]:
    """The fixed parameters that may have drifted in place of a parameter."""
    fixed = in_ratio(actuator, name)
    return [list(fixed)] if fixed else []


def changes(found: Found) -> list[Change]:
    """The parameter that changed in the middle of the recording, if one did, and the interval of the moment."""
    own = found.choice.handed
    name = own.explanation.changed
    if name is None:
        return []
    values, known = own.values, found.intervals.get(name + WHEN)
    ends = known.ci95 if known else None
    low, high = ends or (0.0, found.data.duration)
    time = min(max(values[name + WHEN], low), high)
    return [Change(parameter=name, time=time, time_ci95=ends, before=values[name], after=values[name + AFTER])]


def fit_quality(found: Found) -> FitQuality:
    """Errors before and after, on samples that were fitted, and on samples that neither fit nor choice has used."""
    data = found.data

    def on(samples: Flags) -> Errors:
        nominal, recalibrated, final = (rms_or_none(each[samples]) for each in found.errors.values())
        return Errors(nominal_rmse=nominal, recalibrated_rmse=recalibrated, final_rmse=final)

    return FitQuality(
        noise_floor=data.noise, training=on(data.train), validation=on(data.test), horizons=horizons(found)
    )


def horizons(found: Found) -> list[Horizon]:
    """Errors on unseen samples of the three models, pulled to the recordings with each of `HORIZONS`, and free.

    A pulled simulation has forgotten what was its time constant ago, so it predicts about that far.
    """
    listed, data = [], found.data
    for after in (*HORIZONS, math.inf):
        fitter = found.written.fitter.pulled(after)
        models = (found.choice.described, found.choice.estimated, found.written)
        nominal, recalibrated, final = (rms_or_none(fitter.left_by(fit)[data.test] * data.noise) for fit in models)
        listed.append(Horizon(after=after, nominal_rmse=nominal, recalibrated_rmse=recalibrated, final_rmse=final))
    return listed


def candidates(found: Found) -> list[Candidate]:
    """The explanations that were fitted, each name once, the best on held-out samples first."""
    choice, data = found.choice, found.data
    score, status = Score.of(choice.fits), statuses(found)
    best: dict[str, Fit] = {}
    for fit in choice.fits:
        best.setdefault(identifier(fit), fit)
    listed = [
        Candidate(
            id=name,
            validation_rmse=_on(fit, data.test),
            heldout_rmse=_on(fit, data.validation),
            evidence=score.lack(choice.estimated.chi2) - score.lack(fit.chi2),
            status=status[name],
        )
        for name, fit in best.items()
    ]
    return sorted(listed, key=lambda each: each.heldout_rmse if each.heldout_rmse is not None else math.inf)[:LISTED]


def _on(fit: Fit, samples: Flags) -> float | None:
    return rms_of(fit, samples) if samples.any() else None


def not_testable(found: Found) -> list[NotTestable]:
    """Effects that could act at a plausible strength without a mark in these recordings."""
    return [
        NotTestable(id=effect, why=words.untestable(each.mark), record=EFFECT[effect].record)
        for effect, each in found.seen.items()
        if each.mark < SIGNIFICANT
    ]


def ruled_out(limit: Limit, found: Found) -> RuledOut:
    """A strength that is excluded, with its unit; where something remains, it counts that."""
    unit = found.data.actuator.unit_of(f"{limit.effect}.{limit.parameter}")
    side = {"above" if limit.above else "below": limit.value}
    return RuledOut(
        id=limit.effect,
        parameter=limit.parameter,
        unit=unit,
        given="complete" if found.choice.explained else "residual",
        **side,
    )


def remaining(found: Found) -> Remaining:
    """What the chosen effects leave, as a share and in words."""
    if found.choice.explained:
        return Remaining(share=found.shares.remains, looks_like="noise")
    forms = remains.shapes(found.lacking)
    return Remaining(
        share=found.shares.remains,
        looks_like=remains.in_words(forms, found.lacking, found.data.actuator.motion),
        shapes=forms,
    )


def excluded(cleaned: Sequence[Cleaned], actuator: Actuator) -> list[Excluded]:
    """The spans of every recording that were left out."""
    return [
        Excluded(start=start, end=end, why=f"{each.recording.name}: {why}")
        for each in cleaned
        for start, end, why in each.left_out(actuator)
    ]


def cannot_act(data: Data) -> list[CannotAct]:
    """Effects that are tested in other kinds of actuator, or recordings, and cannot act in these."""
    obstacles = {effect.id: data.obstacle(effect) for effect in EFFECTS if effect.variants}
    return [CannotAct(id=effect, why=why) for effect, why in obstacles.items() if why]


def located(found: Found) -> tuple[list[Location], list[Regime]]:
    """Windows and regimes of the first recording in which the mismatch gathers; none where there is no mismatch.

    The model with re-estimated parameters is pulled strongly there: an error shows where it arises, and not after it.
    """
    if verdict(found) in ("consistent", "parameter_drift") or found.choice.verdict in ("consistent", "parameter_drift"):
        return [], []
    run, own = found.data.runs[0], found.choice.estimated
    motion = motion_of(run, found.data.actuator, found.data.noise)
    near = strongest(own.fitter).residual(own.model) * found.data.noise
    residual = found.data.by_run(near)[0]
    shortest = SHORTEST_LOCATION * found.data.scales.time
    placed = windows(motion.time, residual**2, shortest=shortest) if motion.time[-1] > 2.0 * shortest else []
    return locations(motion, residual, placed), regimes(motion, residual)


def signals(found: Found) -> dict[str, Signal]:
    """Time [s], measured, command, and the simulations of the first recording by the three models, each (samples,)."""
    run = found.data.runs[0]
    simulated = {key: run.measured - found.data.by_run(error)[0] for key, error in found.errors.items()}
    return {"time": run.time, "measured": run.measured, "command": run.in_force, **simulated}
