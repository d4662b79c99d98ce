"""Scores the diagnosis of one real recording: what was put in is named or not, its value, and what is named beside."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from pierburg_ros.proof.real.trial import UNTOUCHED
from pierburg_ros.proof.score import alternatives

REAL_VALUE_TOLERANCE = 0.25
"""Share of the true value by which a value may be off. Given: 25 % beside all that is really in a recording."""


@dataclass(frozen=True)
class Score:
    """What a trial came to.

    `named` counts an effect by its id and a wrong number by its drift. `tied`: it is among the explanations reported as
    equal. `already`: the untouched recording is given the same name against the same model, so that finding it again
    proves nothing. `shown`: the recording can show it, None where nothing is looked for. `beside` are names that
    neither the trial nor the untouched recording has; `refused` what was said of the signals in place of a verdict.
    """

    name: str
    recording: str
    half: int
    kind: str
    level: str
    strength: float | None
    limit: float | None
    verdict: str
    effects: tuple[str, ...]
    drifted: tuple[str, ...]
    named: bool
    tied: bool
    already: bool
    shown: bool | None
    true: float | None
    found: float | None
    within: bool | None
    beside: tuple[str, ...]
    refused: tuple[str, ...] = ()
    stopped: bool = False
    seconds: float = 0.0
    failure: str | None = None

    def label(self) -> dict[str, Any]:
        """As it stands in result.json."""
        return asdict(self)


def names(diagnosis: Mapping[str, Any]) -> tuple[set[str], set[str]]:
    """Ids of the effects that a diagnosis names, and names of the parameters that it says have drifted or changed."""
    effects = {effect["id"] for effect in diagnosis["effects"]}
    drifted = {name for name, each in diagnosis.get("parameters", {}).items() if each.get("drifted")}
    changed = {change["parameter"] for change in diagnosis.get("changes", [])}
    return effects, drifted | changed


def value_of(name: str, diagnosis: Mapping[str, Any]) -> float | None:
    """The value that a diagnosis gives a base parameter, or an effect's by dotted name; None where it gives none."""
    effect, _, parameter = name.rpartition(".")
    given = diagnosis.get("parameters", {})
    for each in diagnosis["effects"]:
        if each["id"] == effect:
            given = {name: each["parameters"].get(parameter, {})}
    value = given.get(name, {}).get("value")
    return None if value is None else float(value)


def score(truth: Mapping[str, Any], diagnosis: Mapping[str, Any], untouched: Mapping[str, Any]) -> Score:
    """Score a diagnosis; `untouched` is that of the recording as it is, against the model of the other half."""
    kind, true = truth["kind"], truth["true"]
    effects, drifted = names(diagnosis)
    before, drifted_before = names(untouched)

    def is_named(effects: set[str], drifted: set[str]) -> bool:
        return kind in effects or any(name in drifted for name in true)

    name, expected = next(iter(true.items())) if true else ("", None)
    found = value_of(name, diagnosis) if true and is_named(effects, drifted) else None
    within = (
        None if found is None or expected is None else abs(found - expected) <= REAL_VALUE_TOLERANCE * abs(expected)
    )
    return Score(
        name=truth["id"],
        recording=truth["recording"],
        half=truth["half"],
        kind=kind,
        level=truth["level"],
        strength=truth["strength"],
        limit=truth["limit"],
        verdict=diagnosis["verdict"],
        effects=tuple(sorted(effects)),
        drifted=tuple(sorted(drifted)),
        named=bool(true) and is_named(effects, drifted),
        tied=bool(true) and any({kind, *true} & tie for tie in alternatives(diagnosis)),
        already=bool(true) and is_named(before, drifted_before),
        shown=truth["shown"],
        true=expected,
        found=found,
        within=within,
        beside=tuple(sorted(effects - {kind} - (set() if kind == UNTOUCHED else before))),
        refused=tuple(f"{fault['signal']}: {fault['what']}" for fault in diagnosis.get("input_faults", [])),
        stopped=diagnosis.get("effort", {}).get("stopped_by") is not None,
    )
