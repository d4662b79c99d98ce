"""Units that a table states, behind the names of its columns or in a row below."""

import math

import numpy as np
import pytest
from support.tables import refusal, table

from pierburg_ros.recording import read_recording
from pierburg_ros.recording.formats.headings import Heading, is_units


@pytest.mark.parametrize(
    ("cell", "bare", "unit"),
    [
        ("hall [mV]", "hall", "mV"),
        ("t (ms)", "t", "ms"),
        ("Drehzahl[1/min]", "Drehzahl", "rpm"),
        ("duty [%]", "duty", "percent"),
        ("time (sec)", "time", "s"),
        ("position[elbow]", "position[elbow]", ""),
        ("data[1]", "data[1]", ""),
        ("duty [-]", "duty [-]", ""),
        ("[V]", "[V]", ""),
        ("angle", "angle", ""),
    ],
)
def test_a_heading_states_a_unit_where_there_is_one_behind_its_name(cell, bare, unit):
    found = Heading.of(f" {cell} ")
    assert (found.written, found.bare, found.unit) == (cell, bare, unit)


@pytest.mark.parametrize(
    ("row", "states"),
    [
        ("s,V,rad", True),
        ("[ms],-,[deg]", True),
        ("s,1,V", True),
        ("s,,", True),
        ("s,furlong,V", True),
        ("0,1,2", False),
        ("s,0.5,V", False),
        ("true,V,s", False),
        ("2026-03-01 12:00:00,V,s", False),
        (",,", False),
        ("-,-,-", False),
        ("on,off,on", False),
    ],
)
def test_a_row_of_units_has_a_unit_and_no_value(row, states):
    assert is_units(row.split(",")) is states


@pytest.mark.parametrize(
    "text",
    [
        "time,duty,position\nms,%,deg\n0,50,90\n10,0,180\n",
        "time;duty;position\n[ms];[%];[°]\n0,0;50;90,0\n10,0;0;180\n",
        "time [ms],duty [%],position (deg)\n0,50,90\n10,0,180\n",
        "# bench 3\n# time,duty,position\nmsec,percent,deg\n0,50,90\n10,0,180\n",
        "time [ms],duty,position\nms,%,deg\n0,50,90\n10,0,180\n",
    ],
)
def test_what_the_table_states_counts(tmp_path, text):
    recording = read_recording(table(tmp_path, text))
    np.testing.assert_allclose(recording.time, [0.0, 0.01])
    np.testing.assert_allclose(recording.command.values, [0.5, 0.0])
    np.testing.assert_allclose(recording.measured, [math.pi / 2, math.pi])


def test_a_map_with_a_unit_or_scale_counts_for_itself_and_one_with_a_name_does_not(tmp_path):
    path = table(tmp_path, "t [s],pwm [%],angle\n0,50,1\n1,0,2\n")
    named = {"time": {"column": "t [s]"}, "position": {"column": "angle"}}
    maps = [{**named, "duty": {"column": "pwm [%]", **each}} for each in ({}, {"scale": 0.02})]
    duties = [read_recording(path, signals=each).command.values for each in maps]
    np.testing.assert_allclose(duties, [[0.5, 0.0], [1.0, 0.0]])
    short = {"time": "t", "duty": "pwm", "position": "angle"}
    np.testing.assert_allclose(read_recording(path, topics=short).command.values, [0.5, 0.0])


def test_parts_may_state_different_units(tmp_path):
    (tmp_path / "a.csv").write_text("time [s],duty,position [rad]\n0,0,0\n1,0,1\n")
    (tmp_path / "b.csv").write_text("time [ms],duty,position [deg]\n2000,0,180\n3000,0,0\n")
    parts = ["a.csv", "b.csv"]
    signals = {name: {"column": name, "file": parts} for name in ("duty", "position")}
    recording = read_recording(tmp_path, signals=signals)
    np.testing.assert_allclose(recording.time, [0.0, 1.0, 2.0, 3.0])
    np.testing.assert_allclose(recording.measured, [0.0, 1.0, math.pi, 0.0])


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "time,duty,position\ns,1,furlong\n0,0,0\n1,0,0\n",
            "run.csv has 'furlong' as the unit of position in row 2, no known unit, expected one such"
            " as V, rad or ms, or"
            " an empty cell. Repair it, or give the unit in a signal map.",
        ),
        (
            "time,duty,position [rad]\ns,1,deg\n0,0,0\n1,0,0\n",
            "run.csv has 'deg' as the unit of position in row 2, after 'rad' in the header, expected"
            " one such as V, rad or"
            " ms, or an empty cell. Repair it, or give the unit in a signal map.",
        ),
        (
            "time,duty,position\ns,1,V\n0,0,0\n1,0,0\n",
            "run.csv has position in V, expected a unit of rad or m. Correct its head, or give the"
            " unit in a signal map.",
        ),
        (
            "time,duty,hall_voltage\ns,1,counts\n0,0,0\n1,0,0\n",
            "run.csv has hall_voltage in counts, expected how much one is. Write it into a signal map,"
            " as hall_voltage:"
            " {column: hall_voltage, unit: counts, scale: 0.001}.",
        ),
        (
            "time,duty,hall_voltage\nV,1,V\n0,0,0\n1,0,0\n",
            "run.csv has time in V, expected a unit of s. Correct its head, or give the unit in a signal map.",
        ),
        (
            "time,duty,hall_voltage\ns,1,V\nfloat,float,float\n0,0,0\n",
            "run.csv has 'float' as time in row 3, expected a finite number, or a stamp as"
            " 2026-03-01T12:00:00.5Z in every"
            " row. Repair it.",
        ),
        ("time,duty,hall_voltage\ns,1,V\n", "run.csv holds no samples, only a header. Record again."),
    ],
)
def test_what_is_half_broken_is_named(tmp_path, text, message):
    assert refusal(table(tmp_path, text)) == message


def test_an_unknown_unit_of_a_column_that_is_not_read_does_no_harm(tmp_path):
    path = table(tmp_path, "time,duty,position,pressure\ns,1,rad,furlong\n0,0,0,1\n1,0,1,1\n")
    assert read_recording(path).measured.tolist() == [0.0, 1.0]
