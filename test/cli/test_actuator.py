"""`pierburg actuator`: describes from answers and from recordings, never overwrites unasked, checks descriptions."""

import io
from pathlib import Path

import numpy as np
import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.cli import app
from pierburg_ros.identification.experiment.synthetic import synthetic_recording
from pierburg_ros.plant import Model
from pierburg_ros.recording import write_simulated

ANSWERS = "lift\nvoltage\nnone\nposition\nlinear\n0 0.3\n1.2\nbench\n0.02\nsheet\n30\n\n5\n\n2\n\n24\n\n"


def ended(*arguments):
    with pytest.raises(SystemExit) as ending:
        app.main(["actuator", *map(str, arguments)])
    return ending.value.code


def test_asks_and_writes_what_can_be_read(tmp_path, monkeypatch):
    monkeypatch.setattr("sys.stdin", io.StringIO(ANSWERS))
    assert ended("new", tmp_path / "lift.yaml") == 0
    described = read_actuator(str(tmp_path / "lift.yaml"))
    assert (described.motion, described.load, described.upper_stop) == ("linear", "none", 0.3)
    assert described.parameters["armature_resistance"].origin == "bench"
    assert described.parameters["gear_ratio"].origin == "guess"
    assert "# kg, " in (tmp_path / "lift.yaml").read_text()


@pytest.mark.parametrize(
    ("answers", "said"),
    [
        ("", "Found no answer to 'Name of the actuator'"),
        ("lift\nsteam\n", "drive: found 'steam', expected one of voltage"),
        ("lift\nvoltage\nnone\nposition\nlinear\n0.3 0\n", "stops: found '0.3 0', expected the lower stop first"),
        ("lift\nvoltage\nnone\nposition\nlinear\n\n1.2 ohm\n", "found '1.2 ohm', expected a number alone"),
        ("lift\nvoltage\nnone\nposition\nlinear\n\n0\n", "armature_resistance: found '0', expected a number above 0"),
    ],
)
def test_what_cannot_be_used_is_one_line_and_leaves_nothing(tmp_path, monkeypatch, capsys, answers, said):
    monkeypatch.setattr("sys.stdin", io.StringIO(answers))
    assert ended("new", tmp_path / "lift.yaml") == 2
    assert said in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_a_person_is_asked_again(tmp_path, monkeypatch, capsys):
    wrong = ANSWERS.replace("voltage\n", "steam\nvoltage\n").replace("0 0.3\n", "0.3 0\n0 0.3\n")
    terminal = io.StringIO(wrong)
    terminal.isatty = lambda: True
    monkeypatch.setattr("sys.stdin", terminal)
    assert ended("new", tmp_path / "lift.yaml") == 0
    said = capsys.readouterr().err
    assert "found 'steam'" in said and "found '0.3 0'" in said
    assert read_actuator(str(tmp_path / "lift.yaml")).upper_stop == 0.3


def test_never_overwrites_unless_told(tmp_path, monkeypatch, capsys):
    file = tmp_path / "lift.yaml"
    file.write_text("mine")
    assert ended("new", file) == 2
    assert file.read_text() == "mine" and "is there already" in capsys.readouterr().err
    monkeypatch.setattr("sys.stdin", io.StringIO(ANSWERS))
    assert ended("new", file, "--overwrite") == 0
    assert file.read_text() != "mine"


def test_starts_from_a_recording_and_marks_what_it_guessed(tmp_path, capsys):
    model = Model.nominal(read_actuator("pierburg")).with_values({"armature_resistance": 5.0})
    time = np.arange(6000) / 500.0
    duty = np.repeat(np.random.default_rng(3).uniform(-0.1, 0.45, 30), 200)
    made = synthetic_recording(model, time, duty)
    write_simulated(tmp_path / "bench.mcap", time, duty, made.measured)
    assert ended("new", tmp_path / "mine.yaml", "--from-recording", tmp_path / "bench.mcap", "--jobs", 1) == 0
    assert "Started from pierburg, which is loaded by a spring and with stops." in capsys.readouterr().out
    found = read_actuator(str(tmp_path / "mine.yaml")).parameters
    assert found["armature_resistance"].nominal == pytest.approx(5.0, rel=0.01)
    assert found["armature_resistance"].origin.startswith("identified from bench.mcap")
    assert found["supply_voltage"].origin == "guess: that of pierburg; bench.mcap does not tell it"


def test_check_shows_what_follows_what_is_wrong_and_what_is_tied(tmp_path, capsys):
    shipped = (Path(app.__file__).parent.parent / "actuators/pierburg.yaml").read_text(encoding="utf-8")
    wrong = shipped.replace(
        "nominal: 0.022, minimum: 0.001, maximum: 1.0", "nominal: 22.0, minimum: 0.001, maximum: 99.0"
    )
    (tmp_path / "slip.yaml").write_text(wrong)
    assert ended("check", tmp_path / "slip.yaml") == 0
    out = capsys.readouterr().out
    assert "torque_constant: 22 N.m/A: with 0.022 all is plausible" in out
    assert ended("check", "xl330") == 0
    out = capsys.readouterr().out
    assert "Nothing is implausible." in out and "gear_ratio: tied: +1 % of it looks like torque_constant +1.00 %" in out
