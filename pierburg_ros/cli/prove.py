"""`pierburg prove`: seeded blind trials of the diagnosis, or known effects put into real recordings."""

from __future__ import annotations

import signal
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any

import typer

from pierburg_ros.cli import prove_real
from pierburg_ros.cli.console.progress import Step, Tell, progress
from pierburg_ros.cli.console.terminal import terminal
from pierburg_ros.cli.options.jobs import BudgetOption, JobsOption, SchedulerOption
from pierburg_ros.cli.options.models import ActuatorOption, ModelOption
from pierburg_ros.cli.options.recordings import SignalsOption, TimeOption, TopicOption
from pierburg_ros.cli.prove_real import LevelOption, RealOption
from pierburg_ros.cli.run import require_ros
from pierburg_ros.errors import InputError
from pierburg_ros.pages.listing import Listing
from pierburg_ros.proof import document, run
from pierburg_ros.proof.graph import NotRecorded
from pierburg_ros.proof.plan import planned
from pierburg_ros.proof.trial_run import DIAGNOSE


def prove(
    output: Annotated[Path, typer.Option(help="Folder for trials and results; an earlier run there goes on.")],
    real: RealOption = None,
    trials: Annotated[
        int | None, typer.Option(min=1, help="Trials of each kind; with --real, recordings that are used.")
    ] = None,
    only: Annotated[list[str] | None, typer.Option(help="Only this kind of trial; may be repeated.")] = None,
    seed: Annotated[int, typer.Option(min=0, help="Seed of everything that is drawn.")] = 1,
    jobs: JobsOption = None,
    scheduler: SchedulerOption = None,
    generate_only: Annotated[bool, typer.Option(help="Record the trials, diagnose nothing.")] = False,
    over_graph: Annotated[bool, typer.Option(help="Record over the ROS graph, by the three nodes.")] = False,
    dirty: Annotated[
        bool, typer.Option("--dirty", help="Spoil the recordings, each trial by one kind of dirt.")
    ] = False,
    docs: Annotated[Path | None, typer.Option(help="Document whose generated part is replaced.")] = None,
    level: LevelOption = None,
    budget: BudgetOption = "",
    actuator: ActuatorOption = None,
    model: ModelOption = None,
    signals: SignalsOption = None,
    topic: TopicOption = None,
    time: TimeOption = None,
) -> object:
    """Seeded blind trials of the diagnosis: hide, seal, diagnose, open, score.

    Each trial hides an effect, a drift, two effects, something outside the catalogue, or nothing, in a valve
    simulated by a second formulation of the physics. Writes results.json, proof.md and calibration.png. After an
    interrupt it reports what is done; called again, it goes on. The workers of a cluster must see the output folder
    too.

    With --real, effects are put into your own recordings, by changing their channels where that is exact. The diagnosis
    has to find them beside all that is really there. It starts from a model of your other recordings. Writes
    results.jsonl and proof-real.md.
    """
    if real is not None:
        why = "with --real, where nothing is recorded. Leave it out"
        refuse(why, {"--generate-only": generate_only, "--over-graph": over_graph, "--dirty": dirty})
        machine = prove_real.machine(real, actuator, model, signals, topic, time)
        return prove_real.prove(machine, output, only or [], level or [], trials, jobs, scheduler, budget, docs)
    given: dict[str, object] = {"--level": level, "--budget": budget, "--actuator": actuator, "--model": model}
    given |= {"--signals": signals, "--topic": topic, "--time": time}
    refuse("without --real, expected the folder of recordings that it is about", given)
    plan = planned(seed, trials, only or [], over_graph, dirty)
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
    console = terminal()
    console.print(summary(done))
    console.print(f"Results in {output}: proof.md, results.json, calibration.png", soft_wrap=True)
    return (output / "results.json").read_text(encoding="utf-8")


def refuse(why: str, given: Mapping[str, object]) -> None:
    """Raise InputError for options that say nothing here, and `why`."""
    for option, value in given.items():
        if value:
            raise InputError(f"Found {option} {why}.")


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


def summary(done: document.Run) -> Listing:
    """The headline figures."""
    rows = [(name, str(share)) for name, share in document.headline(done).items()]
    title = f"Blind trials, n = {len(done.results)} of {done.plan.size}"
    return Listing(("figure", "count (95 % Wilson interval)"), rows, title)
