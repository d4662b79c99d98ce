"""--signals on the commands that read recordings: the same result from other units, and one line for a bad map."""

import json

import numpy as np
import pytest

from pierburg_ros.cli.app import main

TIME = 0.002 * np.arange(500)
HALL = 0.42 + np.random.default_rng(1).normal(0.0, 0.003, TIME.size)
MAP = """time: {column: t, unit: us}
duty: {column: throttle, unit: percent, sign: -1}
hall_voltage: {column: sensor, unit: mV, offset: 0.4}
"""


def call(*arguments):
    """Exit status of a command."""
    with pytest.raises(SystemExit) as end:
        main([str(each) for each in arguments])
    return end.value.code


@pytest.fixture
def bench(tmp_path):
    """A valve that nothing drives, as a table of its own form."""
    columns = np.column_stack([1e6 * TIME, np.full(TIME.size, 2.0), 1000.0 * (HALL - 0.4)])
    path = tmp_path / "bench.csv"
    np.savetxt(path, columns, fmt="%.9f", delimiter=";", header="t;throttle;sensor", comments="")
    (tmp_path / "signals.yaml").write_text(MAP)
    return path


def test_a_replay_by_a_map_is_that_of_the_plain_recording(bench, tmp_path):
    plain = tmp_path / "plain.csv"
    columns = np.column_stack([TIME, np.full(TIME.size, -0.02), HALL])
    np.savetxt(plain, columns, fmt="%.12f", delimiter=",", header="time,duty,hall_voltage", comments="")
    signals = ("--signals", tmp_path / "signals.yaml")
    assert call("replay", plain, "--actuator", "pierburg", "--output", tmp_path / "a") == 0
    assert call("replay", bench, "--actuator", "pierburg", "--output", tmp_path / "b", *signals) == 0
    first, second = (json.loads((tmp_path / name / "replay.json").read_text()) for name in "ab")
    assert second["rmse"] == pytest.approx(first["rmse"], rel=1e-9)
    assert second["noise"] == pytest.approx(first["noise"], rel=1e-6)


@pytest.mark.parametrize("command", ["replay", "identify", "diagnose"])
@pytest.mark.parametrize(
    ("entry", "said"),
    [
        ("duty: {column: throtle}", "signals.yaml line 1: duty: bench.csv has no column throtle"),
        ("dutty: {column: throttle}", "signals.yaml line 1: dutty is no signal, expected one of duty"),
        ("duty: {column: throttle, unit: kg}", "signals.yaml line 1: duty found the unit 'kg', expected one of 1"),
    ],
)
def test_a_bad_map_is_one_line_and_leaves_nothing(bench, tmp_path, capsys, monkeypatch, command, entry, said):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "signals.yaml").write_text(entry + "\n")
    options = ("--actuator", "pierburg", "--output", "out", "--signals", "signals.yaml")
    assert call(command, bench, *options) == 2
    error = capsys.readouterr().err
    assert said in error and error.count("\n") == 1
    assert not (tmp_path / "out").exists()


def test_inspect_writes_a_map_once_and_reads_by_it(bench, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert call("inspect", bench, "--write-signals", "drafted.yaml") == 0
    assert "a signal map of these guesses" in capsys.readouterr().out
    assert 'duty: {column: "throttle", unit: percent}' in (tmp_path / "drafted.yaml").read_text()
    assert call("inspect", bench, "--write-signals", "drafted.yaml") == 2
    assert "drafted.yaml exists, expected a new name" in capsys.readouterr().err
    assert call("inspect", bench, "--signals", "signals.yaml", "--json") == 0
    found = json.loads(capsys.readouterr().out)
    assert found["problem"] is None and found["read_as"]["quantity"] == "hall_voltage"
    assert {topic["name"]: topic["read_as"] for topic in found["topics"]} == {
        "t": "time",
        "throttle": "duty",
        "sensor": "hall_voltage",
    }


def test_inspect_of_what_is_no_recording_says_what_to_do_next(bench, capsys):
    assert call("inspect", bench) == 0
    shown = capsys.readouterr().out
    assert "Not read as a recording: bench.csv has no time column" in shown
    assert f"pierburg inspect {bench} --write-signals signals.yaml" in shown
