"""Conducts a run of blind trials over all cores: resumable, and countable at any moment."""

from __future__ import annotations

import json
import os
import signal
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, ProcessPoolExecutor, wait
from functools import partial
from itertools import islice
from pathlib import Path
from typing import Any

from pierburg_ros.errors import InputError
from pierburg_ros.processes import end_with_parent
from pierburg_ros.proof.graph import NotRecorded
from pierburg_ros.proof.plan import Plan
from pierburg_ros.proof.trial import Trial
from pierburg_ros.proof.trial_run import DIAGNOSE, conduct, prepare, result, source_version

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
    command: Sequence[str] | None = DIAGNOSE,
    report: Report = lambda done, total, last: None,
) -> list[dict[str, Any]]:
    """Conduct the trials that are missing and give the results; after SIGINT or SIGTERM, those done by then.

    Without a `command` to diagnose, the recordings are only made. Results belong to one version of the
    sources: that at the start. A trial that could not be recorded is reported, and missing from the results.
    """
    begin(output, plan)
    version = source_version()
    work = partial(conduct_named, plan=plan, output=output, version=version, command=command)
    cores = workers or os.cpu_count() or 1
    with ProcessPoolExecutor(cores, initializer=finish_when_interrupted) as pool:
        try:
            for done, last in enumerate(ended(pool, work, plan.names, cores), start=1):
                report(done, plan.size, last)
        except KeyboardInterrupt:
            pass
    return results(output, plan, version)


def ended(pool: Executor, work: Callable[..., Any], names: Iterable[Any], workers: int) -> Iterator[Any]:
    """What the work on each name gives, in the order in which it ends; never more under way than workers.

    A pool that is given all of it at once begins some of it even after an interrupt.
    """
    left = iter(names)
    under_way: set[Future[Any]] = set()
    while True:
        under_way |= {pool.submit(work, name) for name in islice(left, workers - len(under_way))}
        if not under_way:
            return
        finished, under_way = wait(under_way, return_when=FIRST_COMPLETED)
        yield from (future.result() for future in finished)


def finish_when_interrupted() -> None:
    """Leave an interrupt from the keyboard to the main process: a worker ends the trial under way first.

    A worker that is told to terminate gives its trial up, and ends the nodes that it has started; so does one whose
    main process has been killed.
    """
    end_with_parent(os.getppid(), signal.SIGTERM)
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.default_int_handler)


def results(output: Path, plan: Plan, version: str) -> list[dict[str, Any]]:
    """Results of this version of the sources reached so far, in the order of the plan."""
    found = (result(folder_of(plan.trial(*name), output), version) for name in plan.names)
    return [label for label in found if label is not None]
