"""The diagnosis in words: why an effect is named, what it means, what to record next."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from pierburg_ros.diagnosis.found import Found
from pierburg_ros.diagnosis.quality import Limit
from pierburg_ros.diagnosis.report.tried import NOMINAL, identifier
from pierburg_ros.diagnosis.schema import (
    BaseParameter,
    Change,
    Doubted,
    Effect,
    Estimate,
    FitQuality,
    NotTestable,
    Remaining,
)
from pierburg_ros.effects import EFFECT
from pierburg_ros.inference.choice import Name, least
from pierburg_ros.inference.evidence import SIGNIFICANT
from pierburg_ros.pages import numbers

SEPARATES = {
    "armature_resistance": "measure the motor's resistance at standstill",
    "torque_constant": "measure the motor's voltage while it is turned at a known speed",
    "supply_voltage": "log the supply voltage as supply_voltage",
    "coulomb_friction": "move slowly in both directions over the same angles",
}
"""How to distinguish a base parameter from what looks like it."""
AT_STOPS = {
    "spring_preload": "run against both stops and return at duty 0",
    "spring_stiffness": "run against both stops",
}
"""How to distinguish others where there are stops."""
HELD = "measure one of them by other means"
"""The advice where `SEPARATES` and `AT_STOPS` do not help."""
HOLD = "Hold what was measured: its value as nominal with `free: false` in the actuator's description."
"""The advice for a number that was measured by other means."""

FAR_OFF = (
    "Correct {names} in the description, where the fit ends on a bound of the search: the numbers are far off, or stand"
    " for missing physics. 'pierburg actuator new --from-recording' finds what a recording tells."
)
"""The advice for numbers that end on a bound."""


def quantity(name: str, estimate: Estimate | BaseParameter) -> str:
    """A value with its interval, for a sentence."""
    if estimate.value is None:
        return f"{numbers.words(name)} unknown"
    value = numbers.value(estimate.value, estimate.ci95) + numbers.unit(estimate.unit)
    ends = f" ({numbers.interval(estimate.ci95)})" if estimate.ci95 else ""
    return f"{numbers.words(name)} {value}{ends}"


def effect_explanation(
    effect: str, parameters: Mapping[str, Estimate], ties: Sequence[Sequence[str]], reason: str
) -> str:
    """Why the effect is named, with its numbers and the quantities from which it is not distinguished."""
    declared = EFFECT[effect]
    values = ", ".join(quantity(name, estimate) for name, estimate in parameters.items())
    text = f"{declared.sentence} Where it shows: {declared.shows_in}. Found: {values}. {reason}"
    if ties:
        text += f" These recordings cannot tell it from {_either(ties)}."
    return text


def reason(name: Name) -> str:
    """Why an effect is as sure as it is."""
    if name.along is not None:
        return (
            f"Of the torque that is missing along the measured motion it takes {numbers.percent(name.along)}, in blocks"
            " that were not fitted; no simulation is near the recording."
        )
    rival = identifier(name.rival)
    other = "the model as described" if rival == NOMINAL else numbers.words(rival)
    return (
        f"Pulled to the recording, a simulation with it errs by {name.fit.ratio:.3g} times the noise, without it by"
        f" {name.rival.ratio:.3g} times at best ({other})."
    )


BY_GRID = "All samples lie on this grid, which is coarse beside the noise."
"""Why steps of the converter are named."""


def held(name: str, found: Found) -> str | None:
    """Why a parameter was not fitted; None where it was."""
    own = found.choice.handed.explanation
    if name in (*own.drifted, own.changed):
        return None
    if name in found.inferred.drifts:
        return "its value as described accounts for the recordings"
    if name in found.inferred.free:
        return "the recordings do not tell it from parameters that are fitted"
    return "the description does not free it"


def untestable(mark: float) -> str:
    """Why an effect cannot be detected."""
    return (
        "at a plausible strength it changes these recordings by less than their noise once the other parameters are "
        f"fitted again (by {mark:.2g} in -2 log likelihood; {SIGNIFICANT:g} would show)"
    )


def summary(
    found: Found,
    effects: Sequence[Effect],
    parameters: Mapping[str, BaseParameter],
    changes: Sequence[Change],
    fit: FitQuality,
    left: Remaining,
    unsure: Sequence[Doubted],
) -> str:
    """One paragraph for a technician."""
    verdict, unit = found.choice.verdict, found.data.actuator.unit
    errors = " ".join((*divided(found, effects), unseen_error(fit, unit), handed_out(found)))
    drifts = [
        quantity(name, p) + f" instead of {p.nominal:.4g}" + _or(p.indistinguishable_from)
        for name, p in parameters.items()
        if p.drifted and name not in {change.parameter for change in changes}
    ]
    dated = [
        f"{numbers.words(c.parameter)} changes {_when(c)} from {c.before:.4g} to {c.after:.4g}"
        + _or(parameters[c.parameter].indistinguishable_from)
        for c in changes
    ]
    changed = "; ".join((*dated, *drifts))
    begun = stopped(found)
    if verdict == "consistent" and not effects:
        return f"{begun}The model as described explains the recording down to its noise. {errors}"
    if verdict == "parameter_drift" and not effects:
        return f"{begun}No physics is missing: {changed}. {errors}"
    named = " ".join(EFFECT[effect.id].sentence for effect in effects)
    also = f" Besides: {changed}." if changed else ""
    listed = ", and ".join(numbers.words(effect.id) + _or(effect.indistinguishable_from) for effect in effects)
    if verdict != "unexplained":
        return f"{begun}The model lacks {listed}. {named}{also} {errors}"
    helped = f" Part of it is {listed}. {named}" if effects else ""
    able = [each for each in unsure if (each.confidence or 0.0) >= least(each.id)]
    doubtful = [each for each in unsure if each not in able]
    spare = f" Sure enough by itself, but not needed beside the rest: {_with_confidence(able)}." if able else ""
    not_sure = f" Not sure enough to be named: {_with_confidence(doubtful)}." if doubtful else ""
    rest = f"What remains is {left.looks_like}."
    return f"{begun}An error remains that no effect explains.{helped}{also}{spare}{not_sure} {rest} {errors}"


def _with_confidence(unsure: Sequence[Doubted]) -> str:
    return ", ".join(f"{numbers.words(each.id)} ({numbers.percent(each.confidence)})" for each in unsure)


def stopped(found: Found) -> str:
    """Where the search had to end before it was done, a sentence that says so."""
    why = {
        "budget": "The effort allowed was spent before all was tried; a larger --budget may find more. ",
        "interrupt": "Interrupted before all was tried; this is the best verdict yet. ",
        "clock": "The time allowed was over before all was tried; this is the best verdict yet, and depends on the"
        " machine. ",
        None: "",
    }
    return why[found.inferred.effort.stopped_by]


def divided(found: Found, effects: Sequence[Effect]) -> list[str]:
    """How the mismatch of the model as described divides, where it does."""
    shares = found.shares
    if shares.re_estimated is None or shares.remains is None or not shares.effects:
        return []
    parts = [f"re-estimated parameters take {numbers.percent(shares.re_estimated)}"]
    parts += [f"{numbers.words(each.id)} {numbers.percent(each.share)}" for each in effects if each.share is not None]
    left = numbers.percent(shares.remains)
    return [f"Of the squared error of the model as described {', '.join(parts)}, and {left} is left."]


def handed_out(found: Found) -> str:
    """Which model is handed out where that is not the one that the verdict names."""
    if found.written is found.choice.handed:
        return ""
    model = found.written
    own = numbers.words(identifier(model))
    what = "the model as described" if own == NOMINAL else f"one with {own}"
    shape = " and a map of the missing torque" if model.model.residual_torque is not None else ""
    values, nominal = model.model.values, model.fitter.nominal.values
    changed = (f"{numbers.words(name)} {values[name]:.4g}" for name in values if values[name] != nominal.get(name, 0.0))
    listed = f" ({', '.join(changed)})" if own != NOMINAL else ""
    return (
        f"The model that is handed out is {what}{shape}: of all that were fitted it predicts best the"
        f" blocks that were held out to choose{listed}."
    )


def advice(
    found: Found,
    effects: Sequence[Effect],
    parameters: Mapping[str, BaseParameter],
    hidden: Sequence[NotTestable],
    limits: Sequence[Limit],
) -> list[str]:
    """What to record next, most useful first."""
    stops = found.data.actuator.has_stops
    steps = [limit.record for limit in limits]
    if bound := [name for name, parameter in parameters.items() if parameter.at_bound]:
        steps.insert(0, FAR_OFF.format(names=_listed(bound)))
    for effect in effects:
        for tie in effect.indistinguishable_from:
            steps.append(_separating(effect.id, tie, stops))
    for name, parameter in parameters.items():
        for tie in parameter.indistinguishable_from:
            steps.append(_separating(name, tie, stops))
    if found.choice.verdict == "unexplained":
        steps.append(
            "Record the same movements again, cold and warm, slow and fast, to see what the remaining error depends on."
        )
    steps += [f"To see {numbers.words(item.id)}, record: {item.record}." for item in hidden]
    return list(dict.fromkeys(steps))


def _separating(name: str, tie: Sequence[str], stops: bool) -> str:
    known = {**SEPARATES, **(AT_STOPS if stops else {})}
    means = [known[item] for item in (name, *tie) if item in known]
    means += [EFFECT[item].record for item in (name, *tie) if item in EFFECT]
    text = f"To tell {numbers.words(name)} from {_listed(tie)}: {'; or '.join(dict.fromkeys(means)) or HELD}."
    return f"{text} {HOLD}" if "measure" in text else text


def _when(change: Change) -> str:
    """The moment of a change, or the ends of its interval where three digits distinguish them."""
    low, high = (f"{end:.3g}" for end in change.time_ci95 or (change.time, change.time))
    return f"at {low} s" if low == high else f"between {low} and {high} s"


def _or(ties: Sequence[Sequence[str]]) -> str:
    """The alternatives of a quantity, as words that follow its name; empty where there are none."""
    said = [f"{_listed(tie)}{' together' if len(tie) > 1 else ''}" for tie in ties]
    return "".join(f", or {each}" for each in said) + (", which fit alike" if said else "")


def _either(ties: Sequence[Sequence[str]]) -> str:
    return ", or ".join(" with ".join(tie) for tie in ties)


def _listed(names: Sequence[str]) -> str:
    return " and ".join(name.replace("_", " ") for name in names)


def unseen_error(fit: FitQuality, unit: str) -> str:
    """How the error changes on data that no fit has seen."""
    before, after, floor = fit.validation.nominal_rmse, fit.validation.final_rmse, fit.noise_floor
    if before is None or after is None:
        return f"The error on data the fit has not seen is not known; the noise is {floor:.2g} {unit}."
    return (
        f"On data the fit has not seen the error goes from {before:.3g} to {after:.3g} {unit}; "
        f"the noise is {floor:.2g} {unit}."
    )
