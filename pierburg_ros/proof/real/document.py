"""Writes what the trials on real recordings came to, as the part of a machine in `proof-real.md`."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from pierburg_ros.effects import EFFECT
from pierburg_ros.pages.numbers import words
from pierburg_ros.proof.document import inserted, table
from pierburg_ros.proof.intervals import Share
from pierburg_ros.proof.real.run import Plan
from pierburg_ros.proof.real.strengths import LEVELS
from pierburg_ros.proof.real.trial import UNTOUCHED, WITHHELD
from pierburg_ros.proof.tally import share

Result = Mapping[str, Any]
Answer = Callable[[Result], bool | None]
MARKED = "results of `pierburg prove --real` on {}"
"""Name of the generated part of a machine in the document."""


@dataclass(frozen=True)
class Run:
    """Results of a run and what was planned."""

    results: Sequence[Result]
    plan: Plan

    def of(self, level: str, effects: bool = True) -> list[Result]:
        """The trials of a level in which an effect was put in, or else a number of the description was wrong."""
        changed = [result for result in self.results if result["true"] is not None and result["level"] == level]
        return [result for result in changed if effects == (result["kind"] in EFFECT)]

    def kind(self, kind: str) -> list[Result]:
        """The trials of a kind."""
        return [result for result in self.results if result["kind"] == kind]


def is_named(result: Result) -> bool | None:
    """Whether what was put in is named; None where the untouched recording is given that name too."""
    return None if result["already"] else bool(result["named"])


def has_value(result: Result) -> bool | None:
    """Whether the value of what is named is within the tolerance; None where it is not named."""
    return None if result["already"] or not result["named"] else bool(result["within"])


def has_more(result: Result) -> bool:
    """Whether an effect is named that neither was put in nor is named in the untouched recording."""
    return bool(result["beside"])


COLUMNS: Mapping[str, Answer] = {
    "shown": lambda result: bool(result["shown"]),
    "named": is_named,
    "of those shown": lambda result: is_named(result) if result["shown"] else None,
    "value within 25 %": has_value,
    "another effect beside": has_more,
}
"""What is counted of each kind and level."""


def headline(run: Run) -> dict[str, Share]:
    """The figures by which the diagnosis is judged on real recordings."""
    plain, wrong = run.of("plain"), run.of("plain", effects=False)
    shown, wrong_shown = ([result for result in of if result["shown"]] for of in (plain, wrong))
    return {
        "Effect put in at plain strength, and shown: named": share(shown, is_named),
        "of these, value within 25 % (shown)": share(shown, has_value),
        "Effect put in at plain strength, shown or not: named": share(plain, is_named),
        "of these, value within 25 %": share(plain, has_value),
        "not named, but among the explanations reported as equal": share(
            plain, lambda r: None if r["named"] or r["already"] else r["tied"]
        ),
        "given another effect beside what the untouched recording is given": share(plain, has_more),
        "Number of the description 1.3 times too high, and shown: its drift named": share(wrong_shown, is_named),
        "Number of the description 1.3 times too high, shown or not: its drift named": share(wrong, is_named),
        "of these, value within 25 % of that in the model of the other recordings": share(wrong, has_value),
        "Untouched recordings given one more effect (false alarms)": share(run.kind(UNTOUCHED), has_more),
        "Logged supply voltage withheld: given another effect": share(run.kind(WITHHELD), has_more),
        "Refused as a fault of the signals": share(run.results, lambda r: bool(r["refused"])),
        "Stopped before all was tried": share(run.results, lambda r: r["stopped"]),
        "No answer at all": share(run.results, lambda r: r["failure"] is not None),
    }


def by_kind(run: Run) -> str:
    """Per kind and level: trials, strength, named, value, more names."""
    rows = []
    for kind in run.plan.kinds:
        for level in LEVELS:
            of = [result for result in run.kind(kind) if result["level"] == level and result["true"] is not None]
            if of:
                strengths = between([r["strength"] for r in of]) + ("" if kind in EFFECT else " times")
                rows.append((words(kind), level, strengths, *(share(of, each) for each in COLUMNS.values())))
    head = ("put in", "level", "strength", *COLUMNS)
    return table(head, rows) if rows else "Nothing was put in."


def between(numbers: Iterable[float | None]) -> str:
    """The range of some numbers in words."""
    known = [number for number in numbers if number is not None]
    low, high = (f"{f(known):.3g}" for f in (min, max)) if known else ("-", "-")
    return low if low == high else f"{low} to {high}"


def each(run: Run) -> str:
    """Every trial: what was put in, the limit that the untouched recording gives, and what was answered."""
    rows = [
        (
            r["name"],
            "-" if r["strength"] is None else f"{r['strength']:.3g}",
            "-" if r["limit"] is None else f"{r['limit']:.3g}",
            "-" if r["shown"] is None else "yes" if r["shown"] else "no",
            "-" if r["true"] is None else f"{r['true']:.3g}",
            "-" if r["found"] is None else f"{r['found']:.3g}",
            answered(r),
        )
        for r in run.results
    ]
    return table(("trial", "put in", "ruled out from", "shown", "true", "found", "answered"), rows)


def answered(result: Result) -> str:
    """What a diagnosis said, in a few words."""
    if result["failure"]:
        return f"no answer: {result['failure']}"
    if result["refused"]:
        return f"refused: {'; '.join(result['refused'])}"
    named = [*map(words, result["effects"]), *(f"drift of {words(name)}" for name in result["drifted"])]
    late = ", stopped" if result["stopped"] else ""
    return f"{result['verdict']}{late} ({', '.join(named)})" if named else f"{result['verdict']}{late}"


def markdown(run: Run) -> str:
    """The generated part of a machine."""
    machine, results, count = run.plan.machine, run.results, len(run.plan.machine.recordings)
    seconds = [r["seconds"] for r in results if r["seconds"] > 0]
    took = (
        f" One diagnosis took {np.median(seconds):.0f} s (median), the longest {max(seconds):.0f} s." if seconds else ""
    )
    against = (
        "All are held against a model that was diagnosed from other recordings."
        if machine.known
        else "Every other one, by name, is held against the model that the rest were diagnosed to."
    )
    sections = [
        f"{count} recording{'s' if count > 1 else ''} of `{machine.name}`; n = {len(results)} of at most"
        f" {len(run.plan.trials)} planned trials. {against}{took}",
        table(("figure", "count (95 % Wilson interval)"), list(headline(run).items())),
        "By what was put in:\n\n" + by_kind(run),
        "Every trial:\n\n" + each(run) if results else "",
    ]
    return "\n\n".join(filter(None, sections)) + "\n"


def write(run: Run, output: Path, document: Path | None = None) -> None:
    """Write proof-real.md into `output`, and the machine's part into `document` where given."""
    text = markdown(run)
    (output / "proof-real.md").write_text(f"# {words(run.plan.machine.name)}\n\n{text}")
    if document is not None:
        part = MARKED.format(run.plan.machine.name)
        document.write_text(inserted(document.read_text() if document.exists() else "", part, text))
