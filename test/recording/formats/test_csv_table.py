"""CSV: a header names the signals, an empty cell leaves one as it was, faults are named by row."""

import numpy as np
import pytest
from support.tables import refusal, table

from pierburg_ros.recording import read_recording

ROWS = """time,duty,hall_voltage,supply_voltage,setpoint,temperature,enabled
5.0,0,0.42,13.4,0.1,20,1
5.1,0.2,0.5,,,,
5.2,0.2,0.7,13.2,0.3,,0
"""


def test_reads_every_column(tmp_path):
    recording = read_recording(table(tmp_path, ROWS))
    assert recording.quantity == "hall_voltage" and recording.time_source == "column"
    np.testing.assert_allclose(recording.time, [0.0, 0.1, 0.2])
    np.testing.assert_array_equal(recording.measured, [0.42, 0.5, 0.7])
    np.testing.assert_array_equal(recording.command.values, [0.0, 0.2, 0.2])
    np.testing.assert_array_equal(recording.supply_voltage.at(recording.time), [13.4, 13.4, 13.2])
    np.testing.assert_array_equal(recording.setpoints.values, [0.1, 0.3])
    np.testing.assert_array_equal(recording.enabled.at(recording.time), [1.0, 1.0, 0.0])
    np.testing.assert_array_equal(recording.temperature.values, [20.0])


def test_reads_position_and_semicolons_and_named_columns(tmp_path):
    path = table(tmp_path, "\ufefft;pwm;position\n0;0.1;0.0\n0.1;0.1;0.2\n")
    recording = read_recording(path, topics={"time": "t", "duty": "pwm"})
    assert recording.unit == "rad" and recording.measured.tolist() == [0.0, 0.2]


def test_reads_a_header_as_numpy_writes_it(tmp_path):
    np.savetxt(tmp_path / "run.csv", [[0, 0.1, 1], [1, 0.1, 2]], delimiter=",", header="time,duty,position")
    assert read_recording(tmp_path / "run.csv").measured.tolist() == [1.0, 2.0]


@pytest.mark.parametrize("header", ["t;duty;position\n", "# t;duty;position\n"])
def test_notes_in_front_of_the_header_are_passed_over(tmp_path, header):
    text = f"# bench 3, 2026-11-20, throttle A\n#\n{header}0,0;0;0,5\n0,1;0;0,7\n"
    assert read_recording(table(tmp_path, text), topics={"time": "t"}).measured.tolist() == [0.5, 0.7]


def test_reads_truth_values(tmp_path):
    path = table(tmp_path, "time,duty,position,enabled\n0,0,0,True\n1,0,1,false\n")
    assert read_recording(path).enabled.values.tolist() == [1.0, 0.0]


def test_no_header(tmp_path):
    assert refusal(table(tmp_path, "0.0,0.1,0.42\n0.1,0.1,0.5\n")) == (
        "run.csv has no header (its first row is 0.0,0.1,0.42), expected time, duty, and hall_voltage or"
        " position. Add a first row with the names of the columns."
    )


def test_no_header_where_decimals_have_a_comma(tmp_path):
    assert "has no header (its first row is 0,0;0,1;0,42)" in refusal(table(tmp_path, "0,0;0,1;0,42\n"))


def test_several_columns_of_one_name_are_refused_where_they_are_read(tmp_path):
    text = "time,duty,{},hall_voltage,{}\n0,0,1,0.4,2\n1,0,1,0.5,2\n"
    assert read_recording(table(tmp_path, text.format("note", "note"))).measured.tolist() == [0.4, 0.5]
    assert refusal(table(tmp_path, text.format("note", "duty"))) == (
        "run.csv has several columns duty, expected one. Rename the others."
    )


def test_no_duty_column(tmp_path):
    assert refusal(table(tmp_path, "time,pwm,hall_voltage\n0,0,0\n1,0,0\n")) == (
        "run.csv has no duty column (found: time, pwm, hall_voltage), expected time, duty, and hall_voltage"
        " or position. Name it with --topic duty=COLUMN."
    )


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "run.csv is empty, expected a header and rows. Record again."),
        ("time,duty,hall_voltage\n", "run.csv holds no samples, only a header. Record again."),
        (
            "time,duty,hall_voltage\n0,0,0\n1,0\n",
            "run.csv has 2 cells in row 3, expected 3 as in its header. Repair that row.",
        ),
        (
            "time,duty,hall_voltage\n0,0,0\n1,off,0\n",
            "run.csv has 'off' as duty in row 3, expected a finite number. Repair it.",
        ),
        ("time,duty,hall_voltage\n0,0,0\n,0,0\n", "run.csv has an empty time in row 3. Fill it in."),
        (
            "time,duty,hall_voltage\n0,0,0\n1,0,nan\n",
            "run.csv has 'nan' as hall_voltage in row 3, expected a finite number. Repair it.",
        ),
        (
            "time,duty,hall_voltage\n0,0,0\n1,0,0\n0.5,0,0\n",
            "run.csv: hall_voltage has a clock running backwards at 1.000 s (by 0.5 s), expected times that"
            " never decrease. Cut the recording there.",
        ),
    ],
)
def test_faults_are_named(tmp_path, text, message):
    assert refusal(table(tmp_path, text)) == message


def test_a_chosen_clock_is_refused(tmp_path):
    assert refusal(table(tmp_path, ROWS), time="log") == (
        "run.csv has one clock, its time column; expected no --time. Leave it out."
    )
