"""The diagnosis in words: why an effect is named, what it means, what to record next."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from pierburg_ros.diagnosis.evidence.quality import Limit
from pierburg_ros.diagnosis.remainder.left_out import LeftOut
from pierburg_ros.diagnosis.report.tried import NOMINAL, identifier
from pierburg_ros.diagnosis.schema import BaseParameter, Change, Effect, Estimate, FitQuality, NotTestable, Verdict
from pierburg_ros.diagnosis.search.weighing import Weight
from pierburg_ros.diagnosis.verdict.conclusion import Support
from pierburg_ros.effects import EFFECT
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.likelihood import EXPLAINED, SIGNIFICANT, TIED
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


def reason(support: Support, unit: str) -> str:
    """Why an effect is named; `unit` is the measured unit."""
    if support.left_out is not None:
        return by_recordings_left_out(support.left_out, support.left_out.unit or unit)
    if support.weight is not None:
        return by_weight(support.weight)
    if support.gain is None or support.without is None:
        return by_grid()
    return by_evidence(support.gain, identifier(support.without))


def by_evidence(gain: float, without: str) -> str:
    """Why an effect is named that the best explanation needs; `without` names the best explanation that lacks it."""
    rival = "the model as described" if without == NOMINAL else numbers.words(without)
    return (
        f"The best explanation without it that changes no more quantities is {rival}: it fits "
        f"{'worse' if gain >= 0.0 else 'better'} by {float(f'{abs(gain):.3g}'):,.0f} in chi-squared; "
        f"up to {TIED:g} is a tie."
    )


def by_weight(weight: Weight) -> str:
    """Why an effect is named although a residual remains."""
    if weight.by_rule is not None:
        return (
            "The controller that made the input shows it: the input follows from setpoint and angle by one rule. With "
            f"the effect {100.0 * weight.by_rule:.1f} % of the squared error of that rule disappears."
        )
    what = "any effect" if weight.bare else "it"
    seen = "" if weight.unseen is None else f" On samples that no fit has seen it gains {weight.unseen:.3g}."
    share = ""
    if weight.explains is not None:
        times = math.sqrt(weight.explains / max(1.0 - weight.explains, 1e-6))
        share = f" It moves the signal by {times:.2g} times the remaining error."
    nearest = ""
    if weight.apart is not None:
        nearest = f" The best replacement gains {100.0 * (1.0 - weight.apart):.0f} % as much."
    return (
        f"It explains {100.0 * weight.carried:.0f} % of the evidence against the model without {what}: "
        f"{weight.gain:.3g} in -2 log likelihood, and {weight.left:.3g} is left. The remaining error counts as one "
        f"that varies slowly, not as noise.{seen}{share}{nearest}"
    )


def by_grid() -> str:
    """Why steps of the converter are named."""
    return "All samples lie on this grid, which is coarse beside the noise."


def by_recordings_left_out(said: LeftOut, unit: str) -> str:
    """Why an effect is named where no explanation accounts for the whole residual, and which recordings share it."""
    shared = said.helped == said.parts
    on = f", on {', '.join(said.recordings)}" if said.recordings else ""
    some = f"it helps in {said.helped} of {said.parts} parts{on}"
    where = "all recordings share it" if shared else some
    return (
        f"On recordings left out of the fit the error is {said.without:.3g} {unit} without it and {said.beside:.3g} "
        f"{unit} with it; {where}. Other physics may stand behind it."
    )


def untestable(mark: float) -> str:
    """Why an effect cannot be detected."""
    return (
        "at a plausible strength it changes these recordings by less than their noise once the other parameters are "
        f"fitted again (by {mark:.2g} in chi-squared; {SIGNIFICANT:g} would show)"
    )


def summary(
    verdict: Verdict,
    effects: Sequence[Effect],
    parameters: Mapping[str, BaseParameter],
    changes: Sequence[Change],
    fit: FitQuality,
    unit: str,
    stopped: bool = False,
) -> str:
    """One paragraph for a technician; `stopped`: the search ended before it had tried the whole catalogue."""
    errors = _unseen_error(fit, unit)
    drifts = [
        quantity(name, p) + f" instead of {p.nominal:.4g}" + _or(p.indistinguishable_from)
        for name, p in parameters.items()
        if p.drifted
    ]
    dated = [
        f"{numbers.words(c.parameter)} changes {_when(c)} from {c.before:.4g} to {c.after:.4g}"
        + _or(parameters[c.parameter].indistinguishable_from)
        for c in changes
    ]
    if verdict == "consistent":
        return f"The model as described explains the recording down to its noise. {errors}"
    if verdict == "parameter_drift":
        return f"No physics is missing: {'; '.join(dated or drifts)}. {errors}"
    named = " ".join(EFFECT[effect.id].sentence for effect in effects)
    also = f" Besides: {'; '.join(drifts)}." if drifts else ""
    listed = ", and ".join(numbers.words(effect.id) + _or(effect.indistinguishable_from) for effect in effects)
    if verdict == "missing_physics":
        return f"The model lacks {listed}. {named}{also} {errors}"
    helped = f" The recordings support {listed} beside it. {named}{also}" if effects else ""
    error = "An error remains so far." if stopped else "An error remains that is not explained."
    return f"{error}{helped} {errors}"


def unsure(doubted: Mapping[str, float], text: str) -> str:
    """The summary, with the probability of each effect that is not probable enough to be named, by id."""
    listed = ", ".join(f"{numbers.words(name)} ({numbers.percent(each)})" for name, each in doubted.items())
    return f"{text} Not sure enough to be named: {listed}." if listed else text


def needless(effects: Sequence[str], text: str) -> str:
    """The summary, with `effects` that would account for all but are not named: an error of any shape would do so."""
    if not effects:
        return text
    several = len(effects) > 1
    listed = numbers.words(", and ".join(effects)).capitalize()
    return (
        f"{text} {listed} would explain the remaining error, but so would an error that varies slowly and has no "
        f"physics: {'they are' if several else 'it is'} not named."
    )


def warned(data: Data, verdict: Verdict, text: str) -> str:
    """The summary after a warning where messages are missing.

    If the missing messages may have hidden anything, the summary has no conclusion.
    """
    if not data.warnings:
        return text
    warning = " ".join(data.warnings)
    added = math.sqrt(max(data.noise**2 - data.sensor_noise**2, 0.0))
    hidden = added > data.sensor_noise
    if hidden:
        warning += f" What is missing may move the signal by {added:.2g} {data.actuator.unit}, more than the noise."
    if verdict == "unexplained" or (hidden and verdict != "missing_physics"):
        warning += " Nothing can be concluded: record again with fewer other processes running."
    return f"{warning} {text}"


def remarked(remarks: Sequence[str], text: str) -> str:
    """The summary after the remarks on dirty recordings."""
    return " ".join([*remarks, text])


def provisional(text: str, stopped: bool) -> str:
    """The summary, marked where the search had to end before it was done."""
    return f"Stopped before all was tried; this is the best verdict yet. {text}" if stopped else text


def cautioned(limits: Sequence[Limit], text: str) -> str:
    """The summary, after the reason why the recordings cannot decide anything, if there is one."""
    decisive = [limit.finding for limit in limits if limit.decisive]
    return f"Nothing can be concluded: {' '.join(decisive)} {text}" if decisive else text


def advice(
    verdict: Verdict,
    effects: Sequence[Effect],
    parameters: Mapping[str, BaseParameter],
    hidden: Sequence[NotTestable],
    limits: Sequence[Limit],
    stops: bool = True,
) -> list[str]:
    """What to record next, most useful first; `stops`: whether the actuator has stops to run against."""
    steps = [limit.record for limit in limits]
    for effect in effects:
        for tie in effect.indistinguishable_from:
            steps.append(_separating(effect.id, tie, stops))
    for name, parameter in parameters.items():
        for tie in parameter.indistinguishable_from:
            steps.append(_separating(name, tie, stops))
    if verdict == "unexplained":
        steps.append(
            "Record the same movements again, cold and warm, slow and fast, to see what the remaining error depends on."
        )
    steps += [f"To see {numbers.words(item.id)}, record: {item.record}." for item in hidden]
    return list(dict.fromkeys(steps))


def untested(effects: Sequence[str]) -> list[str]:
    """The advice for effects whose limits were not computed for lack of time."""
    if not effects:
        return []
    listed = ", ".join(numbers.words(effect) for effect in effects)
    return [f"Time ran out before a limit was found for {listed}. Run again with --thorough."]


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


def _unseen_error(fit: FitQuality, unit: str) -> str:
    """How the error changes on data that no fit has seen, and a warning if it grows by more than chance."""
    before, after, floor = fit.validation.nominal_rmse, fit.validation.final_rmse, fit.noise_floor
    if before is None or after is None:
        return f"The error on data the fit has not seen is not known; the noise is {floor:.2g} {unit}."
    text = (
        f"On data the fit has not seen the error goes from {before:.3g} to {after:.3g} {unit}; "
        f"the noise is {floor:.2g} {unit}."
    )
    if after > EXPLAINED * before:
        text += " It grows: for predictions use the model as described, not the corrected one."
    return text
