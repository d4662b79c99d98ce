"""`pierburg prove`: seeded blind trials of the diagnosis."""

from __future__ import annotations

import signal
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.table import Table

from pierburg_ros.cli.jobs import JobsOption, SchedulerOption
from pierburg_ros.cli.progress import Step, Tell, progress
from pierburg_ros.cli.run import require_ros
from pierburg_ros.cli.terminal import terminal
from pierburg_ros.proof import document, run
from pierburg_ros.proof.graph import NotRecorded
from pierburg_ros.proof.plan import planned
from pierburg_ros.proof.trial_run import DIAGNOSE


def prove(
    output: Annotated[Path, typer.Option(help="Folder for trials and results; an earlier run there goes on.")],
    trials: Annotated[int | None, typer.Option(min=1, help="Trials of each kind in place of the full run.")] = None,
    only: Annotated[list[str] | None, typer.Option(help="Only this kind of trial; may be repeated.")] = None,
    seed: Annotated[int, typer.Option(min=0, help="Seed of everything that is drawn.")] = 1,
    jobs: JobsOption = None,
    scheduler: SchedulerOption = None,
    generate_only: Annotated[bool, typer.Option(help="Record the trials, diagnose nothing.")] = False,
    over_graph: Annotated[bool, typer.Option(help="Record over the ROS graph, by the three nodes.")] = False,
    docs: Annotated[Path | None, typer.Option(help="Document whose generated part is replaced.")] = None,
) -> object:
    """Seeded blind trials of the diagnosis: hide, seal, diagnose, open, score.

    Each trial hides an effect, a drift, two effects, something outside the catalogue, or nothing, in a valve
    simulated by a second formulation of the physics. Writes results.json and proof.md. After an interrupt it
    reports what is done; called again, it goes on. The workers of a cluster must see the output folder too.
    """
    plan = planned(seed, trials, only or [], over_graph)
    if over_graph:
        require_ros()
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    with progress() as show:
        reporter = Reporter(show)
        command = None if generate_only else DIAGNOSE
        results = run.prove(output, plan, workers=jobs, scheduler=scheduler, command=command, report=reporter)
    if generate_only:
        terminal().print(f"Recordings with their sealed labels in {output / 'trials'}")
        return {"trials": str(output / "trials")}
    done = document.Run(results, plan)
    document.write(done, output, docs)
    terminal().print(summary(done), f"Results in {output}: proof.md, results.json")
    return (output / "results.json").read_text(encoding="utf-8")


class Reporter:
    """Shows how far a run is, and how it stands."""

    def __init__(self, show: Tell) -> None:
        self.show = show
        self.right = self.alarms = 0
        show(Step("blind trials"))

    def __call__(self, done: int, total: int, last: dict[str, Any] | NotRecorded | None) -> None:
        if isinstance(last, NotRecorded):
            terminal(stderr=True).print(f"Not recorded, left out: {last}", soft_wrap=True)
        elif last is not None:
            self.right += last["right"]
            self.alarms += last["false_alarm"]
        self.show(Step("blind trials", done, total, f"{self.right} right, {self.alarms} false alarms"))


def summary(done: document.Run) -> Table:
    """The headline figures."""
    table = Table(title=f"Blind trials, n = {len(done.results)} of {done.plan.size}", title_justify="left")
    table.add_column("figure")
    table.add_column("count (95 % Wilson interval)")
    for name, share in document.headline(done).items():
        table.add_row(name, str(share))
    return table
