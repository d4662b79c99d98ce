"""Writes what a run of blind trials came to: as JSON for machines, as Markdown for people."""

from __future__ import annotations

import json
import os
import platform
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from pierburg_ros.proof import calibration, tally
from pierburg_ros.proof.calibration_plot import draw
from pierburg_ros.proof.intervals import Share
from pierburg_ros.proof.plan import Plan

PLAIN, OVER_GRAPH = "results of `pierburg prove`", "results of `pierburg prove --over-graph`"
DIRTY = "results of `pierburg prove --dirty`"
"""Names of the generated parts in the document."""
Result = Mapping[str, Any]


@dataclass(frozen=True)
class Run:
    """Results of a run and what was planned."""

    results: Sequence[Result]
    plan: Plan


def row(*cells: object) -> str:
    """One line of a Markdown table."""
    return "| " + " | ".join(str(cell) for cell in cells) + " |"


def table(head: Sequence[str], rows: Sequence[Sequence[object]]) -> str:
    """A Markdown table."""
    return "\n".join([row(*head), row(*["---"] * len(head)), *(row(*cells) for cells in rows)])


def percent(value: float | None) -> str:
    """A share in percent, with the digits that matter."""
    return "-" if value is None else f"{100 * value:.2g} %"


def millivolts(value: float | None) -> str:
    """A voltage in millivolts."""
    return "-" if value is None else f"{1e3 * value:.3g}"


def headline(run: Run) -> dict[str, Share]:
    """The figures by which the diagnosis is judged."""
    results = run.results
    free, one = tally.effect_free(results), tally.shown(results)
    return {
        "Effect-free recordings given an effect (false alarms)": tally.share(free, lambda r: r["false_alarm"]),
        "Effect-free recordings with the right verdict": tally.share(free, lambda r: r["right"]),
        "Drifted parameter named, alone or in a reported tie": tally.share(results, lambda r: r["drift_named"]),
        "Change in mid-recording dated within 0.5 s": tally.share(results, lambda r: r["change_dated"]),
        "Change in mid-recording within the interval told": tally.share(results, lambda r: r.get("change_held")),
        "One effect that the recording shows: verdict, exact name, tie": tally.share(one, lambda r: r["right"]),
        "of these, open loop": tally.share(one, lambda r: None if r["closed_loop"] else r["right"]),
        "of these, closed loop": tally.share(one, lambda r: r["right"] if r["closed_loop"] else None),
        "wrong, but the truth is reported as an equal explanation": tally.share(one, lambda r: r["tied"]),
        "Rightly named: every value expected within 15 %": tally.share(results, tally.values_right),
        "Rightly named: windows hold 80 % of what they could": tally.share(results, tally.windows_right),
        "Rightly named: unseen data within 1.1 of the noise": tally.share(results, tally.unseen_right),
        "Two effects: verdict and both names": tally.share(kind(results, "two"), lambda r: r["right"]),
        "Outside the catalogue: unexplained": tally.share(kind(results, "outside"), lambda r: r["right"]),
        "Effect beside four wrong numbers, that the recording shows: verdict and exact name": tally.share(
            kind(results, "beside_guesses"), tally.right_if_shown
        ),
        "Effect beside a remainder, moving the signal more than that: exact name": tally.share(
            kind(results, "beside"), tally.right_if_shown
        ),
        "Remainder alone: nothing named": tally.share(kind(results, "remainder"), lambda r: r["right"]),
        "Recordings given names of which one is not there": tally.share(results, tally.false_name),
        "No answer at all": tally.share(results, lambda r: r["failure"] is not None),
    }


def kind(results: Sequence[Result], name: str) -> list[Result]:
    """The trials of one kind."""
    return [result for result in results if result["kind"] == name]


def by_kind(run: Run) -> str:
    """Per kind: trials, shown, right, values, windows, unseen error, RMSE before and after."""
    rows = []
    for name in run.plan.counts:
        of_kind = kind(run.results, name)
        visible = [r for r in of_kind if r["shown"]]
        errors = [
            tally.median(of_kind, lambda r, key=key: r["errors_volts"].get(key))  # type: ignore[misc]
            for key in ("training_nominal_rmse", "training_recalibrated_rmse", "training_final_rmse")
        ]
        unseen = tally.median(of_kind, lambda r: r["unseen_ratio"])
        rows.append(
            (
                name,
                f"{len(of_kind)} of {run.plan.counts[name]}",
                len(visible),
                tally.share(visible, lambda r: r["right"]),
                tally.share(of_kind, tally.values_right),
                tally.share(of_kind, tally.windows_right),
                *map(millivolts, errors),
                "-" if unseen is None else f"{unseen:.3f}",
            )
        )
    head = (
        "hidden",
        "trials",
        "shown",
        "right",
        "values",
        "windows",
        "nominal mV",
        "recalibrated mV",
        "final mV",
    )
    return table((*head, "unseen / noise"), rows)


