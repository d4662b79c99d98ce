"""`pierburg diagnose`: locate the mismatch, name the missing physics, model it, show the fit improve."""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module
from pathlib import Path
from threading import Thread
from typing import TYPE_CHECKING, Annotated

import typer

from pierburg_ros.budget import USUAL_BUDGET, Budget
from pierburg_ros.cli.console.progress import Step, progress
from pierburg_ros.cli.console.terminal import terminal
from pierburg_ros.cli.options.jobs import BudgetOption, JobsOption
from pierburg_ros.cli.options.models import ActuatorOption, ModelOption, chosen_model
from pierburg_ros.cli.options.recordings import (
    ExactOption,
    ResultsOption,
    SignalsOption,
    TimeOption,
    TopicOption,
    results_folder,
    topics_of,
)
from pierburg_ros.cli.options.viewers import RerunOption
from pierburg_ros.errors import InputError
from pierburg_ros.library.output import output_folder

if TYPE_CHECKING:
    from pierburg_ros.library.diagnosing import Diagnosis
    from pierburg_ros.library.model import Model
    from pierburg_ros.recording import Recording

DRAWING = ("pierburg_ros.diagnosis.report.page", "pierburg_ros.diagnosis.report.picture")
"""Modules that only the results need."""


def diagnose(
    context: typer.Context,
    recordings: Annotated[list[Path], typer.Argument(help="MCAP, rosbag2 directories or CSV, of one actuator.")],
    output: ResultsOption = None,
    simulation: Annotated[
        list[Path] | None,
        typer.Option(
            metavar="SIM...",
            help="Recordings of the same actuator by your own simulator: say what that one lacks.",
        ),
    ] = None,
    simulation_signals: Annotated[
        Path | None, typer.Option(help="Signal map of your simulator's recordings, if not that of --signals.")
    ] = None,
    actuator: ActuatorOption = None,
    model: ModelOption = None,
    signals: SignalsOption = None,
    topic: TopicOption = None,
    time: TimeOption = None,
    exact: ExactOption = None,
    rerun: RerunOption = None,
    jobs: JobsOption = None,
    budget: BudgetOption = "1",
    thorough: Annotated[bool, typer.Option("--thorough", help="Try everything, however long it takes.")] = False,
    force: Annotated[bool, typer.Option("--force", help="Conclude although the signals seem at fault.")] = False,
) -> str:
    """Say what the simulation lacks: where, which physics, how sure, and what to record next.

    Writes diagnosis.json, model.yaml, report.html, overview.png and diagnosis.mcap (for Foxglove and PlotJuggler,
    beside the recording) to the output folder. Ctrl-C gives the best verdict yet.
    """
    from pierburg_ros.diagnosis.report.terminal import shown
    from pierburg_ros.library.reading import read

    budgeted = context.get_parameter_source("budget")
    if thorough and budgeted is not None and budgeted.name == "COMMANDLINE":
        raise InputError("Found --thorough with --budget, expected one of them: it has no limit. Leave one out.")
    nominal, output = chosen_model(model, actuator), results_folder(output, "diagnose", recordings[0])
    if simulation_signals and not simulation:
        raise InputError("Found --simulation-signals without --simulation. Name the recordings of your simulator.")

    def taken(paths: Sequence[Path], named: Path | None) -> list[Recording]:
        topics = topics_of(topic)
        sure, machine = exact or (), nominal.actuator
        return [read(each, time=time, topics=topics, signals=named, actuator=machine, exact=sure) for each in paths]

    measured = taken(recordings, signals)
    try:
        simulated = taken(simulation or (), simulation_signals or signals)
    except InputError as error:
        if signals is None or simulation_signals is not None:
            raise
        raise InputError(f"{error} Or give your simulator's recordings a map: --simulation-signals FILE.") from None
    # it takes a second to load what draws the results: beside the search, whose compiled code leaves room for it
    Thread(target=lambda: [import_module(each) for each in DRAWING]).start()
    with output_folder(output) as folder:
        diagnosis = diagnosed_with_progress(
            measured, nominal, jobs, Budget.of(None if thorough else budget), simulated, force
        )
        diagnosis.write_into(folder)
    if rerun:
        diagnosis.write_rerun(rerun)
    console = terminal()
    console.print(shown(diagnosis.document))
    console.print(
        f"Results in {output}: report.html, diagnosis.json, model.yaml, overview.png, diagnosis.mcap", soft_wrap=True
    )
    return diagnosis.to_json()


def diagnosed_with_progress(
    recordings: Sequence[Recording],
    nominal: Model,
    jobs: int | None = None,
    budget: Budget = USUAL_BUDGET,
    simulation: Sequence[Recording] = (),
    force: bool = False,
) -> Diagnosis:
    """The diagnosis of what `nominal` lacks, with a bar on stderr that names what is being tried."""
    from pierburg_ros.library.diagnosing import diagnose as diagnosis_of

    with progress() as show:
        show(Step("recordings"))
        return diagnosis_of(
            recordings,
            model=nominal,
            simulation=simulation or None,
            progress=lambda what: show(Step(what)),
            jobs=jobs,
            budget=budget,
            force=force,
        )
