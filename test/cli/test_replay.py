"""`pierburg replay` from the command line: the contract's files, and refusals that leave nothing."""

import csv
import json
from importlib import resources
from pathlib import Path

import numpy as np
import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.cli.app import main
from pierburg_ros.library import model as library
from pierburg_ros.plant import Inputs, Model, simulate
from pierburg_ros.recording import read_recording, write_recording, write_simulated

XL330 = Path(__file__).parents[2] / "../shared/data/xl330"


@pytest.fixture
def at_rest(tmp_path):
    """A recording of a valve that nothing drives, with a trace of noise."""
    time = 0.002 * np.arange(1000)
    noise = np.random.default_rng(1).normal(0.0, 0.003, time.size)
    path = tmp_path / "rest.mcap"
    write_simulated(path, time, np.zeros(time.size), 0.42 + noise)
    return path


def replay(*arguments) -> int:
    with pytest.raises(SystemExit) as ended:
        main(["replay", *map(str, arguments)])
    return ended.value.code


def test_writes_what_the_contract_names(at_rest, tmp_path, capsys):
    output = tmp_path / "out"
    assert replay(at_rest, "--actuator", "pierburg", "--output", output) == 0
    assert {path.name for path in output.iterdir()} == {
        "replay.json",
        "replay.csv",
        "replay.mcap",
        "replay.html",
        "replay.png",
        "model.yaml",
    }
    result = json.loads((output / "replay.json").read_text())
    assert result["unit"] == "V" and result["samples"] == 1000
    assert result["rmse"] == pytest.approx(0.003, rel=0.1) and result["noise"] == pytest.approx(0.003, rel=0.1)
    with (output / "replay.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert list(rows[0]) == ["time", "duty", "measured", "simulated", "residual"] and len(rows) == 1000
    assert float(rows[7]["residual"]) == pytest.approx(float(rows[7]["measured"]) - 0.42, abs=1e-8)
    assert "RMSE" in capsys.readouterr().out


def test_a_recording_that_begins_in_motion_is_simulated_from_its_first_sample(tmp_path):
    """A shaft that opens at 35 mV a millisecond when the recording begins, and the valve's own answer from there."""
    time = 0.002 * np.arange(3000)
    model = Model.nominal(read_actuator("pierburg"))
    clean = simulate(model, Inputs(np.zeros(1), np.full(1, 0.3)), 0.05 + time)
    write_simulated(tmp_path / "moving.mcap", time, np.full(time.size, 0.3), clean)
    assert replay(tmp_path / "moving.mcap", "--actuator", "pierburg", "--output", tmp_path / "out") == 0
    rows = np.loadtxt(tmp_path / "out" / "replay.csv", delimiter=",", skiprows=1)
    assert rows.shape[0] == time.size and rows[0, 0] == 0.0
    assert json.loads((tmp_path / "out" / "replay.json").read_text())["rmse"] < 0.003


def test_its_mcap_can_be_replayed_again(at_rest, tmp_path):
    replay(at_rest, "--actuator", "pierburg", "--output", tmp_path / "once")
    named = {"hall_voltage": "/replay/measured", "duty": "/replay/command"}
    again = read_recording(tmp_path / "once" / "replay.mcap", topics=named)
    np.testing.assert_array_equal(again.measured, read_recording(at_rest).measured)
    options = [word for signal, topic in named.items() for word in ("--topic", f"{signal}={topic}")]
    written = tmp_path / "once" / "replay.mcap"
    assert replay(written, "--actuator", "pierburg", *options, "--output", tmp_path / "twice") == 0
    once, twice = (json.loads((tmp_path / name / "replay.json").read_text())["rmse"] for name in ("once", "twice"))
    assert once == twice


def test_rerun_that_is_not_installed_is_said_before_any_work(at_rest, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr("pierburg_ros.viewers.rerun_overlay.find_spec", lambda _: None)
    output, file = tmp_path / "out", tmp_path / "run.rrd"
    assert replay(at_rest, "--actuator", "pierburg", "--output", output, "--rerun", file) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1 and "pip install 'pierburg_ros[rerun]'" in said
    assert not output.exists() and not file.exists()


def test_the_page_needs_no_network(at_rest, tmp_path):
    replay(at_rest, "--actuator", "pierburg", "--output", tmp_path / "out")
    page = (tmp_path / "out" / "replay.html").read_text()
    assert "<script src=" not in page and "rest.mcap and pierburg" in page
    assert (tmp_path / "out" / "replay.png").read_bytes().startswith(b"\x89PNG")


def test_a_model_file_is_taken(at_rest, tmp_path):
    model = tmp_path / "model.yaml"
    model.write_text("actuator: pierburg\nparameters: {hall_voltage_closed: 0.43}\n")
    assert replay(at_rest, "--model", model, "--output", tmp_path / "out") == 0
    result = json.loads((tmp_path / "out" / "replay.json").read_text())
    assert result["model"]["parameters"] == {"hall_voltage_closed": 0.43}
    assert result["rmse"] == pytest.approx(np.hypot(0.003, 0.01), rel=0.05)


def test_signals_are_named_by_option(at_rest, tmp_path):
    recording = read_recording(at_rest)
    path = tmp_path / "bench.mcap"
    duty, hall = (recording.command.time, recording.command.values), (recording.time, recording.measured)
    write_recording(path, {"/pwm": ("std_msgs/msg/Float64", *duty), "/angle": ("std_msgs/msg/Float64", *hall)})
    named = ("--topic", "duty=/pwm", "--topic", "hall_voltage=/angle", "--time", "log")
    assert replay(path, "--actuator", "pierburg", "--output", tmp_path / "out", *named) == 0
    assert json.loads((tmp_path / "out" / "replay.json").read_text())["time_source"] == "log"


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (["absent.mcap", "--actuator", "pierburg"], "absent.mcap does not exist, expected a recording."),
        (["rest.mcap", "--actuator", "toaster"], "toaster"),
        (["rest.mcap", "--model", "odd.yaml"], "armature_resistence"),
        (["rest.mcap", "--actuator", "xl330"], "rest.mcap holds a Hall voltage"),
        (
            ["rest.mcap", "--model", "right.yaml", "--actuator", "xl330"],
            "right.yaml is a model of pierburg and --actuator found xl330, expected a description of pierburg.",
        ),
        (
            ["rest.mcap", "--actuator", "pierburg", "--topic", "pwm"],
            "--topic found 'pwm', expected SIGNAL=NAME.",
        ),
        (
            ["rest.mcap", "--actuator", "pierburg", "--time", "noon"],
            "--time found 'noon', expected one of stamp",
        ),
    ],
)
def test_bad_input_is_one_line_and_leaves_nothing(at_rest, tmp_path, capsys, monkeypatch, arguments, line):
    monkeypatch.chdir(tmp_path)
    Path("odd.yaml").write_text("actuator: pierburg\nparameters: {armature_resistence: 4.1}\n")
    Path("right.yaml").write_text("actuator: pierburg\n")
    assert replay(*arguments, "--output", "out") == 2
    said = capsys.readouterr()
    assert said.out == "" and said.err.count("\n") == 1 and said.err.startswith("pierburg: ") and line in said.err
    assert {path.name for path in tmp_path.iterdir()} == {"rest.mcap", "odd.yaml", "right.yaml"}


