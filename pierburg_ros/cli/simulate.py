"""`pierburg simulate`: the open or the closed loop to MCAP, without a ROS graph."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import numpy as np
import typer
from numpy.typing import NDArray

from pierburg_ros.cli.models import ActuatorOption, ModelOption, chosen_model
from pierburg_ros.cli.output import output_folder
from pierburg_ros.cli.terminal import terminal
from pierburg_ros.closed_loop import simulate_loop
from pierburg_ros.closed_loop.open_loop import simulate_measurement
from pierburg_ros.control import Settings, read_duty_file, read_parameter_file, read_setpoint_file
from pierburg_ros.errors import InputError
from pierburg_ros.estimation.resimulation import inputs_of
from pierburg_ros.intake import check_count
from pierburg_ros.intake.table import LONGEST_LINE
from pierburg_ros.plant import Inputs, Model
from pierburg_ros.recording import Channel, Recording, read_recording, write_recording
from pierburg_ros.recording.write import Signal

FLOAT64 = "std_msgs/msg/Float64"
TYPES = {"/joint_states": "sensor_msgs/msg/JointState", "/enabled": "std_msgs/msg/Bool"}
FILE = "simulated.mcap"
RATE = 500.0  # where neither an option nor a recording says [Hz]
AFTER_LAST = 2.0  # how long the last row of a duty or setpoint file holds, unless an option says [s]


@dataclass(frozen=True)
class Sampling:
    """When and how the sensor is read, and where the shaft starts."""

    duration: float | None  # [s], None: as long as the input
    rate: float | None  # [Hz], None: 500, or as a recording was sampled
    noise: float  # RMS, in the measured unit
    seed: int
    initial_angle: float  # [rad]

    def times(self, last: float) -> NDArray[np.float64]:
        """Sample times [s], evenly spaced, by default until `last`."""
        rate, duration = self.rate or RATE, self.duration or last
        check_count(duration, rate, "A simulation")
        return np.arange(round(duration * rate) + 1) / rate

    def times_like(self, recording: Recording) -> NDArray[np.float64]:
        """Sample times [s] of `recording`, unless a rate or a duration beyond its end is wanted."""
        longer = self.duration is not None and self.duration > recording.duration
        if self.rate is not None or longer:
            return self.times(recording.duration)
        return recording.time[recording.time <= (self.duration or recording.duration)]


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
) -> None:
    """Simulate an actuator, driven by a duty or by the controller, to MCAP."""
    if (duty is None) == (setpoints is None):
        raise InputError("Expected either --duty (open loop) or --setpoints (closed loop). Give one of them.")
    if duty is not None and controller is not None:
        raise InputError("Found --controller with --duty, which runs without a controller. Leave one out.")
    chosen = chosen_model(model, actuator)
    sampling = Sampling(duration, rate, noise, seed, initial_angle)
    began = time.perf_counter()
    if duty is not None:
        signals = open_loop(chosen, duty, sampling)
    else:
        assert setpoints is not None
        settings = read_parameter_file(controller) if controller else Settings()
        signals = closed_loop(chosen, settings, setpoints, sampling)
    took = time.perf_counter() - began
    with output_folder(output) as folder:
        write_recording(folder / FILE, signals)
    last = max(float(np.asarray(when)[-1]) for _, when, _ in signals.values())
    terminal().print(f"{last:.2f} s simulated in {took:.3f} s, written to {output / FILE}")


def closed_loop(model: Model, settings: Settings, setpoints: Path, sampling: Sampling) -> dict[str, Signal]:
    """Topics of a run under the controller."""
    schedule = read_setpoint_file(setpoints)
    duration = sampling.duration or float(schedule.time[-1]) + AFTER_LAST
    rate = sampling.rate or RATE
    check_count(duration, rate, "A simulation")
    run = simulate_loop(
        model, settings, schedule, duration, rate, sampling.noise, sampling.seed, sampling.initial_angle
    )
    topics = {
        "/setpoints": Channel(schedule.time, schedule.values),
        "/hall_voltage": Channel(run.time, run.hall_voltage),
        "/duty": Channel(run.time, run.duty),
    }
    return as_signals(topics, duration)


def open_loop(model: Model, duty: Path, sampling: Sampling) -> dict[str, Signal]:
    """Topics of a run that a duty drives: one written down, or one recorded."""
    topics: dict[str, Channel | None]
    if is_duty_file(duty):
        schedule = read_duty_file(duty)
        inputs = Inputs(schedule.time, schedule.values)
        times = sampling.times(float(schedule.time[-1]) + AFTER_LAST)
        topics = {"/duty": Channel(schedule.time, schedule.values)}
    else:
        recording = read_recording(duty)
        inputs = inputs_of(recording)
        times = sampling.times_like(recording)
        supply, enabled = recording.supply_voltage, recording.enabled
        topics = {"/supply_voltage": supply, "/enabled": enabled, "/duty": recording.duty}
    measured = simulate_measurement(model, inputs, times, sampling.noise, sampling.seed, sampling.initial_angle)
    topics["/joint_states" if model.actuator.quantity == "position" else "/hall_voltage"] = Channel(times, measured)
    return as_signals(topics, float(times[-1]))


def is_duty_file(path: Path) -> bool:
    """Whether `path` is a CSV of time and duty alone, not of a recording."""
    if path.suffix.lower() != ".csv" or not path.is_file():
        return False
    with path.open(encoding="utf-8", errors="replace") as file:
        header = file.readline(LONGEST_LINE)
    return not any(measured in header for measured in ("hall_voltage", "position"))


def as_signals(topics: Mapping[str, Channel | None], last: float) -> dict[str, Signal]:
    """The topics that exist, with their message types, up to the time `last` [s]."""
    signals: dict[str, Signal] = {}
    for topic, channel in topics.items():
        if channel is not None:
            within = channel.time <= last + 1e-9
            kind = TYPES.get(topic, FLOAT64)
            signals[topic] = (kind, channel.time[within], channel.values[within])
    return signals
