"""Records a trial over the real ROS graph: plant, controller and recorder as three processes over DDS.

The plant node moves the textbook valve, in simulated time and lockstep at the pace of the clock: run freely
it outpaces the recorder. The parameter values with which a recording usually begins are left out: they would
tell what is hidden. Nothing here imports ROS.
"""

from __future__ import annotations

import csv
import subprocess
import time
from pathlib import Path

import numpy as np

from pierburg_ros.actuators import read_actuator
from pierburg_ros.arrays import Signal
from pierburg_ros.errors import InputError
from pierburg_ros.plant import Model
from pierburg_ros.processes import own_graph, running
from pierburg_ros.proof.bench import Recorded, sampled
from pierburg_ros.proof.excitation import setpoint_sequence
from pierburg_ros.proof.formulation import simulate_textbook
from pierburg_ros.proof.trial import Trial
from pierburg_ros.recording import read_recording

GRAPH_PATIENCE = 600.0  # s of wall time, after which a recording over the graph is given up
POLL = 1.0  # s
ATTEMPTS = 3


class NotRecorded(InputError):
    """The graph did not record a trial, which says nothing about the diagnosis."""


def record_over_graph(trial: Trial, path: Path, holdout: bool = False) -> Recorded:
    """Record the trial to the MCAP file `path` and give it back with the noise-free voltage beside it.

    A loaded machine may lose messages; a recording with a gap is made again.
    """
    for _ in range(ATTEMPTS):
        attempt(trial, path, holdout)
        run = read_back(trial, path)
        if np.diff(run.time).max() < 1.5 / trial.rate:
            return run
    raise NotRecorded(f"{trial.name} lost messages {ATTEMPTS} times. Let fewer trials run at a time.")


def attempt(trial: Trial, path: Path, holdout: bool) -> None:
    """Start the graph, and end it when the recording is long enough."""
    duration = trial.holdout_duration if holdout else trial.duration
    path.parent.mkdir(parents=True, exist_ok=True)
    path.unlink(missing_ok=True)
    model, setpoints = path.with_suffix(".yaml"), path.with_suffix(".csv")
    Model.nominal(read_actuator("pierburg")).with_values(trial.values).write(model)
    write_setpoints(setpoints, trial, duration, holdout)
    with running(settings(trial, path, model, setpoints, holdout), path.with_suffix(".log"), own_graph()) as nodes:
        wait_for(path, duration, nodes)
    model.unlink()
    setpoints.unlink()
    path.with_suffix(".log").unlink()


def settings(trial: Trial, path: Path, model: Path, setpoints: Path, holdout: bool) -> dict[str, dict[str, object]]:
    """ROS parameters of the three nodes."""
    plant: dict[str, object] = {
        "model": model,
        "formulation": "textbook",
        "rate": trial.rate,
        "lockstep": True,
        "simulated_time": True,
        "time_factor": 1.0,
        "hall_voltage_noise": trial.noise,
        "seed": (trial.seed + holdout) % 2**31,
    }
    controller = {"use_sim_time": True, "setpoint_file": setpoints, **trial.controller}
    recorder = {
        "use_sim_time": True,
        "output": path,
        "topics": ["hall_voltage", "applied_duty", "joint_states"],
        "parameters_of": ["nobody"],
    }
    return {"recorder": recorder, "controller": controller, "plant": plant}


def write_setpoints(path: Path, trial: Trial, duration: float, holdout: bool) -> None:
    """Write the setpoints [rad] where they change, as the controller's file: within the stops, else it refuses them."""
    time_points = sampled(duration, trial.rate)
    random = np.random.default_rng([trial.seed, int(holdout)])
    actuator = read_actuator("pierburg")
    values = np.clip(setpoint_sequence(time_points, random, holdout), actuator.lower_stop, actuator.upper_stop)
    changes = np.flatnonzero(np.diff(values, prepend=np.nan) != 0.0)
    with path.open("w", newline="") as stream:
        writer = csv.writer(stream)
        writer.writerow(["time", "setpoint"])
        writer.writerows(zip(time_points[changes].tolist(), values[changes].tolist(), strict=True))


def wait_for(path: Path, duration: float, nodes: list[subprocess.Popen[bytes]]) -> None:
    """Wait until the growing recording covers `duration` [s], which takes at least that long."""
    begun = time.monotonic()
    while time.monotonic() - begun < duration or recorded(path) < duration:
        if any(node.poll() is not None for node in nodes):
            raise NotRecorded(f"a node ended while {path.name} was recorded; see {path.with_suffix('.log')}.")
        if time.monotonic() - begun > GRAPH_PATIENCE:
            raise NotRecorded(f"{path.name} did not reach {duration:g} s within {GRAPH_PATIENCE:g} s of wall time.")
        time.sleep(POLL)


def recorded(path: Path) -> float:
    """Seconds that a growing recording covers so far."""
    try:
        return float(read_recording(path).time[-1])
    except (InputError, FileNotFoundError):
        return 0.0


def read_back(trial: Trial, path: Path) -> Recorded:
    """The recording on its sample times, with what the textbook valve does under the applied duty."""
    recording = read_recording(path)
    duty: Signal = recording.command.at(recording.time, before=0.0)
    ideal = simulate_textbook(trial.values, recording.command.time, recording.command.values, recording.time)
    return Recorded(recording.time, duty, recording.measured, ideal, None)
