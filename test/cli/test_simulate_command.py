"""`pierburg simulate` from the command line: open and closed loop to MCAP, refusals that leave nothing."""

import math

import numpy as np
import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.cli.app import main
from pierburg_ros.plant import Inputs, Model, simulate
from pierburg_ros.recording import Channel, read_recording, write_simulated


def run(*arguments) -> int:
    with pytest.raises(SystemExit) as ended:
        main(["simulate", *map(str, arguments)])
    return ended.value.code


@pytest.fixture
def setpoints(tmp_path):
    path = tmp_path / "setpoints.csv"
    path.write_text("time,setpoint\n0,0\n0.5,0.785\n1.5,0.2\n")
    return path


@pytest.fixture
def duty(tmp_path):
    path = tmp_path / "duty.csv"
    path.write_text("time,duty\n0,0\n0.2,0.24\n1.0,-0.1\n")
    return path


def test_open_loop_is_the_plant_under_that_duty(duty, tmp_path):
    assert run("--actuator", "pierburg", "--duty", duty, "--output", tmp_path / "out") == 0
    recording = read_recording(tmp_path / "out/simulated.mcap")
    assert recording.time.size == 1501 and recording.duration == pytest.approx(3.0)
    inputs = Inputs(np.array([0.0, 0.2, 1.0]), np.array([0.0, 0.24, -0.1]))
    expected = simulate(Model.nominal(read_actuator("pierburg")), inputs, recording.time)
    np.testing.assert_allclose(recording.measured, expected, atol=1e-9)


def test_closed_loop_reaches_its_setpoints(setpoints, tmp_path, capsys):
    output = tmp_path / "out"
    assert run("--actuator", "pierburg", "--setpoints", setpoints, "--output", output) == 0
    assert "3.50 s simulated in" in capsys.readouterr().out
    recording = read_recording(output / "simulated.mcap")
    np.testing.assert_array_equal(recording.setpoints.values, [0.0, 0.785, 0.2])
    for time, setpoint in ((1.4, 0.785), (3.4, 0.2)):
        hall_voltage = 0.42 + 4.1 * setpoint / (math.pi / 2)
        assert np.interp(time, recording.time, recording.measured) == pytest.approx(hall_voltage, abs=0.015)


def test_the_duty_of_a_closed_loop_replays_its_measurement(setpoints, tmp_path):
    run("--actuator", "pierburg", "--setpoints", setpoints, "--output", tmp_path / "closed")
    run("--actuator", "pierburg", "--duty", tmp_path / "closed/simulated.mcap", "--output", tmp_path / "open")
    closed, again = (read_recording(tmp_path / name / "simulated.mcap") for name in ("closed", "open"))
    np.testing.assert_allclose(again.measured, closed.measured, atol=1e-6)


def test_one_seed_gives_one_file(setpoints, tmp_path):
    files = []
    for name, seed in (("a", 3), ("b", 3), ("c", 4)):
        arguments = ("--setpoints", setpoints, "--noise", 0.003, "--seed", seed, "--output", tmp_path / name)
        run("--actuator", "pierburg", *arguments)
        files.append((tmp_path / name / "simulated.mcap").read_bytes())
    assert files[0] == files[1] != files[2]


def test_noise_has_the_strength_asked_for(duty, tmp_path):
    for name, noise in (("quiet", 0.0), ("noisy", 0.02)):
        run("--actuator", "pierburg", "--duty", duty, "--noise", noise, "--output", tmp_path / name)
    quiet, noisy = (read_recording(tmp_path / name / "simulated.mcap") for name in ("quiet", "noisy"))
    assert np.std(noisy.measured - quiet.measured) == pytest.approx(0.02, rel=0.1)


def test_a_converter_comes_after_the_noise(duty, tmp_path):
    model = Model.nominal(read_actuator("pierburg")).with_values({"sensor_quantization.step": 0.05})
    model.write(tmp_path / "model.yaml")
    run("--model", tmp_path / "model.yaml", "--duty", duty, "--noise", 0.02, "--output", tmp_path / "out")
    steps = read_recording(tmp_path / "out/simulated.mcap").measured / 0.05
    np.testing.assert_allclose(steps, np.round(steps), atol=1e-9)


def test_a_recording_keeps_its_sample_times_and_supply(tmp_path):
    time = np.cumsum(np.tile([0.002, 0.003], 200))
    write_simulated(tmp_path / "in.mcap", time, Channel(np.array([0.0]), np.array([0.2])), 0.42 + 0 * time)
    run("--actuator", "pierburg", "--duty", tmp_path / "in.mcap", "--output", tmp_path / "out")
    result = read_recording(tmp_path / "out/simulated.mcap")
    np.testing.assert_allclose(result.time, time - time[0], atol=1e-8)


def test_rate_and_duration_can_be_chosen(setpoints, tmp_path):
    options = ("--rate", 250, "--duration", 1.2, "--output", tmp_path / "out")
    run("--actuator", "pierburg", "--setpoints", setpoints, *options)
    recording = read_recording(tmp_path / "out/simulated.mcap")
    assert recording.time.size == 301
    np.testing.assert_array_equal(recording.setpoints.values, [0.0, 0.785])


def test_a_parameter_file_sets_the_controller(setpoints, tmp_path):
    off = tmp_path / "controller.yaml"
    off.write_text("controller: {ros__parameters: {duty_maximum: 0.0}}")
    options = ("--controller", off, "--output", tmp_path / "out")
    run("--actuator", "pierburg", "--setpoints", setpoints, *options)
    assert np.all(read_recording(tmp_path / "out/simulated.mcap").command.values <= 0.0)


@pytest.mark.parametrize(
    ("options", "reason"),
    [
        ((), "either --duty (open loop) or --setpoints"),
        (("--duty", "duty.csv", "--setpoints", "setpoints.csv"), "either --duty (open loop) or --setpoints"),
        (("--duty", "duty.csv", "--controller", "c.yaml"), "runs without a controller"),
        (("--duty", "setpoints.csv"), "does not begin with the header time,duty"),
        (("--setpoints", "duty.csv"), "does not begin with the header time,setpoint"),
        (("--setpoints", "none.csv"), "none.csv does not exist"),
        (("--duty", "none.mcap"), "none.mcap does not exist"),
        (("--setpoints", "setpoints.csv", "--noise", "-1"), "--noise"),
        (("--setpoints", "setpoints.csv", "--actuator", "xl330"), "the controller needs hall_voltage"),
    ],
)
def test_bad_input_is_one_line_and_leaves_nothing(options, reason, duty, setpoints, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    actuator = () if "--actuator" in options else ("--actuator", "pierburg")
    assert run(*options, *actuator, "--output", "out") == 2
    error = capsys.readouterr().err
    assert reason in error and error.count("\n") == 1
    assert sorted(path.name for path in tmp_path.iterdir()) == ["duty.csv", "setpoints.csv"]


def test_simulates_the_valve_where_no_actuator_is_named(duty, tmp_path):
    for name, actuator in (("unnamed", ()), ("named", ("--actuator", "pierburg"))):
        assert run("--duty", duty, *actuator, "--output", tmp_path / name) == 0
    unnamed, named = (read_recording(tmp_path / name / "simulated.mcap") for name in ("unnamed", "named"))
    np.testing.assert_array_equal(unnamed.measured, named.measured)


def test_an_output_that_cannot_be_written_is_refused_before_the_work(capsys):
    assert run("--duty", "none.mcap", "--output", "/proc/x") == 2
    assert capsys.readouterr().err.endswith("/proc/x cannot be written, since /proc cannot. Choose another place.\n")
