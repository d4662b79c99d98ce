"""`pierburg identify`: parameters from recordings, and the audit of the paper's Table I."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from pierburg_ros.actuators import read_actuator
from pierburg_ros.cli.models import ActuatorOption, ModelOption
from pierburg_ros.cli.output import output_folder
from pierburg_ros.cli.recordings import TimeOption, TopicOption, losses_first, taken_up, topics_of
from pierburg_ros.comparison.compare import Comparison
from pierburg_ros.comparison.plot import write_picture
from pierburg_ros.errors import InputError
from pierburg_ros.estimation.start import from_standstill
from pierburg_ros.identification.identify import Identification
from pierburg_ros.identification.identify import identify as identify_recordings
from pierburg_ros.identification.paper.table_one import audit as audit_checks
from pierburg_ros.identification.plot import write_page, write_static
from pierburg_ros.identification.table import (
    audit_lines,
    lump_table,
    paper_table,
    parameter_table,
    reasons,
)
from pierburg_ros.plant import Model
from pierburg_ros.recording import Recording, read_recording


def identify(
    recordings: Annotated[list[Path] | None, typer.Argument(help="MCAP, rosbag2 directories or CSV.")] = None,
    output: Annotated[Path | None, typer.Option(help="Folder for the results.")] = None,
    actuator: ActuatorOption = None,
    model: ModelOption = None,
    free: Annotated[
        list[str] | None, typer.Option(help="Fit this parameter too, e.g. supply_voltage. Repeatable.")
    ] = None,
    fix: Annotated[list[str] | None, typer.Option(help="Hold this parameter. Repeatable.")] = None,
    audit: Annotated[bool, typer.Option("--audit", help="Check Table I against itself.")] = False,
    topic: TopicOption = None,
    time: TimeOption = None,
) -> None:
    """Identify an actuator from recordings: static characteristic, step response, fit of all samples.

    Writes identification.json, model.yaml, identification.html and PNGs to the output folder.
    """
    console = Console()
    if audit:
        print_audit(console)
        if not recordings:
            return
    if not recordings or output is None:
        raise InputError(
            "identify found no recording or no --output, expected both, or --audit. Write pierburg identify"
            " run.mcap --output DIR."
        )
    start = starting_model(model, actuator)
    read = (read_recording(path, time=time, topics=topics_of(topic)) for path in recordings)
    measured = [from_standstill(recording, start) for recording in read]
    with output_folder(output) as folder:
        with Console(stderr=True).status("fitting whole recordings"):
            found = identify_recordings(start, measured, free or (), fix or ())
        write_results(folder, found, measured)
    losses_first(console, measured)
    for recording in measured:
        if late := taken_up(recording):
            console.print(f"{recording.name}{late}", highlight=False, soft_wrap=True)
    print_results(console, found, output)


def starting_model(model: Path | None, actuator: str | None) -> Model:
    """The model file given, or the nominal actuator; the Pierburg valve where neither is named."""
    described = read_actuator(actuator) if actuator is not None else None
    if model is not None:
        return Model.read(model, described)
    return Model.nominal(described or read_actuator("pierburg"))


def print_audit(console: Console) -> None:
    """Print what Table I implies about itself."""
    lines = audit_lines(audit_checks(Model.nominal(read_actuator("pierburg"))))
    console.print("\n".join(lines), highlight=False, soft_wrap=True)


def write_results(folder: Path, found: Identification, measured: list[Recording]) -> None:
    """Write the results into `folder` in every form."""
    text = json.dumps(found.as_mapping(), indent=1, allow_nan=False)
    (folder / "identification.json").write_text(text + "\n", encoding="utf-8")
    found.fitted.model.write(folder / "model.yaml")
    write_page(folder / "identification.html", found, measured)
    first = measured[0]
    simulated = first.measured - found.fitted.residuals[0]
    write_picture(folder / "fit.png", Comparison(first, found.fitted.model, simulated))
    if found.static is not None:
        write_static(folder / "static_characteristic.png", found.static, found.model.actuator.upper_stop)


def print_results(console: Console, found: Identification, output: Path) -> None:
    """Print the tables and the quality of the fit."""
    for table in (lump_table(found), parameter_table(found), paper_table(found)):
        if table is not None:
            console.print(table)
    console.print("\n".join(reasons(found)), highlight=False, soft_wrap=True)
    unit = found.model.actuator.unit
    console.print(
        f"RMSE {found.fitted.rmse:.4g} {unit} on all data, {found.validation_rmse:.4g} {unit} on unseen data;"
        f" measurement noise {found.noise:.2g} {unit}.",
        soft_wrap=True,
    )
    if not found.fitted.uncertainty.white:
        console.print(
            "The residual is not white: the model lacks something, and the intervals are only as honest as "
            f"{found.fitted.uncertainty.blocks} stretches of it allow. Try pierburg diagnose.",
            soft_wrap=True,
        )
    console.print(f"Results in {output}: identification.json, .html, model.yaml, PNGs")
