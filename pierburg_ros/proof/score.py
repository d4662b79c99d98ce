"""Scores one diagnosis against the opened truth: verdict, names, ties, values, windows, unseen data."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, replace
from typing import Any

VALUE_TOLERANCE = 0.15  # of the true value, where the Cramer-Rao bound is under BOUND_TOLERANCE
BOUND_TOLERANCE = 0.05
WINDOW_SHARE = 0.8
UNSEEN_TOLERANCE = 1.1  # times the noise
DATE_TOLERANCE = 0.5  # s
KNOWN_TIES: Mapping[str, frozenset[str]] = {
    "viscous_friction.coefficient": frozenset({"armature_resistance", "torque_constant"}),
    "direction_dependent_friction.coulomb_difference": frozenset({"spring_preload", "coulomb_friction"}),
}
"""Exact ties from duty and Hall voltage alone, which belong in the answer."""
UNSCORED = ("phase", "end")


@dataclass(frozen=True)
class Value:
    """One parameter of a rightly named effect."""

    name: str
    true: float
    found: float | None
    interval: tuple[float, float] | None
    bound: float | None  # Cramer-Rao, relative

    @property
    def error(self) -> float:
        """Relative error [1]; infinite where no value was given."""
        if self.found is None:
            return math.inf
        return abs(self.found - self.true) / abs(self.true) if self.true else abs(self.found)

    @property
    def expected(self) -> bool:
        """Whether the recording holds enough to ask for the value."""
        return self.bound is not None and self.bound < BOUND_TOLERANCE

    @property
    def right(self) -> bool:
        """Whether the value is good enough, or cannot be asked for."""
        return not self.expected or self.error <= VALUE_TOLERANCE

    @property
    def covered(self) -> bool | None:
        """Whether the 95 % interval holds the truth; None where none was given."""
        return None if self.interval is None else self.interval[0] <= self.true <= self.interval[1]


@dataclass(frozen=True)
class Score:
    """What a trial came to; `right` asks for verdict, exact names and known ties."""

    name: str
    kind: str
    closed_loop: bool
    shown: bool
    expected: str
    verdict: str
    concealed: tuple[str, ...]
    named: tuple[str, ...]
    right: bool
    tied: bool  # wrongly named, but the truth is among the explanations reported as equal
    false_alarm: bool  # an effect claimed where there is none
    drift_named: bool | None
    change_dated: bool | None
    change_held: bool | None  # the interval told for the moment of a change holds it
    values: tuple[Value, ...]
    windows: float | None
    unseen_ratio: float | None
    errors_volts: Mapping[str, float | None] = field(default_factory=dict)
    seconds: float = 0.0
    failure: str | None = None
    said: bool = False  # the diagnosis says that the recording is dirty
    harmed: bool = False  # an effect, a drift or a change is named that is not there
    confidences: Mapping[str, float] = field(default_factory=dict)  # of each effect named

    @property
    def values_right(self) -> bool:
        """Whether every value that the recording owes is within tolerance."""
        return all(value.right for value in self.values)

    @property
    def complete(self) -> bool:
        """Right in every respect that applies to the trial."""
        windows = self.windows is None or self.windows >= WINDOW_SHARE
        follows = self.unseen_ratio is not None and self.unseen_ratio <= UNSEEN_TOLERANCE
        return self.right and self.values_right and windows and (follows or self.expected == "unexplained")

    def label(self) -> dict[str, Any]:
        """As it stands in result.json."""
        return {**asdict(self), "values_right": self.values_right, "complete": self.complete}


def alternatives(diagnosis: Mapping[str, Any]) -> list[frozenset[str]]:
    """Every explanation the diagnosis reports as equal to one of its own, as sets of names."""
    answers = [*diagnosis["effects"], *diagnosis.get("parameters", {}).values()]
    return [frozenset(tie) for answer in answers for tie in answer.get("indistinguishable_from", [])]


def ties_reported(truth: Mapping[str, Any], diagnosis: Mapping[str, Any]) -> bool:
    """Whether the exact ties of the concealed effect are in the answer."""
    for effect in truth["effects"]:
        acting = {name for name, given in effect["parameters"].items() if given["value"] != 0.0}
        for name in acting:
            tie = KNOWN_TIES.get(f"{effect['id']}.{name}")
            if tie and len(acting) == 1 and tie not in alternatives(diagnosis):
                return False
    return True


def named_rightly(truth: Mapping[str, Any], diagnosis: Mapping[str, Any], shown: bool) -> bool:
    """Verdict and exact names; of an effect the recording does not show, silence is right as well.

    Of several effects, those that the recording does not show beside the others may be left out. Beside a remainder the
    names are asked for, whether or not the verdict says that something is left.
    """
    named = {effect["id"] for effect in diagnosis["effects"]}
    if truth.get("remainder"):
        concealed = {effect["id"] for effect in truth["effects"]}
        return named == concealed or (not shown and not named)
    if truth["verdict"] == "unexplained":
        exact = diagnosis["verdict"] == "unexplained"
    else:
        concealed = {effect["id"] for effect in truth["effects"]}
        expected = concealed.difference(truth["visibility"].get("faint", ()))
        exact = diagnosis["verdict"] == truth["verdict"] and expected <= named <= concealed
    silent = diagnosis["verdict"] in ("consistent", "parameter_drift") and not named
    has_effect = truth["verdict"] in ("missing_physics", "unexplained")
    return (exact and ties_reported(truth, diagnosis)) or (has_effect and not shown and silent)


def values_of(truth: Mapping[str, Any], diagnosis: Mapping[str, Any]) -> tuple[Value, ...]:
    """Each concealed parameter beside what was found, for effects that both name."""
    found = {effect["id"]: effect["parameters"] for effect in diagnosis["effects"]}
    bounds = truth["visibility"]["bounds"]
    values = []
    for effect in truth["effects"]:
        for name, given in effect["parameters"].items():
            if effect["id"] not in found or name in UNSCORED or given["value"] == 0.0:
                continue
            answer = found[effect["id"]].get(name) or {}
            interval = answer.get("ci95")
            bound = bounds.get(f"{effect['id']}.{name}")
            values.append(
                Value(
                    f"{effect['id']}.{name}",
                    given["value"],
                    answer.get("value"),
                    (interval[0], interval[1]) if interval and None not in interval else None,
                    bound,
                )
            )
    return tuple(values)


def drift_named(truth: Mapping[str, Any], diagnosis: Mapping[str, Any]) -> bool | None:
    """Whether the drifted parameter is named, alone or in a reported tie.

    None where none drifted, or several: what these do together others do as well.
    """
    drifted = set(truth["drifted"])
    if len(drifted) != 1:
        return None
    given = diagnosis.get("parameters", {})
    named = {name for name, parameter in given.items() if parameter.get("drifted")}
    tied = {name for tie in alternatives(diagnosis) for name in tie}
    return drifted <= named | tied


def change_dated(truth: Mapping[str, Any], diagnosis: Mapping[str, Any]) -> bool | None:
    """Whether a change in the middle was found at its time; None where there was none."""
    if not truth["changes"]:
        return None
    when = truth["changes"][0]["time"]
    return any(abs(change["time"] - when) <= DATE_TOLERANCE for change in diagnosis.get("changes", []))


def change_held(truth: Mapping[str, Any], diagnosis: Mapping[str, Any]) -> bool | None:
    """Whether the interval told for the moment of a change holds it; None where there was no change."""
    if not truth["changes"]:
        return None
    when = truth["changes"][0]["time"]
    told = [change["time_ci95"] for change in diagnosis.get("changes", []) if change.get("time_ci95")]
    return any(low <= when <= high for low, high in told)


def said(diagnosis: Mapping[str, Any]) -> bool:
    """Whether the diagnosis says that something is wrong with the recording."""
    quality = diagnosis.get("data_quality") or {}
    return any((diagnosis.get("excluded"), diagnosis.get("input_faults"), quality.get("dirt")))


def harmed(truth: Mapping[str, Any], diagnosis: Mapping[str, Any]) -> bool:
    """Whether an effect, a drift or a change is named that is not there."""
    effects = {effect["id"] for effect in diagnosis["effects"]}
    drifts = {name for name, given in diagnosis.get("parameters", {}).items() if given.get("drifted")}
    moved = {*truth["drifted"], *(change["parameter"] for change in truth["changes"])}
    return bool(effects - {effect["id"] for effect in truth["effects"]} or drifts - moved)


def failed(truth: Mapping[str, Any], why: str) -> Score:
    """Score of a diagnosis that gave no answer."""
    nothing = {"verdict": "none", "effects": []}
    return replace(score(truth, nothing, None, None), right=False, failure=why)


def score(
    truth: Mapping[str, Any], diagnosis: Mapping[str, Any], windows: float | None, unseen_rmse: float | None
) -> Score:
    """Score one diagnosis; `windows` as in `windows.share_of_best`, `unseen_rmse` [V] of its model."""
    concealed = tuple(sorted(effect["id"] for effect in truth["effects"]))
    named = tuple(sorted(effect["id"] for effect in diagnosis["effects"]))
    shown = bool(truth["visibility"]["shown"]) or truth["verdict"] in ("consistent", "parameter_drift")
    right = named_rightly(truth, diagnosis, shown)
    noise = truth["visibility"]["noise"]
    fit = diagnosis.get("fit", {})
    errors = {f"{part}_{name}": rmse for part in ("training", "validation") for name, rmse in fit.get(part, {}).items()}
    return Score(
        name=truth["id"],
        kind=truth["kind"],
        closed_loop=truth["severity"] == "concealed",
        shown=shown,
        expected=truth["verdict"],
        verdict=diagnosis["verdict"],
        concealed=concealed or ((truth["not_in_catalogue"],) if truth["not_in_catalogue"] else ()),
        named=named,
        right=right,
        tied=not right and bool(concealed) and frozenset(concealed) in alternatives(diagnosis),
        false_alarm=not concealed and not truth["not_in_catalogue"] and bool(named),
        drift_named=drift_named(truth, diagnosis),
        change_dated=change_dated(truth, diagnosis),
        change_held=change_held(truth, diagnosis),
        values=values_of(truth, diagnosis),
        windows=windows,
        unseen_ratio=None if unseen_rmse is None else unseen_rmse / noise,
        errors_volts={**errors, "unseen": unseen_rmse},
        said=said(diagnosis),
        harmed=harmed(truth, diagnosis),
        confidences={effect["id"]: effect["confidence"] for effect in diagnosis["effects"]},
    )
