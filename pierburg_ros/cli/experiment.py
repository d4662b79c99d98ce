"""`pierburg experiment`: excitation recipes, and the sequence that best separates two explanations."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import numpy as np
import typer
from rich.console import Console

from pierburg_ros.arrays import Signal
from pierburg_ros.cli.console.progress import Step, progress
from pierburg_ros.cli.console.terminal import terminal
from pierburg_ros.cli.graph_experiment import play
from pierburg_ros.cli.options.models import ActuatorOption, ModelOption, chosen_model
from pierburg_ros.cli.run import require_ros
from pierburg_ros.closed_loop import simulate_loop
from pierburg_ros.control import Schedule, Settings
from pierburg_ros.errors import InputError
from pierburg_ros.identification.experiment.discriminate import discriminate as design_sequence
from pierburg_ros.identification.experiment.discriminate_report import words, write_picture
from pierburg_ros.identification.experiment.excitation import (
    DUTY_RECIPES,
    duty_sequence,
    purpose,
    setpoint_sequence,
    usual_duration,
)
from pierburg_ros.identification.experiment.explanations import explanation
from pierburg_ros.identification.experiment.synthetic import synthetic_recording
from pierburg_ros.intake import check_count
from pierburg_ros.library.output import output_folder
from pierburg_ros.plant import Model
from pierburg_ros.recording import Channel
from pierburg_ros.recording.write import write_simulated


@dataclass(frozen=True)
class Sequence:
    """What is played: `kind` duty or setpoint, its name, and its value at each `time` [s]."""

    kind: str
    name: str
    time: Signal
    values: Signal

    @property
    def changes(self) -> Channel:
        """The sequence as its changes."""
        keep = np.concatenate([[True], np.diff(self.values) != 0.0])
        return Channel(self.time[keep], self.values[keep])


def experiment(
    name: Annotated[str | None, typer.Argument(help="Recipe; a wrong name lists them.")] = None,
    output: Annotated[Path | None, typer.Option(help="Folder for the sequence and its recording.")] = None,
    discriminate: Annotated[
        tuple[str, str] | None,
        typer.Option(help="Design the sequence that best separates two explanations: effects, model files, nominal."),
    ] = None,
    model: ModelOption = None,
    actuator: ActuatorOption = None,
    duration: Annotated[float | None, typer.Option(min=5.0, max=3600.0, help="Length [s].")] = None,
    rate: Annotated[float, typer.Option(min=20.0, max=5000.0, help="Samples a second.")] = 500.0,
    seed: Annotated[int, typer.Option(min=0, help="Seed of random levels and of the noise.")] = 0,
    noise: Annotated[float, typer.Option(min=0.0, max=1.0, help="Sensor noise, RMS.")] = 0.003,
    limit: Annotated[float, typer.Option(min=0.01, max=1.0, help="Largest duty.")] = 1.0,
    graph: Annotated[bool, typer.Option("--graph", help="Play it to a plant on the ROS graph, and record.")] = False,
    simulated_time: Annotated[bool, typer.Option("--simulated-time", help="The graph runs on /clock.")] = False,
) -> dict[str, object]:
    """Record an excitation recipe, of the simulated actuator or over the ROS graph.

    Writes duty.csv or setpoints.csv and the recording. With --discriminate it designs the duty sequence and explains
    it. It then records only if asked: over the graph with --graph, simulated with --model.
    """
    if name is not None and discriminate is not None:
        raise InputError(f"Found recipe {name} with --discriminate, which designs a sequence. Leave one of them out.")
    if (name is None and discriminate is None) or output is None:
        raise InputError(
            "experiment found not both a recipe (or --discriminate A B) and --output, expected both. Write"
            " pierburg experiment rich --output DIR."
        )
    if graph:
        require_ros()
    base, console = chosen_model(model, actuator), terminal()
    check_count(duration or usual_duration(name or "", base), rate, "An experiment")
    with output_folder(output) as folder:
        if discriminate is not None:
            chosen = designed(folder, console, base, discriminate, duration or 60.0, rate, noise, limit)
        else:
            chosen = recipe(str(name), base, duration, rate, seed, limit)
        file = write_sequence(folder, chosen)
        recording = folder / f"{chosen.name}.mcap"
        if graph:
            with progress() as show:
                show(Step(f"playing {chosen.name}, {chosen.time[-1]:.0f} s"))
                play(chosen.kind, file, recording, simulated_time)
        elif discriminate is None or model is not None:
            simulate_sequence(recording, base, chosen, rate, noise, seed)
    made = [path.name for path in (file, recording) if (output / path.name).exists()]
    console.print(f"{chosen.name}, {chosen.time[-1]:.0f} s, in {output}: {', '.join(made)}", soft_wrap=True)
    return {"name": chosen.name, "duration": float(chosen.time[-1]), "files": [str(output / each) for each in made]}


def recipe(name: str, base: Model, duration: float | None, rate: float, seed: int, limit: float) -> Sequence:
    """The sequence of recipe `name`."""
    purpose(name)
    length = duration or usual_duration(name, base)
    time = np.arange(round(length * rate) + 1) / rate
    if name in DUTY_RECIPES:
        return Sequence("duty", name, time, np.clip(duty_sequence(name, base, time, seed), -limit, limit))
    if base.actuator.quantity != "hall_voltage":
        raise InputError(
            f"Recipe {name} needs the controller, which needs a Hall voltage, and {base.actuator.name} gives"
            f" its angle. Choose one of {', '.join(DUTY_RECIPES)}."
        )
    return Sequence("setpoint", name, time, setpoint_sequence(name, time, seed))


def designed(
    folder: Path,
    console: Console,
    base: Model,
    names: tuple[str, str],
    duration: float,
    rate: float,
    noise: float,
    limit: float,
) -> Sequence:
    """The sequence that best separates the explanations `names`, explained in words and a picture."""
    first, second = (explanation(name, base) for name in names)
    if first.as_mapping() == second.as_mapping():
        raise InputError(f"--discriminate found {names[0]} and {names[1]}, the same model. Name two that differ.")
    with progress() as show:
        design = design_sequence(
            first, second, duration, rate, noise or 1e-6, limit, lambda what: show(Step("designing", what=what))
        )
    labels = (Path(names[0]).stem, Path(names[1]).stem)
    text = words(design, labels, base.actuator.unit, noise)
    (folder / "explanation.txt").write_text(text + "\n", encoding="utf-8")
    write_picture(folder / "prediction.png", design, labels, base.actuator.quantity)
    console.print(text, soft_wrap=True)
    return Sequence("duty", "discriminate", design.time, design.duty)


def write_sequence(folder: Path, sequence: Sequence) -> Path:
    """Write the changes of the sequence, and its end, to duty.csv or setpoints.csv."""
    changes = sequence.changes
    path = folder / ("duty.csv" if sequence.kind == "duty" else "setpoints.csv")
    rows = [*zip(changes.time, changes.values, strict=True)]
    if changes.time[-1] < sequence.time[-1]:
        rows.append((sequence.time[-1], sequence.values[-1]))
    np.savetxt(path, rows, fmt="%.6g", delimiter=",", header=f"time,{sequence.kind}", comments="")
    return path


def simulate_sequence(path: Path, model: Model, sequence: Sequence, rate: float, noise: float, seed: int) -> None:
    """Write the recording that a bench with the actuator of `model` would make."""
    if sequence.kind == "duty":
        made = synthetic_recording(model, sequence.time, sequence.values, noise, seed)
        write_simulated(path, made.time, made.command, made.measured, quantity=made.quantity)
        return
    changes = sequence.changes
    schedule = Schedule(changes.time, changes.values)
    run = simulate_loop(model, Settings(), schedule, sequence.time[-1], rate, noise, seed)
    write_simulated(path, run.time, run.duty, run.hall_voltage, setpoints=changes)
