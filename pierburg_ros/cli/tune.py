"""`pierburg tune`: PIFLC gains and sets for a stated goal over a set of plants."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict
from functools import partial
from itertools import count
from pathlib import Path
from typing import Annotated

import typer

from pierburg_ros.cli.jobs import JobsOption, SchedulerOption
from pierburg_ros.cli.progress import Step, progress
from pierburg_ros.cli.terminal import terminal
from pierburg_ros.closed_loop.designs import DESIGNS
from pierburg_ros.closed_loop.goal import QUANTITIES, Goal
from pierburg_ros.closed_loop.judgement import Judgement, judge
from pierburg_ros.closed_loop.plants import plant_set
from pierburg_ros.closed_loop.report import insert, report
from pierburg_ros.closed_loop.tune import STATED, Task
from pierburg_ros.closed_loop.tune import tune as find_settings
from pierburg_ros.control import parameter_file
from pierburg_ros.errors import InputError
from pierburg_ros.executors import Lost, ended
from pierburg_ros.library.output import write_whole
from pierburg_ros.pages.listing import Listing


def tune(
    output: Annotated[Path, typer.Option(help="ROS parameter file to write.")],
    settling: Annotated[
        float, typer.Option(min=1.0, max=100.0, help="Goal: settling time over the time-optimal bound.")
    ] = 2.0,
    overshoot: Annotated[float, typer.Option(min=0.1, max=100.0, help="Goal: overshoot in percent.")] = 2.0,
    steady_state_error: Annotated[
        float, typer.Option(min=0.01, max=90.0, help="Goal: error at standstill, in degrees.")
    ] = 0.3,
    hunting: Annotated[
        float, typer.Option(min=0.01, max=90.0, help="Goal: peak to peak at standstill, in degrees.")
    ] = 0.15,
    generations: Annotated[int, typer.Option(min=0, max=10000, help="Generations of the search.")] = 50,
    members: Annotated[int, typer.Option(min=4, max=1000, help="Candidates in each generation.")] = 20,
    seed: Annotated[int, typer.Option(min=0, help="Seed of the search.")] = 1,
    compare: Annotated[
        Path | None,
        typer.Option(help="Tune a plain PI and a PID as well; write the comparison into this Markdown file."),
    ] = None,
    jobs: JobsOption = None,
    scheduler: SchedulerOption = None,
) -> dict[str, object]:
    """Find PIFLC gains and sets for a goal, over plants cold, hot and with each effect of the catalogue.

    On a cluster each controller of a comparison is tuned by one worker.
    """
    for path in (output, compare):
        if path is not None and path.is_dir():
            raise InputError(f"{path} is a folder, expected a file. Name the file to write.")
    goal = Goal(settling, overshoot / 100.0, math.radians(steady_state_error), math.radians(hunting))
    names = ["PIFLC"] if compare is None else list(DESIGNS)
    if scheduler is None:
        plants = plant_set()
        judgements = [tuned(Task(DESIGNS[name], goal, plants), generations, members, seed, jobs) for name in names]
    else:
        judgements = tuned_on(scheduler, names, goal, generations, members, seed)
    write_whole(output, parameter_file(judgements[0].settings, heading(goal, judgements[0])))
    if compare is not None:
        document = compare.read_text(encoding="utf-8") if compare.exists() else ""
        write_whole(compare, insert(document, report(goal, judgements)))
    terminal().print(summary(goal, judgements), f"Parameters in {output}")
    return {"file": str(output), "settings": asdict(judgements[0].settings)}


def tuned_on(
    scheduler: str, names: Sequence[str], goal: Goal, generations: int, members: int, seed: int
) -> list[Judgement]:
    """Tune and judge controllers on the workers of a cluster, with progress on stderr."""
    found: dict[str, Judgement] = {}
    work = partial(tuned_there, goal=goal, generations=generations, members=members, seed=seed)
    with progress() as show:
        show(Step("controllers", 0, len(names)))
        for done, (name, judgement) in enumerate(ended(work, names, scheduler=scheduler), start=1):
            if isinstance(judgement, Lost):
                raise InputError(f"{name} could not be tuned: {judgement.reason}. Give workers more memory.")
            found[name] = judgement
            show(Step("controllers", done, len(names), what=name))
    return [found[name] for name in names]


def tuned_there(name: str, goal: Goal, generations: int, members: int, seed: int) -> Judgement:
    """A controller tuned and judged by the worker that runs this, with one thread."""
    task = Task(DESIGNS[name], goal, plant_set())
    return judge(task.design, find_settings(task, generations, members, seed, jobs=1), task.plants, jobs=1)


def tuned(task: Task, generations: int, members: int, seed: int, jobs: int | None = None) -> Judgement:
    """Tune one controller and judge it, with progress on stderr."""
    name = task.design.name
    with progress() as show:
        show(Step(f"{name}: searching", 0, generations))
        searched, judged = count(1), count(1)

        def on_generation(best: float) -> None:
            show(Step(f"{name}: searching", next(searched), generations, f"cost {best:.3f}"))

        def on_plant() -> None:
            show(Step(f"{name}: judging", next(judged), len(task.plants)))

        settings = find_settings(task, generations, members, seed, on_generation, jobs)
        return judge(task.design, settings, task.plants, on_plant, jobs)


def heading(goal: Goal, judgement: Judgement) -> list[str]:
    """What the parameter file says of itself."""
    lines = ["Tuned by `pierburg tune` on simulated plants; not validated on a real valve."]
    for plant in STATED:
        shares = judgement.shares(plant, goal).max(axis=0)
        told = ", ".join(f"{name} {share:.2f}" for name, share in zip(QUANTITIES, shares, strict=True))
        lines.append(f"{plant}, worst step as a share of the goal: {told}")
    return [line.replace("_", " ") for line in lines]


def summary(goal: Goal, judgements: Sequence[Judgement]) -> Listing:
    """Worst step on the plants with stated goals, as shares of the goals."""
    headings = ("plant", "controller", *(name.replace("_", " ") for name in QUANTITIES))
    rows = [
        (plant, each.name, *(f"{share:.2f}" for share in each.shares(plant, goal).max(axis=0)))
        for plant in STATED
        for each in judgements
    ]
    return Listing(headings, rows, "Median of the worst step as a share of the goal")
