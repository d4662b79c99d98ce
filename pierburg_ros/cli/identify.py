"""`pierburg identify`: parameters from recordings, and the audit of the paper's Table I."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console

from pierburg_ros.cli.console.progress import Step, progress
from pierburg_ros.cli.console.terminal import terminal
from pierburg_ros.cli.options.jobs import JobsOption
from pierburg_ros.cli.options.models import ActuatorOption, ModelOption, chosen_model
from pierburg_ros.cli.options.recordings import (
    ResultsOption,
    SignalsOption,
    TimeOption,
    TopicOption,
    faults_first,
    losses_first,
    results_folder,
    topics_of,
)
from pierburg_ros.errors import InputError
from pierburg_ros.library.output import output_folder

if TYPE_CHECKING:
    from pierburg_ros.identification.identify import Identification


def identify(
    recordings: Annotated[list[Path] | None, typer.Argument(help="MCAP, rosbag2 directories or CSV.")] = None,
    output: ResultsOption = None,
    actuator: ActuatorOption = None,
    model: ModelOption = None,
    free: Annotated[
        list[str] | None, typer.Option(help="Fit this parameter too, e.g. supply_voltage. Repeatable.")
    ] = None,
    fix: Annotated[list[str] | None, typer.Option(help="Hold this parameter. Repeatable.")] = None,
    audit: Annotated[bool, typer.Option("--audit", help="Check Table I against itself.")] = False,
    signals: SignalsOption = None,
    topic: TopicOption = None,
    time: TimeOption = None,
    jobs: JobsOption = None,
) -> object:
    """Identify an actuator from recordings: static characteristic, step response, fit of all samples.

    Writes identification.json, model.yaml, identification.html and PNGs to the output folder.
    """
    console = terminal()
    if audit:
        from pierburg_ros.identification.paper.table_one import audit as audit_checks
        from pierburg_ros.identification.table import audit_lines
        from pierburg_ros.library.model import Model

        checks = audit_checks(Model.nominal("pierburg"))
        console.print("\n".join(audit_lines(checks)), soft_wrap=True)
        if not recordings:
            return {"audit": [asdict(check) for check in checks]}
    if not recordings:
        raise InputError("identify found no recording, expected one, or --audit. Write pierburg identify run.mcap.")
    from pierburg_ros.library import identifying
    from pierburg_ros.library.reading import read, taken_up

    start, output = chosen_model(model, actuator), results_folder(output, "identify", recordings[0])
    measured = [
        read(path, time=time, topics=topics_of(topic), signals=signals, actuator=start.actuator) for path in recordings
    ]
    with output_folder(output) as folder:
        with progress() as show:
            show(Step("fitting whole recordings"))
            identified = identifying.identify(measured, model=start, free=free or (), fixed=fix or (), jobs=jobs)
        identified.write_into(folder)
    losses_first(console, measured)
    faults_first(console, measured, start)
    for recording in identified.recordings:
        if late := taken_up(recording):
            console.print(f"{recording.name}{late}", soft_wrap=True)
    print_results(console, identified.found, output)
    return identified.to_json()


def print_results(console: Console, found: Identification, output: Path) -> None:
    """Print the tables and the quality of the fit."""
    from pierburg_ros.identification.table import lump_table, paper_table, parameter_table, reasons

    for table in (lump_table(found), parameter_table(found), paper_table(found)):
        if table is not None:
            console.print(table)
    console.print("\n".join(reasons(found)), soft_wrap=True)
    unit = found.model.actuator.unit
    console.print(
        f"RMSE {found.fitted.rmse:.4g} {unit} on all data, {found.validation_rmse:.4g} {unit} on unseen data;"
        f" measurement noise {found.noise:.2g} {unit}.",
        soft_wrap=True,
    )
    if not found.fitted.covariance.white:
        console.print(
            "The residual is more than noise (not white): the model lacks something, and the intervals may be too "
            "narrow. Try pierburg diagnose.",
            soft_wrap=True,
        )
    console.print(f"Results in {output}: identification.json, .html, model.yaml, PNGs", soft_wrap=True)
