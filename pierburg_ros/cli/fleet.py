"""`pierburg fleet`: many recordings of many actuators, diagnosed, put into tables, followed over the life of each."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer

from pierburg_ros.cli.console.progress import Step, progress
from pierburg_ros.cli.console.terminal import terminal
from pierburg_ros.cli.options.jobs import BudgetOption, JobsOption, SchedulerOption
from pierburg_ros.cli.options.models import ActuatorOption, ModelOption
from pierburg_ros.cli.options.recordings import SignalsOption, TimeOption, TopicOption, topics_of
from pierburg_ros.errors import InputError


def fleet(
    recordings: Annotated[
        str, typer.Argument(help="Folder, glob in quotes, or table (CSV, Parquet: recording, unit, time).")
    ],
    output: Annotated[Path, typer.Option(help="Folder for the results; an earlier run there goes on.")],
    pattern: Annotated[
        str | None,
        typer.Option(help="Where unit and date stand in a path below the folder, e.g. '{unit}/{date}_*.mcap'."),
    ] = None,
    limit: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME=VALUE",
            help="Say when a quantity reaches a value, e.g. armature_resistance=5.0; again for more.",
        ),
    ] = None,
    actuator: ActuatorOption = None,
    model: ModelOption = None,
    signals: SignalsOption = None,
    topic: TopicOption = None,
    time: TimeOption = None,
    jobs: JobsOption = None,
    scheduler: SchedulerOption = None,
    budget: BudgetOption = "1",
) -> str:
    """Diagnose many recordings of many actuators; say how each ages, and which to look at first.

    Writes recordings.parquet, findings.parquet, ageing.parquet, fleet.json and fleet.html to the output folder, and the
    report of each recording below it. Called again it diagnoses only what is new.
    """
    from pierburg_ros.fleets.fleet import fleet as fleet_found

    limits = limits_of(limit)
    with progress() as show:

        def report(stage: str, done: int, total: int, last: str) -> None:
            show(Step(stage, done, total, what=last.rpartition("/")[2]))

        found = fleet_found(
            recordings,
            output,
            actuator=actuator,
            model=model,
            pattern=pattern,
            limits=limits,
            signals=signals,
            topics=topics_of(topic),
            time=time,
            budget=budget,
            jobs=jobs,
            scheduler=scheduler,
            progress=report,
        )
    console = terminal()
    for each in found.recordings:
        if each.problem:
            console.print(f"Not used: {each.source.path}: {each.problem}", soft_wrap=True)
    console.print(found.sentence, soft_wrap=True)
    console.print(
        f"Results in {output}: fleet.html, fleet.json, recordings.parquet, findings.parquet, ageing.parquet",
        soft_wrap=True,
    )
    return found.to_json()


def limits_of(options: Sequence[str] | None) -> dict[str, float]:
    """{"armature_resistance": 5.0} from ["armature_resistance=5.0"]."""
    limits = {}
    for option in options or ():
        name, _, value = option.partition("=")
        try:
            limits[name.strip()] = float(value)
        except ValueError:
            raise InputError(
                f"--limit found {option!r}, expected NAME=VALUE. Write --limit armature_resistance=5.0."
            ) from None
    return limits
