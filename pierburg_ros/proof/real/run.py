"""Conducts the trials on the recordings of a machine: resumable, and countable at any moment."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from pierburg_ros.errors import InputError, near
from pierburg_ros.executors import Lost, ended
from pierburg_ros.proof.real.conduct import Bench, conduct, diagnose_others, take_up
from pierburg_ros.proof.real.machine import Machine
from pierburg_ros.proof.real.strengths import LEVELS, possible, tellable
from pierburg_ros.proof.real.trial import UNTOUCHED, WITHHELD, Trial
from pierburg_ros.proof.run import RUN
from pierburg_ros.proof.trial_run import DIAGNOSE, result
from pierburg_ros.version import source_version

RESULTS = "results.jsonl"
Report = Callable[[int, int, dict[str, Any] | None], None]
"""Called with trials done, trials at most, and the last result, None where such a trial does not exist."""


@dataclass(frozen=True)
class Plan:
    """Which trials are made: of these `kinds`, at these `levels`, on the first `most` recordings."""

    machine: Machine
    kinds: tuple[str, ...]
    levels: tuple[str, ...] = LEVELS
    most: int | None = None

    @property
    def untouched(self) -> list[Trial]:
        """Every recording as it is: the others are held against these."""
        names = list(self.machine.recordings)[: self.most]
        return [Trial(name, self.machine.half(name)) for name in names]

    def changed(self, level: str) -> list[Trial]:
        """The trials of a level, kind by kind within each recording."""
        kinds = [kind for kind in self.kinds if kind != UNTOUCHED]
        return [Trial(each.recording, each.half, kind, level) for each in self.untouched for kind in kinds]

    @property
    def stages(self) -> list[list[Trial]]:
        """What may be made at the same time, one after another: as they are, then level by level."""
        return [self.untouched, *(self.changed(level) for level in self.levels)]

    @property
    def trials(self) -> list[Trial]:
        """All of them, in the order in which they are begun."""
        return [trial for stage in self.stages for trial in stage]


def planned(machine: Machine, only: Sequence[str] = (), levels: Sequence[str] = (), most: int | None = None) -> Plan:
    """All that can be put into the recordings of `machine`, or `only` some kinds or `levels` of it."""
    actuator = machine.described.actuator
    withheld = (WITHHELD,) if actuator.drive == "voltage" else ()
    kinds = (UNTOUCHED, *possible(actuator), *tellable(actuator), *withheld)
    for what, asked, known in (("kind", only, kinds), ("level", levels, LEVELS)):
        for each in asked:
            if each not in known:
                raise InputError(
                    f"found {what} {each!r}, expected one of {', '.join(known)} for {actuator.name}.{near(each, known)}"
                )
    return Plan(machine, tuple(only) or kinds, tuple(each for each in LEVELS if not levels or each in levels), most)


def begin(output: Path, plan: Plan, budget: float) -> None:
    """Make the run's folder, or find it again; one of other recordings, another model or budget is refused."""
    if output.exists() and not output.is_dir():
        raise InputError(f"{output} is a file, expected a folder for the run. Choose another --output.")
    output.mkdir(parents=True, exist_ok=True)
    machine, note = plan.machine, output / RUN
    own = {"recordings": list(machine.recordings), "model": machine.described.text(), "budget": budget}
    if note.exists() and json.loads(note.read_text()) != own:
        raise InputError(f"{output} holds a run on other recordings, model or budget. Choose another --output.")
    take_up(machine, output)
    note.write_text(json.dumps(own))


def prove(
    output: Path,
    plan: Plan,
    budget: float,
    *,
    workers: int | None = None,
    scheduler: str | None = None,
    command: Sequence[str] = DIAGNOSE,
    report: Report = lambda done, total, last: None,
) -> list[dict[str, Any]]:
    """Conduct the trials that are missing and give the results; after SIGINT or SIGTERM, those done by then.

    Results belong to one version of the sources: that at the start. The workers of a cluster (`scheduler`) must see the
    folder `output` under the same path. InputError where the recordings cannot be diagnosed at all.
    """
    begin(output, plan, budget)
    bench, machine, done = Bench(output.resolve(), source_version(), budget, command), plan.machine, 0
    try:
        if not machine.known:
            halves = sorted({trial.half for trial in plan.untouched})
            asked = [(half, tuple(machine.others(half))) for half in halves]
            for (half, _), modelled in ended(partial(diagnose_others, bench=bench), asked, workers, scheduler):
                if isinstance(modelled, Lost):
                    raise InputError(f"The model for half {half + 1} could not be diagnosed: {modelled.reason}.")
        for stage in plan.stages:
            for _, last in ended(partial(conduct, bench=bench), stage, workers, scheduler):
                done += 1
                report(done, len(plan.trials), None if isinstance(last, Lost) else last)
    except KeyboardInterrupt:
        pass
    return results(bench, plan.trials)


def results(bench: Bench, trials: Iterable[Trial]) -> list[dict[str, Any]]:
    """Results of this version of the sources reached so far, in the order of the plan; written line by line too."""
    found = [label for trial in trials if (label := result(bench.folder(trial), bench.version)) is not None]
    lines = [json.dumps(label, allow_nan=False) + "\n" for label in found]
    (bench.output / RESULTS).write_text("".join(lines))
    return found
