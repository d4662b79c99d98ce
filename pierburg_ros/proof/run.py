"""Conducts a run of blind trials over all cores, or over a cluster: resumable, and countable at any moment."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from pierburg_ros.errors import InputError
from pierburg_ros.executors import Lost, ended
from pierburg_ros.proof.graph import NotRecorded
from pierburg_ros.proof.plan import Plan
from pierburg_ros.proof.trial import Trial
from pierburg_ros.proof.trial_run import DIAGNOSE, conduct, prepare, result
from pierburg_ros.version import source_version

RUN = "run.json"
Report = Callable[[int, int, dict[str, Any] | NotRecorded | None], None]
"""Called with trials done, trials in all, and the last result: its score, or why it could not be recorded."""


def begin(output: Path, plan: Plan) -> None:
    """Make the run's folder, or find it again; a folder of another seed is refused."""
    if output.exists() and not output.is_dir():
        raise InputError(f"{output} is a file, expected a folder for the run. Choose another --output.")
    output.mkdir(parents=True, exist_ok=True)
    note = output / RUN
    if note.exists():
        earlier = json.loads(note.read_text())["seed"]
        if earlier != plan.seed:
            raise InputError(f"{output} holds a run of seed {earlier}, not {plan.seed}. Choose another --output.")
    note.write_text(json.dumps({"seed": plan.seed}))


def folder_of(trial: Trial, output: Path) -> Path:
    """Where a trial's files lie."""
    return output / "trials" / trial.name


def conduct_named(name: tuple[str, int], plan: Plan, output: Path, version: str, command: Sequence[str] | None) -> Any:
    """Conduct a trial of the plan, or only prepare it; runs in a worker process."""
    trial = plan.trial(*name)
    folder = folder_of(trial, output)
    try:
        return prepare(trial, folder) if command is None else conduct(trial, folder, version, command)
    except NotRecorded as problem:
        return problem


def prove(
    output: Path,
    plan: Plan,
    *,
    workers: int | None = None,
    scheduler: str | None = None,
    command: Sequence[str] | None = DIAGNOSE,
    report: Report = lambda done, total, last: None,
) -> list[dict[str, Any]]:
    """Conduct the trials that are missing and give the results; after SIGINT or SIGTERM, those done by then.

    Without a `command` to diagnose, the recordings are only made. Results belong to one version of the
    sources: that at the start. A trial that could not be recorded is reported, and missing from the results. The
    workers of a cluster (`scheduler`) must see the folder `output` under the same path.
    """
    begin(output, plan)
    version = source_version()
    work = partial(conduct_named, plan=plan, output=output, version=version, command=command)
    try:
        for done, (_, last) in enumerate(ended(work, plan.names, workers, scheduler), start=1):
            report(done, plan.size, NotRecorded(last.reason) if isinstance(last, Lost) else last)
    except KeyboardInterrupt:
        pass
    return results(output, plan, version)


def results(output: Path, plan: Plan, version: str) -> list[dict[str, Any]]:
    """Results of this version of the sources reached so far, in the order of the plan."""
    found = (result(folder_of(plan.trial(*name), output), version) for name in plan.names)
    return [label for label in found if label is not None]
