"""`pierburg replay`: simulate a recorded duty and compare with what was measured."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import numpy as np
import typer
from rich.console import Console
from rich.table import Table

from pierburg_ros.cli.models import ActuatorOption, ModelOption, chosen_model
from pierburg_ros.cli.output import output_folder
from pierburg_ros.cli.recordings import TimeOption, TopicOption, losses_first, taken_up, topics_of
from pierburg_ros.comparison.compare import Comparison, compare
from pierburg_ros.comparison.plot import write_page, write_picture
from pierburg_ros.recording import read_recording, write_recording
from pierburg_ros.recording.write import Signal

FLOAT64 = "std_msgs/msg/Float64"


def replay(
    recording: Annotated[Path, typer.Argument(help="MCAP, rosbag2 directory or CSV.")],
    output: Annotated[Path, typer.Option(help="Folder for the results.")],
    model: ModelOption = None,
    actuator: ActuatorOption = None,
    topic: TopicOption = None,
    time: TimeOption = None,
) -> None:
    """Simulate a recorded duty and compare with what was measured.

    Writes replay.json, replay.csv, replay.mcap, replay.html and replay.png to the output folder.
    """
    chosen = chosen_model(model, actuator)
    measured = read_recording(recording, time=time, topics=topics_of(topic))
    with output_folder(output) as folder:
        comparison = compare(chosen, measured)
        write_replay(folder, comparison)
    console = Console()
    losses_first(console, [measured])
    console.print(summary(comparison), f"Results in {output}: replay.html, .png, .json, .csv, .mcap")


def write_replay(folder: Path, comparison: Comparison) -> None:
    """Write the results of `comparison` into `folder` in every form."""
    (folder / "replay.json").write_text(json.dumps(comparison.as_mapping(), indent=1, allow_nan=False) + "\n")
    write_table(folder / "replay.csv", comparison)
    write_recording(folder / "replay.mcap", signals(comparison))
    write_page(folder / "replay.html", comparison)
    write_picture(folder / "replay.png", comparison)


def write_table(path: Path, comparison: Comparison) -> None:
    """Write replay.csv: one row a sample, the duty in force at it."""
    recording = comparison.recording
    duty = recording.duty.at(recording.time, before=0.0)
    columns = (recording.time, duty, recording.measured, comparison.simulated, comparison.residual)
    header = "time,duty,measured,simulated,residual"
    np.savetxt(path, np.column_stack(columns), fmt="%.9g", delimiter=",", header=header, comments="")


def signals(comparison: Comparison) -> dict[str, Signal]:
    """The topics of replay.mcap: the recording's own, which can be replayed again, and what was simulated."""
    recording, time = comparison.recording, comparison.recording.time
    if recording.quantity == "hall_voltage":
        measured: dict[str, Signal] = {"/hall_voltage": (FLOAT64, time, recording.measured)}
    else:
        measured = {"/joint_states": ("sensor_msgs/msg/JointState", time, recording.measured)}
    channels = {
        "/duty": (FLOAT64, recording.duty),
        "/supply_voltage": (FLOAT64, recording.supply_voltage),
        "/temperature": (FLOAT64, recording.temperature),
        "/enabled": ("std_msgs/msg/Bool", recording.enabled),
        "/setpoints": (FLOAT64, recording.setpoints),
    }
    inputs: dict[str, Signal] = {
        topic: (kind, channel.time, channel.values)
        for topic, (kind, channel) in channels.items()
        if channel is not None
    }
    simulated: dict[str, Signal] = {
        f"/simulated_{recording.quantity}": (FLOAT64, time, comparison.simulated),
        "/residual": (FLOAT64, time, comparison.residual),
    }
    return measured | simulated | inputs


def summary(comparison: Comparison) -> Table:
    """The comparison as a table for the terminal."""
    recording, worst = comparison.recording, comparison.worst
    unit, explained = recording.unit, comparison.variance_explained
    table = Table(title=f"{recording.name} and {comparison.model.actuator.name}", show_header=False)
    table.add_column(style="bold")
    table.add_column()
    effects = ", ".join(comparison.model.active_effects) or "none"
    rows = {
        "measured": f"{recording.quantity.replace('_', ' ')} in {unit}, {recording.time.size} samples"
        f" over {recording.duration:.1f} s (times: {recording.time_source}){taken_up(recording)}",
        "effects in the model": effects,
        "RMSE": f"{comparison.rmse:.4g} {unit}",
        "noise of the measurement": f"{comparison.noise:.2g} {unit}",
        "variance explained": "nothing moved" if explained is None else f"{100 * explained:.3f} %",
        "worst stretch": f"{worst.start:.2f} to {worst.end:.2f} s: RMSE {worst.rmse:.4g} {unit},"
        f" {100 * worst.share:.0f} % of the residual's energy",
    }
    for name, value in rows.items():
        table.add_row(name, value)
    return table
