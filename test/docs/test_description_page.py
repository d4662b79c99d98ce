"""docs/description.md: its commands run, and it quotes what they say."""

import io
import re
from pathlib import Path

import numpy as np
import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.cli import app
from pierburg_ros.identification.experiment.synthetic import synthetic_recording
from pierburg_ros.plant import Model
from pierburg_ros.recording import write_simulated

PAGE = (Path(__file__).parents[2] / "docs" / "description.md").read_text(encoding="utf-8")
COMMANDS = re.findall(r"^\$ pierburg (.*)$", PAGE, flags=re.MULTILINE)
ANSWERS = "rig\ncurrent\nnone\nspeed\nrotary\n\n0.05\nsheet\n1\n\n0.01\n\n1e-4\n\n"


def test_the_commands_run_one_after_another(tmp_path, monkeypatch, capsys):
    valve = Model.nominal(read_actuator("pierburg"))
    time = np.arange(5000) / 500.0
    duty = np.repeat(np.random.default_rng(3).uniform(-0.1, 0.45, 25), 200)
    write_simulated(tmp_path / "bench.mcap", time, duty, synthetic_recording(valve, time, duty).measured)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("sys.stdin", io.StringIO(ANSWERS))
    for number, command in enumerate(COMMANDS):
        with pytest.raises(SystemExit) as ending:
            app.main(command.split())
        assert ending.value.code == 0, capsys.readouterr().err
        if number == 0:
            Path("my_actuator.yaml").unlink()
    out = capsys.readouterr().out
    for line in re.findall(r"^(?:gear_ratio|supply_voltage|total_inertia): .*$", PAGE, flags=re.MULTILINE):
        assert line in out
    assert "identified from bench.mcap, +-" in Path("my_actuator.yaml").read_text()
