"""Counts over the results of a run: shares with Wilson intervals, confusion, errors of values."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from pierburg_ros.proof.calibration import Named, named
from pierburg_ros.proof.concealment import WITH_REMAINDER, WITHOUT_EFFECT
from pierburg_ros.proof.formulation.values import CATALOGUE
from pierburg_ros.proof.intervals import Share
from pierburg_ros.proof.score import UNSEEN_TOLERANCE, WINDOW_SHARE

Result = Mapping[str, Any]


def share(results: Iterable[Result], holds: Callable[[Result], bool | None]) -> Share:
    """How many of the results something holds for; those for which it answers None do not count."""
    answers = [answer for answer in map(holds, results) if answer is not None]
    return Share(sum(answers), len(answers))


def effect_free(results: Iterable[Result]) -> list[Result]:
    """Trials without any effect: nothing concealed, a drift, or a change."""
    return [r for r in results if r["kind"] in WITHOUT_EFFECT]


def shown(results: Iterable[Result]) -> list[Result]:
    """Trials with one effect of the catalogue that their recording tells from drift."""
    return [r for r in results if r["kind"] in CATALOGUE and r["shown"]]


def right_if_shown(result: Result) -> bool | None:
    """Whether a trial is right; None where its recording does not show what is hidden."""
    return bool(result["right"]) if result["shown"] else None


def false_name(result: Result) -> bool | None:
    """Whether an effect is named that is not there; None where none is named."""
    return bool(set(result["named"]) - set(result["concealed"])) if result["named"] else None


def names(results: Iterable[Result]) -> list[Named]:
    """Every effect that the results name, with its confidence."""
    return [name for result in results for name in named(result["confidences"], result["concealed"])]


def windows_right(result: Result) -> bool | None:
    """Whether the windows hold what they could; None where the trial has no effect or it was not found."""
    if result["windows"] is None or not result["right"] or not result["shown"]:
        return None
    return bool(result["windows"] >= WINDOW_SHARE)


def unseen_right(result: Result) -> bool | None:
    """Whether the model follows unseen data to the noise; None where it is not asked for."""
    if result["kind"] in ("outside", "change", *WITH_REMAINDER) or not result["right"]:
        return None
    return result["unseen_ratio"] is not None and bool(result["unseen_ratio"] <= UNSEEN_TOLERANCE)


def values_right(result: Result) -> bool | None:
    """Whether all values that the recording owes are right; None where it owes none."""
    expected = [v for v in result["values"] if v["bound"] is not None and v["bound"] < 0.05]
    return bool(result["values_right"]) if expected and result["right"] else None


def answered(result: Result) -> str:
    """What a diagnosis said, in a few words."""
    if result["failure"]:
        return "no answer"
    names = " + ".join(result["named"])
    if result["verdict"] == "missing_physics":
        return names
    return f"{result['verdict']} ({names})" if names else str(result["verdict"])


def confusion(results: Iterable[Result]) -> dict[str, Counter[str]]:
    """For each kind of trial, and each physics outside the catalogue, how often each answer came."""
    counted: dict[str, Counter[str]] = {}
    for result in results:
        hidden = f"outside: {result['concealed'][0]}" if result["kind"] == "outside" else result["kind"]
        counted.setdefault(hidden, Counter())[answered(result)] += 1
    return counted


def value_errors(results: Iterable[Result]) -> list[dict[str, Any]]:
    """For each parameter of rightly named effects: trials, its errors, coverage of its interval."""
    by_name: dict[str, list[Any]] = {}
    for result in results:
        if result["right"]:
            for value in result["values"]:
                by_name.setdefault(value["name"], []).append(value)
    return [value_error(name, values) for name, values in sorted(by_name.items())]


def value_error(name: str, values: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """Errors of one parameter over its trials; a value that was not given is counted apart."""
    given = [v for v in values if v["found"] is not None]
    errors = [abs(v["found"] - v["true"]) / abs(v["true"]) for v in given]
    intervals = [v for v in given if v["interval"] is not None]
    covered = sum(v["interval"][0] <= v["true"] <= v["interval"][1] for v in intervals)
    return {
        "name": name,
        "trials": len(values),
        "given": len(given),
        "median_error": float(np.median(errors)) if errors else None,
        "ninetieth_error": float(np.quantile(errors, 0.9)) if errors else None,
        "coverage": Share(covered, len(intervals)),
    }


def median(results: Iterable[Result], number: Callable[[Result], float | None]) -> float | None:
    """Median over the results that have the number."""
    numbers = [found for found in map(number, results) if found is not None]
    return float(np.median(numbers)) if numbers else None


def reason(result: Result) -> str:
    """Why a trial counts as failed, as far as its score tells."""
    if result["failure"]:
        return str(result["failure"])
    if result["false_alarm"]:
        return "an effect claimed where there is none"
    if result["tied"]:
        return "another of the explanations that it reports as equal"
    missed = set(result["concealed"]) - set(result["named"])
    added = set(result["named"]) - set(result["concealed"])
    if result["kind"] == "outside" and result["named"]:
        return "explained by what the catalogue offers"
    if missed and not result["named"]:
        return "taken for drift" if result["verdict"] == "parameter_drift" else "not found"
    if missed or added:
        return f"missed {', '.join(sorted(missed)) or 'nothing'}; added {', '.join(sorted(added)) or 'nothing'}"
    if result["verdict"] != result["expected"]:
        return f"verdict {result['verdict']} for {result['expected']}"
    return "its exact tie is not in the answer"
