"""`pierburg diagnose`: locate the mismatch, name the missing physics, model it, show the fit improve."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

from pierburg_ros.cli.models import ActuatorOption, ModelOption, chosen_model
from pierburg_ros.cli.output import output_folder
from pierburg_ros.cli.recordings import TimeOption, TopicOption, topics_of
from pierburg_ros.cli.terminal import terminal
from pierburg_ros.diagnosis.diagnose import diagnose as diagnosis_of
from pierburg_ros.diagnosis.report.page import write_page, write_picture
from pierburg_ros.diagnosis.report.terminal import shown
from pierburg_ros.diagnosis.result import Result
from pierburg_ros.plant import Model
from pierburg_ros.recording import Recording, read_recording


def diagnose(
    recordings: Annotated[list[Path], typer.Argument(help="MCAP, rosbag2 directories or CSV, of one actuator.")],
    output: Annotated[Path, typer.Option(help="Folder for the results.")],
    actuator: ActuatorOption = None,
    model: ModelOption = None,
    topic: TopicOption = None,
    time: TimeOption = None,
) -> None:
    """Say what the simulation lacks: where, which physics, how sure, and what to record next.

    Writes diagnosis.json, model.yaml, report.html and overview.png to the output folder.
    """
    nominal = chosen_model(model, actuator if actuator or model else "pierburg")
    measured = [read_recording(path, time=time, topics=topics_of(topic)) for path in recordings]
    with output_folder(output) as folder:
        result = diagnosed_with_progress(measured, nominal)
        write_diagnosis(folder, result)
    terminal().print(
        shown(result.diagnosis), f"Results in {output}: report.html, diagnosis.json, model.yaml, overview.png"
    )


def diagnosed_with_progress(recordings: Sequence[Recording], nominal: Model) -> Result:
    """The diagnosis of what `nominal` lacks, with a bar on stderr that names what is being tried."""
    with _progress() as bar:
        task = bar.add_task("reading", total=None)
        return diagnosis_of(recordings, nominal, lambda tried: bar.update(task, advance=1, description=tried))


def write_diagnosis(folder: Path, result: Result) -> None:
    """The files of a diagnosis in `folder`."""
    result.diagnosis.write(folder / "diagnosis.json")
    result.model.write(folder / "model.yaml")
    write_page(folder / "report.html", result)
    write_picture(folder / "overview.png", result)


def _progress() -> Progress:
    """A bar on stderr that names what is being tried."""
    columns = (
        BarColumn(pulse_style="cyan"),
        TimeElapsedColumn(),
        TextColumn("{task.completed} tried; {task.description}"),
    )
    return Progress(*columns, console=terminal(stderr=True), transient=True)
