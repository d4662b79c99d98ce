"""`pierburg simulate`: the open or the closed loop to MCAP, without a ROS graph."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Annotated

import typer

from pierburg_ros.cli.console.terminal import terminal
from pierburg_ros.cli.options.models import ActuatorOption, ModelOption, chosen_model
from pierburg_ros.errors import InputError
from pierburg_ros.library.output import output_folder


def simulate(
    output: Annotated[Path, typer.Option(help="Folder for the result, simulated.mcap.")],
    model: ModelOption = None,
    actuator: ActuatorOption = None,
    duty: Annotated[
        Path | None, typer.Option(help="Open loop: CSV with time,duty, or a recording whose duty to apply.")
    ] = None,
    setpoints: Annotated[Path | None, typer.Option(help="Closed loop: CSV with time,setpoint.")] = None,
    controller: Annotated[Path | None, typer.Option(help="Parameter file of the controller.")] = None,
    duration: Annotated[
        float | None, typer.Option(min=0.01, max=1e5, help="Length in s; by default 2 s past the last row.")
    ] = None,
    rate: Annotated[float | None, typer.Option(min=10, max=1e5, help="Samples a second; by default 500.")] = None,
    noise: Annotated[float, typer.Option(min=0.0, max=10.0, help="Sensor noise, RMS in the measured unit.")] = 0.0,
    seed: Annotated[int, typer.Option(min=0, help="Seed of the noise.")] = 0,
    initial_angle: Annotated[float, typer.Option(help="Shaft angle at the start, in rad.")] = 0.0,
) -> dict[str, object]:
    """Simulate an actuator, driven by a duty or by the controller, to MCAP."""
    if (duty is None) == (setpoints is None):
        raise InputError("Expected either --duty (open loop) or --setpoints (closed loop). Give one of them.")
    if duty is not None and controller is not None:
        raise InputError("Found --controller with --duty, which runs without a controller. Leave one out.")
    from pierburg_ros.library import simulation

    chosen = chosen_model(model, actuator)
    with output_folder(output) as folder:
        began = time.perf_counter()
        made = simulation.simulate(
            chosen,
            duty=duty,
            setpoints=setpoints,
            controller=controller,
            duration=duration,
            rate=rate,
            noise=noise,
            seed=seed,
            initial_angle=initial_angle,
        )
        took = time.perf_counter() - began
        made.write_into(folder)
    file = output / simulation.FILE
    terminal().print(f"{made.time[-1]:.2f} s simulated in {took:.3f} s, written to {file}", soft_wrap=True)
    return {"file": str(file), "duration": float(made.time[-1]), "samples": made.time.size}