def test_a_model_file_takes_its_actuator_described_anew(at_rest, tmp_path):
    description = resources.files("pierburg_ros.actuators") / "pierburg.yaml"
    (tmp_path / "mine.yaml").write_text(description.read_text().replace("nominal: 4.139", "nominal: 3.8"))
    (tmp_path / "model.yaml").write_text("actuator: pierburg\nparameters: {supply_voltage: 12.0}\n")
    options = ("--model", tmp_path / "model.yaml", "--actuator", tmp_path / "mine.yaml", "--output", tmp_path / "out")
    assert replay(at_rest, *options) == 0
    found = library.Model.read(tmp_path / "out/model.yaml").values
    assert (found["armature_resistance"], found["supply_voltage"]) == (3.8, 12.0)


@pytest.mark.skipif(not XL330.exists(), reason="the measured XL330 runs are not beside this checkout")
def test_a_measured_run_is_replayed(tmp_path):
    run = XL330 / "kp400_sin_sin.mcap"
    assert replay(run, "--actuator", "xl330", "--output", tmp_path / "out") == 0
    result = json.loads((tmp_path / "out" / "replay.json").read_text())
    assert result["unit"] == "rad" and 0.01 < result["rmse"] < 10.0
    assert 0.0 <= result["worst_stretch"]["share_of_residual_energy"] <= 1.0
