"""`pr.read` with a signal map: as a path, as a mapping, and in the units of the actuator's motion."""

from dataclasses import replace

import numpy as np
import pytest

import pierburg_ros as pr
from pierburg_ros.actuators import read_actuator

SIGNALS = {"duty": {"column": "pwm", "unit": "percent"}, "position": {"column": "x", "unit": "mm"}}


@pytest.fixture
def table(tmp_path):
    """Two samples of an axis."""
    path = tmp_path / "run.csv"
    path.write_text("time,pwm,x\n0,10,0\n0.1,20,30\n")
    return path


def test_a_map_may_be_a_path_or_a_mapping(table, tmp_path):
    (tmp_path / "signals.yaml").write_text("duty: {column: pwm, unit: percent}\nposition: {column: x, unit: mm}\n")
    for signals in (SIGNALS, tmp_path / "signals.yaml", str(tmp_path / "signals.yaml")):
        recording = pr.read(table, signals=signals)
        np.testing.assert_allclose(recording.measured, [0.0, 0.03])
        np.testing.assert_allclose(recording.command.values, [0.1, 0.2])


def test_a_length_is_refused_for_a_rotary_actuator_and_an_angle_for_a_linear_one(table):
    rotary = read_actuator("xl330")
    linear = replace(rotary, motion="linear")
    assert pr.read(table, signals=SIGNALS, actuator=linear).measured[-1] == pytest.approx(0.03)
    with pytest.raises(
        pr.InputError, match="signals: position is in a unit of m, expected one of rad: xl330 is rotary"
    ):
        pr.read(table, signals=SIGNALS, actuator=rotary)
    angle = {**SIGNALS, "position": {"column": "x", "unit": "deg"}}
    assert pr.read(table, signals=angle, actuator=rotary).measured[-1] == pytest.approx(np.pi / 6)
    with pytest.raises(pr.InputError, match="signals: position is in a unit of rad, expected one of m"):
        pr.read(table, signals=angle, actuator=linear)


@pytest.mark.parametrize("function", [pr.diagnose, pr.identify])
def test_a_recording_given_twice_is_refused(function, tmp_path):
    for name in ("a.csv", "b.csv"):
        (tmp_path / name).write_text("time,duty,hall_voltage\n0,0,1\n1,0.1,1\n2,0,1.1\n")
    for first, second in ("aa", "ab"):
        with pytest.raises(pr.InputError, match=f"{first}.csv and {second}.csv are the same recording, expected diff"):
            function([tmp_path / f"{first}.csv", tmp_path / f"{second}.csv"])


@pytest.mark.parametrize("samples", [2, 5])
def test_a_recording_of_a_few_samples_is_too_short_and_lacks_none(samples, tmp_path):
    rows = "".join(f"{k},0.1,{1 + k}\n" for k in range(samples))
    (tmp_path / "few.csv").write_text(f"time,duty,hall_voltage\n{rows}")
    for use in (lambda path: pr.compare(path, pr.Model.nominal()), pr.identify):
        with pytest.raises(pr.InputError, match=rf"few.csv is too short \({samples} samples\), expected at least"):
            use(tmp_path / "few.csv")
