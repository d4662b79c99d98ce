"""`pierburg experiment` without the graph: sequences, recordings, designs and refusals."""

import numpy as np
import pytest

from pierburg_ros.cli.app import main
from pierburg_ros.control import read_duty_file, read_setpoint_file
from pierburg_ros.recording import read_recording


def run(*arguments):
    with pytest.raises(SystemExit) as ending:
        main([str(argument) for argument in arguments])
    return ending.value.code


def test_a_duty_recipe_writes_its_sequence_and_recording(tmp_path):
    assert run("experiment", "steps", "--output", tmp_path, "--duration", 12) == 0
    schedule = read_duty_file(tmp_path / "duty.csv")
    recording = read_recording(tmp_path / "steps.mcap")
    assert schedule.time[-1] == pytest.approx(12.0)
    assert recording.duration == pytest.approx(12.0)
    assert recording.command.at(np.array([7.0]))[0] == pytest.approx(schedule.at(7.0), abs=1e-6)


def test_the_same_seed_gives_the_same_recording(tmp_path):
    for folder in ("one", "two"):
        options = ("--duration", 5, "--seed", 3)
        assert run("experiment", "random_steps", "--output", tmp_path / folder, *options) == 0
    one, two = (read_recording(tmp_path / folder / "random_steps.mcap") for folder in ("one", "two"))
    assert np.array_equal(one.measured, two.measured)


def test_a_setpoint_recipe_closes_the_loop(tmp_path):
    assert run("experiment", "square", "--output", tmp_path, "--duration", 6) == 0
    schedule = read_setpoint_file(tmp_path / "setpoints.csv")
    assert schedule.at(3.0) == pytest.approx(np.radians(60.0), abs=1e-5)
    recording = read_recording(tmp_path / "square.mcap")
    settled = 0.42 + 4.1 * 60.0 / 90.0
    assert recording.measured[recording.time > 3.5][:100].mean() == pytest.approx(settled, abs=0.1)


def test_a_design_is_explained_and_recorded_only_with_a_model(tmp_path, capsys):
    options = ("--duration", 5, "--rate", 100)
    command = ("experiment", "--discriminate", "input_delay", "sensor_lag", "--output", tmp_path)
    assert run(*command, *options) == 0
    assert "noise of 0.003 V" in capsys.readouterr().out
    names = {path.name for path in tmp_path.iterdir()}
    assert names == {"duty.csv", "explanation.txt", "prediction.png"}


@pytest.mark.parametrize(
    ("arguments", "reason"),
    [
        (("stairs", "--output", "x"), "There is no recipe stairs; expected one of staircase"),
        (("rich",), "expected both"),
        (("--discriminate", "wear", "nominal", "--output", "x"), "wear is neither an effect nor a model"),
        (("--discriminate", "nominal", "nominal", "--output", "x"), "found nominal and nominal, the same model."),
        (("--discriminate", "nominal", "n.yaml", "--output", "x"), "found nominal and n.yaml, the same model."),
        (("steps", "--discriminate", "a", "b", "--output", "x"), "Found recipe steps with --discriminate"),
        (("square", "--actuator", "xl330", "--output", "x"), "Recipe square needs the controller"),
    ],
)
def test_refusals_are_one_line_and_leave_nothing(arguments, reason, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "n.yaml").write_text("actuator: pierburg\n")
    assert run("experiment", *arguments) == 2
    error = capsys.readouterr().err
    assert reason in error
    assert error.count("\n") == 1
    assert not (tmp_path / "x").exists()
