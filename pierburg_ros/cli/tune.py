"""`pierburg tune`: PIFLC gains and sets for a stated goal over a set of plants."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from itertools import count
from pathlib import Path
from typing import Annotated

import typer

from pierburg_ros.cli.console.progress import Step, progress
from pierburg_ros.cli.console.terminal import terminal
from pierburg_ros.cli.options.jobs import JobsOption, SchedulerOption
from pierburg_ros.cli.options.models import ActuatorOption, ModelOption, chosen_model
from pierburg_ros.closed_loop.corrected import Promise, promises, starts, task_for
from pierburg_ros.closed_loop.designs import DESIGNS
from pierburg_ros.closed_loop.goal import QUANTITIES, Goal
from pierburg_ros.closed_loop.judgement import Judgement, judge
from pierburg_ros.closed_loop.plants import NOMINAL, plant_set
from pierburg_ros.closed_loop.report import insert, report
from pierburg_ros.closed_loop.tune import STATED, Task
from pierburg_ros.closed_loop.tune import tune as find_settings
from pierburg_ros.control import Settings, parameter_file, read_parameter_file
from pierburg_ros.errors import InputError
from pierburg_ros.executors import Lost, ended
from pierburg_ros.library.output import refuse_no_file, write_whole
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
    model: ModelOption = None,
    actuator: ActuatorOption = None,
    controller: Annotated[
        Path | None, typer.Option(help="Parameter file of the controller in use; by default the settings as shipped.")
    ] = None,
    predictor: Annotated[
        bool | None,
        typer.Option("--predictor/--no-predictor", help="Smith predictor; default: where the model has delay or lag."),
    ] = None,
    schedule: Annotated[
        bool | None,
        typer.Option(
            "--schedule/--no-schedule",
            help="Duty for the load, scheduled over the setpoint; default: where the model has no delay or lag.",
        ),
    ] = None,
    compare: Annotated[
        Path | None,
        typer.Option(help="Tune a plain PI and a PID as well; write the comparison into this Markdown file."),
    ] = None,
    jobs: JobsOption = None,
    scheduler: SchedulerOption = None,
) -> dict[str, object]:
    """Find PIFLC gains and sets for a goal, over plants cold, hot and with each effect of the catalogue.

    With --model or --actuator: for that plant, cold and hot, compared with the controller in use. Writes a ROS
    parameter file; 'ros2 param load /controller FILE' loads it into a running controller. On a cluster each controller
    of a comparison is tuned by one worker.
    """
    for path in (output, compare):
        if path is not None:
            refuse_no_file(path)
    goal = Goal(settling, overshoot / 100.0, math.radians(steady_state_error), math.radians(hunting))
    in_use = Settings() if controller is None else read_parameter_file(controller)
    effort = Effort(generations, members, seed, jobs)
    if model is not None or actuator is not None:
        refuse_for_one_plant({"--compare": compare, "--scheduler": scheduler})
        task = task_for(chosen_model(model, actuator), goal, predictor, schedule)
        return retuned(task, in_use, effort, output)
    if predictor is not None or controller is not None or schedule is not None:
        raise InputError("Found --predictor, --schedule or --controller, but no model. Add --model model.yaml.")
    names = ["PIFLC"] if compare is None else list(DESIGNS)
    if scheduler is None:
        plants = plant_set()
        judgements = [tuned(Task(DESIGNS[name], goal, plants), effort) for name in names]
    else:
        judgements = tuned_on(scheduler, names, goal, effort)
    write_whole(output, parameter_file(judgements[0].settings, heading(goal, judgements[0])))
    if compare is not None:
        document = compare.read_text(encoding="utf-8") if compare.exists() else ""
        write_whole(compare, insert(document, report(goal, judgements)))
    terminal().print(summary(goal, judgements), f"Parameters in {output}")
    return {"file": str(output), "settings": asdict(judgements[0].settings)}


@dataclass(frozen=True)
class Effort:
    """How long the search takes and how it begins."""

    generations: int
    members: int
    seed: int
    jobs: int | None


def refuse_for_one_plant(given: Mapping[str, object]) -> None:
    """Raise InputError where an option of the whole set of plants is given with a model."""
    for option, value in given.items():
        if value is not None:
            raise InputError(f"Found {option} with a model; it belongs to the set of plants. Leave one of them out.")


def retuned(task: Task, in_use: Settings, effort: Effort, output: Path) -> dict[str, object]:
    """Tune for one plant, write the parameter file, print and give what the loop did and will do."""
    before = judge(task.design, in_use, task.plants, jobs=effort.jobs)
    after = tuned(task, effort, starts(task, in_use))
    write_whole(output, parameter_file(after.settings, heading(task.goal, after)))
    both = {"before": promises(before), "after": promises(after)}
    console = terminal()
    console.print(outlook(both["before"], both["after"]))
    console.print(f"Parameters in {output}. Load them: ros2 param load /controller {output}", soft_wrap=True)
    predicted = {plant: {when: asdict(found[plant]) for when, found in both.items()} for plant in task.plants}
    return {"file": str(output), "settings": asdict(after.settings), "predicted": predicted}


def outlook(before: Mapping[str, Promise], after: Mapping[str, Promise]) -> Listing:
    """What the loop does at its worst step on each plant, before and after."""
    rows = [
        (
            "the model as it is" if plant == NOMINAL else plant,
            f"{1e3 * was.settling:.0f} -> {1e3 * will.settling:.0f}",
            f"{100.0 * was.overshoot:.1f} -> {100.0 * will.overshoot:.1f}",
            f"{math.degrees(was.steady_state_error):.2f} -> {math.degrees(will.steady_state_error):.2f}",
            f"{math.degrees(was.hunting):.2f} -> {math.degrees(will.hunting):.2f}",
        )
        for (plant, was), will in zip(before.items(), after.values(), strict=True)
    ]
    headings = ("plant", "settling [ms]", "overshoot [%]", "error [deg]", "hunting [deg]")
    return Listing(headings, rows, "Predicted for the worst step, before -> after")


def tuned_on(scheduler: str, names: Sequence[str], goal: Goal, effort: Effort) -> list[Judgement]:
    """Tune and judge controllers on the workers of a cluster, with progress on stderr."""
    found: dict[str, Judgement] = {}
    work = partial(tuned_there, goal=goal, effort=effort)
    with progress() as show:
        show(Step("controllers", 0, len(names)))
        for done, (name, judgement) in enumerate(ended(work, names, scheduler=scheduler), start=1):
            if isinstance(judgement, Lost):
                raise InputError(f"{name} could not be tuned: {judgement.reason}. Give workers more memory.")
            found[name] = judgement
            show(Step("controllers", done, len(names), what=name))
    return [found[name] for name in names]


def tuned_there(name: str, goal: Goal, effort: Effort) -> Judgement:
    """A controller tuned and judged by the worker that runs this, with one thread."""
    task = Task(DESIGNS[name], goal, plant_set())
    settings = find_settings(task, effort.generations, effort.members, effort.seed, jobs=1)
    return judge(task.design, settings, task.plants, jobs=1)


def tuned(task: Task, effort: Effort, known: Sequence[Settings] = ()) -> Judgement:
    """Tune one controller and judge it, with progress on stderr."""
    name = task.design.name
    with progress() as show:
        show(Step(f"{name}: searching", 0, effort.generations))
        searched, judged = count(1), count(1)

        def on_generation(best: float) -> None:
            show(Step(f"{name}: searching", next(searched), effort.generations, f"cost {best:.3f}"))

        def on_plant() -> None:
            show(Step(f"{name}: judging", next(judged), len(task.plants)))

        settings = find_settings(
            task, effort.generations, effort.members, effort.seed, on_generation, effort.jobs, known
        )
        return judge(task.design, settings, task.plants, on_plant, effort.jobs)


def heading(goal: Goal, judgement: Judgement) -> list[str]:
    """What the parameter file says of itself."""
    lines = ["Tuned by `pierburg tune` on simulated plants; not validated on a real valve."]
    for plant in (name for name in STATED if name in judgement.plants):
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
