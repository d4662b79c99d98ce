"""The examples of the help, run as they stand where that takes seconds; the others are parsed in test_common.py."""

import json
import shlex
import shutil
from pathlib import Path

import numpy as np
import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.cli import app
from pierburg_ros.identification.experiment.synthetic import synthetic_recording
from pierburg_ros.plant import Model
from pierburg_ros.recording import write_simulated

QUICK = ("simulate", "replay", "inspect", "export", "recover")
ALSO = ("pierburg actuator check pierburg", "pierburg identify --audit", "pierburg experiment rich -o bench")
EXAMPLES = [*(each for name in QUICK for each in app.COMMANDS[name].examples), *ALSO]


@pytest.fixture(scope="module")
def files(tmp_path_factory) -> Path:
    """What the examples take for granted."""
    folder = tmp_path_factory.mktemp("examples")
    time = np.arange(1500) / 250.0
    duty = np.repeat([0.0, 0.2, 0.28, 0.15, 0.3], 300)
    made = synthetic_recording(Model.nominal(read_actuator("pierburg")), time, duty, 0.003, 0)
    write_simulated(folder / "run.mcap", made.time, made.command, made.measured, quantity=made.quantity)
    (folder / "duty.csv").write_text("time,duty\n0,0\n0.5,0.2\n2,0.2\n")
    (folder / "setpoints.csv").write_text("time,setpoint\n0,0\n0.5,0.6\n2,0.6\n")
    for name in ("model.yaml", "m.yaml"):
        (folder / name).write_text("actuator: pierburg\neffects: {sensor_lag: {time_constant: 0.009}}\n")
    return folder


def test_those_beside_the_quick_commands_are_examples_too():
    assert set(ALSO) <= {each for command in app.COMMANDS.values() for each in command.examples}


@pytest.mark.parametrize("example", EXAMPLES)
def test_an_example_runs_in_a_narrow_terminal(example, files, tmp_path, monkeypatch, capsys):
    shutil.copytree(files, tmp_path / "run")
    monkeypatch.chdir(tmp_path / "run")
    monkeypatch.setenv("COLUMNS", "60")
    arguments = shlex.split(example.partition(" > ")[0])[1:]
    with pytest.raises(SystemExit) as ended:
        app.main(arguments)
    said = capsys.readouterr()
    assert ended.value.code == 0, said.err
    assert said.out and "…" not in said.out and "\x1b" not in said.out
    if "--json" in arguments:
        json.loads(said.out)
