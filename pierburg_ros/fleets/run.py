"""Diagnoses and measures the recordings of a fleet: resumable, and whatever one of them is like."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from pierburg_ros.executors import Lost, ended
from pierburg_ros.fleets.recordings.units import Source
from pierburg_ros.fleets.store import Store
from pierburg_ros.fleets.structure import base_names, explained, own_effects, without_least
from pierburg_ros.fleets.task import Task
from pierburg_ros.fleets.work import Measurement, Outcome, examined, measured

Report = Callable[[str, int, int, str], None]
"""Told what is being done (`diagnosing`, `measuring`), how many are done, of how many, and what has just ended."""


@dataclass(frozen=True)
class Where:
    """Where the work is done: `jobs` processes of this machine, or the workers of a `scheduler`."""

    jobs: int | None = None
    scheduler: str | None = None


@dataclass(frozen=True)
class Examined:
    """A recording with the key of its result, what its diagnosis says, and what the fleet's model measures of it."""

    source: Source
    key: str
    result: dict[str, Any]
    measured: dict[str, Any]

    @property
    def problem(self) -> str | None:
        """Why it could not be used, None where it could."""
        return None if self.result["problem"] is None else str(self.result["problem"])


def conduct(sources: Sequence[Source], task: Task, store: Store, where: Where, report: Report) -> list[Examined]:
    """Every recording diagnosed and measured, as far as that is not done, in the order of the sources."""
    diagnosed = diagnosed_all(sources, task, store, where, report)
    usable = {
        path: (source, key, store.result(key)) for path, (source, key, problem) in diagnosed.items() if not problem
    }
    found = measured_all(list(usable.values()), task, store, where, report)
    return [
        Examined(source, key, {"problem": problem} if problem else store.result(key), found.get(path, {}))
        for path, (source, key, problem) in diagnosed.items()
    ]


def diagnosed_all(
    sources: Sequence[Source], task: Task, store: Store, where: Where, report: Report
) -> dict[str, tuple[Source, str, str | None]]:
    """By path: each source with the key of its result, or the reason why there is none. The store keeps results."""
    found: dict[str, tuple[Source, str, str | None]] = {}
    work = partial(examined, task=task, known=store.known())
    for done, (source, outcome) in enumerate(ended(work, sources, where.jobs, where.scheduler), start=1):
        if isinstance(outcome, Lost):
            outcome = Outcome("", {"problem": outcome.reason})
        problem = None if outcome.result is None else outcome.result["problem"]
        if outcome.result is None:
            problem = store.result(outcome.key)["problem"]
        elif outcome.key:
            store.keep(outcome.key, outcome.result, outcome.files)
        found[source.path] = (source, outcome.key, problem)
        report("diagnosing", done, len(sources), source.path)
    return {source.path: found[source.path] for source in sources}


def measured_all(
    usable: Sequence[tuple[Source, str, dict[str, Any]]], task: Task, store: Store, where: Where, report: Report
) -> dict[str, dict[str, Any]]:
    """By path: what the model of the fleet measures of each recording, with no more than the recordings determine."""
    names = base_names([result["findings"] for _, _, result in usable if explained(result)])
    while True:
        found = measured_with(names, usable, task, store, where, report)
        fewer = without_least(names, shares_determined(names, list(found.values())))
        if fewer == names:
            return found
        names = fewer


def measured_with(
    names: tuple[str, ...],
    usable: Sequence[tuple[Source, str, dict[str, Any]]],
    task: Task,
    store: Store,
    where: Where,
    report: Report,
) -> dict[str, dict[str, Any]]:
    """By path: the base parameters `names` and the own effects of each recording, fitted together."""
    asked = list(measurements(names, usable))
    found = {each.source.path: store.measured(each.key, each.names) for each in asked}
    left = [each for each in asked if found[each.source.path] is None]
    work = partial(measured, task=task)
    for done, (each, outcome) in enumerate(ended(work, left, where.jobs, where.scheduler), start=1):
        result = {"problem": outcome.reason, "values": {}} if isinstance(outcome, Lost) else outcome
        store.keep_measured(each.key, each.names, result)
        found[each.source.path] = result
        report("measuring", done, len(left), each.source.path)
    return {path: result["values"] for path, result in found.items() if result is not None}


def measurements(names: tuple[str, ...], usable: Sequence[tuple[Source, str, dict[str, Any]]]) -> Iterator[Measurement]:
    """What is to be measured of each recording that has anything to be measured."""
    for source, key, result in usable:
        values, free = own_effects(result["findings"])
        if (*names, *free) and not result["faults"]:
            yield Measurement(source, key, values, (*names, *free))


def shares_determined(names: Sequence[str], found: Sequence[dict[str, Any]]) -> dict[str, float]:
    """The share of the recordings that determine each base parameter."""
    known = [each for each in found if each]
    return (
        {name: sum(each[name]["determined"] for each in known) / max(len(known), 1) for name in names} if known else {}
    )
