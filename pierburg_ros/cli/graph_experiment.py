"""An experiment over the ROS graph: the excitation node plays a file while the recorder writes."""

from __future__ import annotations

import subprocess
import tempfile
import time
from collections.abc import Mapping
from pathlib import Path

from pierburg_ros.errors import InputError
from pierburg_ros.processes import end, running, start_node

START_TIMEOUT = 60.0
"""Time [s] within which the recorder must have opened its file."""
DISCOVERY = 1.0
"""Time [s] that the recorder gets to find the topics that exist already."""


def play(
    kind: str, file: Path, recording: Path, simulated_time: bool, environment: Mapping[str, str] | None = None
) -> None:
    """Play `file` (`kind` duty or setpoint) to the graph and record it; InputError where no plant answers.

    `environment` names the graph by its variables; without it, the one that this process is on.
    """
    graph = environment or {}
    common = {"use_sim_time": simulated_time}
    recorder = {"recorder": {**common, "output": recording}}
    with tempfile.TemporaryDirectory() as folder, running(recorder, Path(folder) / "log", graph) as processes:
        wait_for(recording, processes[0])
        excitation = start_node("excitation", {**common, f"{kind}_file": file}, subprocess.PIPE, graph)
        try:
            problem, _ = excitation.communicate()
        finally:
            end(excitation)
        if excitation.returncode:
            raise InputError(last_line(problem.decode()) or "The excitation node ended early. Is a plant running?")


def wait_for(recording: Path, recorder: subprocess.Popen[bytes]) -> None:
    """Return when the recorder writes; InputError where it does not start."""
    deadline = time.monotonic() + START_TIMEOUT
    while not recording.exists():
        if recorder.poll() is not None or time.monotonic() > deadline:
            raise InputError("The recorder did not start. Try 'pierburg run recorder' to see why.")
        time.sleep(0.1)
    time.sleep(DISCOVERY)


def last_line(text: str) -> str:
    """The last line that is not a log line of ROS."""
    lines = [line for line in text.splitlines() if line.strip() and not line.startswith("[")]
    return lines[-1] if lines else ""