def by_dirt(run: Run) -> str:
    """Per kind of dirt: trials, verdict and names right, dirt said, something named that is not there."""
    rows = []
    for name in run.plan.counts:
        of_kind = kind(run.results, name)
        counts = (sum(bool(r[what]) for r in of_kind) for what in ("right", "said", "harmed"))
        silent = sum(not (r["right"] or r["said"] or r["harmed"]) for r in of_kind)
        rows.append((name, len(of_kind), *counts, silent))
    return table(("dirt", "trials", "right", "said", "harmed", "neither right nor said"), rows)


def confusion(run: Run) -> str:
    """Per kind: what was answered how often, the most frequent first."""
    counted = tally.confusion(run.results)
    rows = [
        (name, "; ".join(f"{answer} {count}" for answer, count in answers.most_common()))
        for name, answers in sorted(counted.items())
    ]
    return table(("hidden", "answered (times)"), rows)


def values(run: Run) -> str:
    """Per parameter: errors and coverage."""
    rows = [
        (
            e["name"],
            f"{e['given']} of {e['trials']}",
            percent(e["median_error"]),
            percent(e["ninetieth_error"]),
            e["coverage"],
        )
        for e in tally.value_errors(run.results)
    ]
    return table(("parameter", "given", "median error", "90th percentile", "95 % interval holds the truth"), rows)


def confidence(run: Run) -> str:
    """Per class of confidence: what was said, and how often it was right."""
    return table(calibration.HEAD, calibration.rows(calibration.calibration(tally.names(run.results))))


def failures(run: Run) -> str:
    """Every trial that is not right."""
    rows = [
        (
            r["name"],
            "closed" if r["closed_loop"] else "open",
            ", ".join(r["concealed"]) or r["expected"],
            tally.answered(r),
            tally.reason(r),
        )
        for r in run.results
        if not r["right"]
    ]
    return table(("trial", "loop", "hidden", "answered", "why"), rows) if rows else "None."


def timing(run: Run) -> str:
    """How long the diagnoses took."""
    seconds = [r["seconds"] for r in run.results if r["seconds"] > 0]
    if not seconds:
        return "No diagnosis ended."
    middle, late, longest = np.quantile(seconds, [0.5, 0.9, 1.0])
    return (
        f"One diagnosis took {middle:.1f} s (median), 90 % under {late:.1f} s, none over {longest:.1f} s "
        f"({os.cpu_count()} cores, {platform.machine()}, Python {platform.python_version()})."
    )


def markdown(run: Run) -> str:
    """The generated part of `proof.md`."""
    cut = "" if len(run.results) == run.plan.size else " The run was cut short: every figure is for the trials done."
    if run.plan.dirty:
        return f"Seed {run.plan.seed}, n = {len(run.results)}.{cut} {timing(run)}\n\n{by_dirt(run)}\n"
    sections = [
        f"Seed {run.plan.seed}, n = {len(run.results)} of {run.plan.size} planned trials.{cut} {timing(run)}",
        table(("figure", "count (95 % Wilson interval)"), list(headline(run).items())),
        "### By what was hidden\n\nMedians; shown: the recording tells the effect from drift.\n\n" + by_kind(run),
        "### Confusion\n\n" + confusion(run),
        "### Values of rightly named effects\n\n" + values(run),
        "### How far a confidence holds\n\nOf the effects that were named, those that are there.\n\n" + confidence(run),
        "### What fails\n\n" + failures(run),
    ]
    return "\n\n".join(sections) + "\n"


def as_mapping(run: Run) -> dict[str, Any]:
    """The run for machines."""
    figures = {name: {"count": s.count, "n": s.total, "wilson95": s.interval} for name, s in headline(run).items()}
    return {
        "schema": 1,
        "seed": run.plan.seed,
        "n": len(run.results),
        "planned": run.plan.size,
        "figures": figures,
        "confusion": {name: dict(answers) for name, answers in tally.confusion(run.results).items()},
        "trials": list(run.results),
    }


def write(run: Run, output: Path, document: Path | None = None) -> None:
    """Write results.json, proof.md and calibration.png into `output`, the generated part into `document` if given."""
    (output / "results.json").write_text(json.dumps(as_mapping(run), indent=1, allow_nan=False) + "\n")
    text = markdown(run)
    (output / "proof.md").write_text(f"# Blind trials\n\n{text}")
    draw(calibration.calibration(tally.names(run.results)), output / "calibration.png")
    if document is not None:
        name = OVER_GRAPH if run.plan.over_graph else DIRTY if run.plan.dirty else PLAIN
        document.write_text(inserted(document.read_text() if document.exists() else "", name, text))


def marks(name: str) -> tuple[str, str]:
    """What stands before and after the generated part `name`."""
    return f"<!-- {name} -->", f"<!-- end of {name} -->"


def inserted(existing: str, name: str, text: str) -> str:
    """The document with `text` between the marks of `name`; appended with marks where it has none."""
    start, end = marks(name)
    part = f"{start}\n\n{text}\n{end}"
    if start not in existing or end not in existing:
        return f"{existing.rstrip()}\n\n{part}\n".lstrip()
    before, _, rest = existing.partition(start)
    return before + part + rest.partition(end)[2]
