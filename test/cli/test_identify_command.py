"""`pierburg identify` from the command line: results, audit, and refusals that leave nothing behind."""

import json

import numpy as np
import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.cli.app import main
from pierburg_ros.identification.experiment.excitation import duty_sequence
from pierburg_ros.identification.experiment.synthetic import synthetic_recording
from pierburg_ros.plant import Model, read_model
from pierburg_ros.recording.write import write_simulated


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    model = Model.nominal(read_actuator("pierburg"))
    time = np.arange(10_000) / 500.0
    made = synthetic_recording(model, time, duty_sequence("rich", model, time), seed=7)
    path = tmp_path_factory.mktemp("recorded") / "run.mcap"
    write_simulated(path, made.time, made.command, made.measured)
    return path


def run(*arguments):
    with pytest.raises(SystemExit) as ending:
        main([str(argument) for argument in arguments])
    return ending.value.code


def test_identify_writes_every_result(recorded, tmp_path, capsys):
    output = tmp_path / "found"
    assert run("identify", recorded, "--output", output) == 0
    content = json.loads((output / "identification.json").read_text())
    assert content["lumps"]["gain"]["value"] == pytest.approx(18.862, rel=0.01)
    assert read_model(output / "model.yaml").values["coulomb_friction"] == pytest.approx(0.2007, rel=0.01)
    names = {path.name for path in output.iterdir()}
    assert {"identification.html", "fit.png", "static_characteristic.png"} <= names
    shown = capsys.readouterr().out
    assert "total_inertia: leaves no trace" in shown
    assert "supply_voltage: tied" in shown


def test_a_freed_parameter_is_fitted(recorded, tmp_path):
    output = tmp_path / "found"
    options = ("--free", "supply_voltage", "--fix", "torque_constant")
    assert run("identify", recorded, "--output", output, *options) == 0
    parameters = json.loads((output / "identification.json").read_text())["parameters"]
    assert not parameters["supply_voltage"]["fixed"]
    assert parameters["torque_constant"]["fixed"]


def test_the_audit_needs_no_recording(capsys):
    assert run("identify", "--audit") == 0
    shown = capsys.readouterr().out
    assert "1.3972 rad/V" in shown
    assert "12.375 V < V < 14.997 V" in shown


def test_nothing_to_identify_is_one_line_and_status_2(tmp_path, capsys):
    assert run("identify", "--output", tmp_path / "found") == 2
    assert capsys.readouterr().err.count("\n") == 1
    assert not (tmp_path / "found").exists()


def test_a_still_recording_leaves_nothing_behind(tmp_path, capsys):
    time = np.arange(1000) / 500.0
    still = 0.42 + 0.003 * np.random.default_rng(0).standard_normal(time.size)
    write_simulated(tmp_path / "still.mcap", time, np.zeros(time.size), still)
    assert run("identify", tmp_path / "still.mcap", "--output", tmp_path / "found") == 2
    assert "still.mcap shows no motion" in capsys.readouterr().err
    assert not (tmp_path / "found").exists()
