"""Where the seconds of a diagnosis go: processor time of each stage, for recordings given.

    python benchmarks/diagnosis.py --output results/profile RECORDING...

Each recording is diagnosed in a process of its own with one fit at a time, its files are written, and its table is kept
in the output folder; called again it goes on. A stage counts without the stages inside it, so that they add up.
"""

from __future__ import annotations

import argparse
import importlib
import json
import os
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

from machine import machine, write_section

STAGES = {
    "read": ["library.reading.read"],
    "audit": ["diagnosis.diagnose.cleaned", "diagnosis.diagnose.audit", "diagnosis.diagnose.evidence"],
    "screening": ["diagnosis.search.search.Search.screened"],
    "race of the candidates": ["diagnosis.search.search.Search.race"],
    "ripples": ["diagnosis.search.search.Search._fit_ripples"],
    "refinement": ["diagnosis.search.search.Search.refine"],
    "search, the rest": ["diagnosis.diagnose.search"],
    "rivals": ["diagnosis.search.found.fit_rivals"],
    "drift of the nominal structure": ["diagnosis.search.together.recalibrated", "diagnosis.search.found.recalibrated"],
    "last values, intervals": ["diagnosis.search.found._last_values"],
    "disturbances": [f"diagnosis.diagnose.{name}" for name in ("untouched", "rounded", "unnamed", "apart")],
    "what remains": ["diagnosis.diagnose.remainder"],
    "verdict": ["diagnosis.diagnose.conclude", "diagnosis.diagnose.shares"],
    "limits": ["diagnosis.diagnose.limits"],
    "findings": [f"diagnosis.diagnose.{name}" for name in ("document", "signals", "exhibits")],
    "page": ["diagnosis.report.page.write_page"],
    "picture": ["library.diagnosing.Diagnosis.picture"],
    "overlay for viewers": ["library.diagnosing.write_mcap"],
}
"""Stages in their order, and what of the package does them."""
START, REST = "start of the program", "the rest"


class Stages:
    """Processor time [s] by stage, counted for the innermost stage that is at work."""

    def __init__(self) -> None:
        self.spent: Counter[str] = Counter()
        self._open = [REST]
        self._since = time.process_time()

    def _mark(self) -> None:
        now = time.process_time()
        self.spent[self._open[-1]] += now - self._since
        self._since = now

    def within(self, stage: str, work: Callable[..., Any]) -> Callable[..., Any]:
        """`work`, whose time counts for `stage`."""

        def timed(*arguments: Any, **named: Any) -> Any:
            self._mark()
            self._open.append(stage)
            try:
                return work(*arguments, **named)
            finally:
                self._mark()
                self._open.pop()

        return timed

    def watch(self) -> None:
        """Count what the functions of `STAGES` take from now on."""
        for stage, paths in STAGES.items():
            for path in paths:
                owner, name = _owner(path)
                setattr(owner, name, self.within(stage, getattr(owner, name)))


def _owner(path: str) -> tuple[Any, str]:
    """The module or class that holds what `path` names, and its name there."""
    *parts, name = path.split(".")
    classes = [parts.pop()] if parts[-1][0].isupper() else []
    owner: Any = importlib.import_module(".".join(["pierburg_ros", *parts]))
    for each in classes:
        owner = getattr(owner, each)
    return owner, name


def profile(recording: Path, budget: float) -> dict[str, Any]:
    """Diagnose one recording, write its files, and say what it took."""
    import pierburg_ros as pr

    load = os.getloadavg()[0]
    stages = Stages()
    stages.watch()
    stages.spent[START] = time.process_time()
    measured = pr.read(recording)
    found = pr.diagnose([measured], actuator="pierburg", jobs=1, budget=budget)
    with tempfile.TemporaryDirectory() as folder:
        found.write_into(Path(folder))
    stages._mark()
    return {
        "recording": f"{recording.parent.name}/{recording.stem}",
        "duration": measured.duration,
        "samples": int(measured.time.size),
        "verdict": found.verdict,
        "effects": list(found.effects),
        "seconds": dict(stages.spent),
        "load": load,
    }


def section(rows: list[dict[str, Any]], budget: float) -> str:
    """The table of all recordings."""
    names = [START, *STAGES, REST]
    used = [name for name in names if any(row["seconds"].get(name, 0.0) >= 0.05 for row in rows)]
    head = " | ".join(f"{row['recording']}, {row['duration']:.0f} s, {row['samples']:,} samples" for row in rows)
    lines = [f"| stage | {head} |", "|---|" + "---:|" * len(rows)]
    for name in used:
        lines.append(f"| {name} | " + " | ".join(f"{row['seconds'].get(name, 0.0):.1f}" for row in rows) + " |")
    lines.append("| **all** | " + " | ".join(f"{sum(row['seconds'].values()):.1f}" for row in rows) + " |")
    lines.append("| load average of the machine before | " + " | ".join(f"{row['load']:.1f}" for row in rows) + " |")
    lines.append("| verdict | " + " | ".join(verdict(row) for row in rows) + " |")
    return "\n".join(
        [
            "## Diagnosis, stage by stage",
            "",
            f"Processor time [s], one fit at a time, a budget of {budget:g} s, kernels compiled before. {machine()}.",
            "",
            *lines,
            "",
            "Made by `python benchmarks/diagnosis.py`. A stage counts without the stages inside it.",
        ]
    )


def verdict(row: dict[str, Any]) -> str:
    """What a diagnosis came to, in words."""
    return ", ".join([row["verdict"].replace("_", " "), *row["effects"]])


def main() -> None:
    """Profile each recording in a process of its own, and write the section."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recordings", type=Path, nargs="+")
    parser.add_argument("--output", type=Path, default=Path("results/profile"))
    parser.add_argument("--budget", type=float, default=120.0)
    parser.add_argument("--write", action=argparse.BooleanOptionalAction, default=True)
    parser.add_argument("--one", action="store_true", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.one:
        print(json.dumps(profile(given.recordings[0], given.budget)))
        return
    given.output.mkdir(parents=True, exist_ok=True)
    rows = []
    for recording in given.recordings:
        kept = given.output / f"{recording.parent.name}-{recording.stem}.json"
        if not kept.exists():
            command = [sys.executable, __file__, str(recording), "--one", "--budget", str(given.budget)]
            kept.write_text(subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True).stdout)
        rows.append(json.loads(kept.read_text()))
        print(rows[-1], flush=True)
    text = section(rows, given.budget)
    print(text)
    if given.write:
        write_section("diagnosis", text)


if __name__ == "__main__":
    main()
