"""Times as ISO 8601 writes them, against known moments."""

import numpy as np
import pytest
from support.tables import refusal, table

from pierburg_ros.recording import read_recording
from pierburg_ros.recording.formats.stamps import nanoseconds

MOMENT = 1_772_366_400 * 10**9
"""2026-03-01 12:00:00 UTC, as `date -d 2026-03-01T12:00:00Z +%s` says."""


def write(tmp_path, stamps, name="run.csv", delimiter=","):
    rows = [delimiter.join([stamp, "0.1", str(place)]) for place, stamp in enumerate(stamps)]
    return table(tmp_path, "\n".join([delimiter.join(["time", "duty", "position"]), *rows]) + "\n", name)


@pytest.mark.parametrize(
    ("cell", "since"),
    [
        ("2026-03-01 12:00:00", 0),
        ("2026-03-01T12:00:00Z", 0),
        ("2026-03-01t12:00:00z", 0),
        ("2026-03-01 12:00", 0),
        ("2026-03-01 12:00:00.123", 123_000_000),
        ("2026-03-01 12:00:00,5", 500_000_000),
        ("2026-03-01T12:00:00.123456789Z", 123_456_789),
        ("2026-03-01T13:00:00+01:00", 0),
        ("2026-03-01T13:00:00+01", 0),
        ("2026-03-01 08:30:00 -0330", 0),
        ("2026-02-28T12:00:00Z", -86_400 * 10**9),
    ],
)
def test_a_stamp_is_a_moment(cell, since):
    assert nanoseconds(cell) == MOMENT + since


def test_times_before_1970_count_backwards():
    assert nanoseconds("1969-12-31T23:59:59.5Z") == -500_000_000


@pytest.mark.parametrize(
    "cell", ["2026-03-01", "12:00:00", "2026-02-30 12:00:00", "2026-03-01T25:00:00", "2026-03-01 12:00:00+99:00", "now"]
)
def test_what_is_no_moment_is_none(cell):
    assert nanoseconds(cell) is None


@pytest.mark.parametrize("zone", ["", "Z", "+02:00"])
def test_stamps_are_read_to_the_microsecond(tmp_path, zone):
    stamps = [f"2026-03-01 23:59:59.{part:06}{zone}" for part in (0, 2000, 4001)]
    recording = read_recording(write(tmp_path, [*stamps, f"2026-03-02 00:00:00{zone}"]))
    np.testing.assert_allclose(recording.time, [0.0, 0.002, 0.004001, 1.0], rtol=0.0, atol=1e-12)
    hours = {"": 0, "Z": 0, "+02:00": 2}[zone]
    assert recording.file_times.log_time[0] // 10**9 == MOMENT // 10**9 + 43_199 - 3600 * hours


def test_a_decimal_comma_goes_with_semicolons(tmp_path):
    path = tmp_path / "run.csv"
    path.write_text("time;duty;position\n2026-03-01 12:00:00,25;0,1;0,5\n2026-03-01 12:00:00,75;0,1;0,7\n")
    assert read_recording(path).time.tolist() == [0.0, 0.5]


def test_parts_count_from_one_moment(tmp_path):
    write(tmp_path, ["2026-03-01T12:00:00Z", "2026-03-01T12:00:01Z"], "a.csv")
    write(tmp_path, ["2026-03-01T13:00:02+01:00", "2026-03-01T13:00:03+01:00"], "b.csv")
    signals = {name: {"column": name, "file": ["a.csv", "b.csv"]} for name in ("duty", "position")}
    assert read_recording(tmp_path, signals=signals).time.tolist() == [0.0, 1.0, 2.0, 3.0]


@pytest.mark.parametrize(
    ("stamps", "message"),
    [
        (
            ["2026-03-01 12:00:00", "12:00:01"],
            "run.csv has '12:00:01' as time in row 3, expected a stamp as 2026-03-01T12:00:00.5Z, with"
            " a zone in every row"
            " or in none. Repair it.",
        ),
        (
            ["2026-03-01 12:00:00Z", "2026-03-01 12:00:01"],
            "run.csv has '2026-03-01 12:00:01' as time in row 3, expected a stamp as"
            " 2026-03-01T12:00:00.5Z, with a zone"
            " in every row or in none. Repair it.",
        ),
        (
            ["0.0", "2026-03-01 12:00:01"],
            "run.csv has '2026-03-01 12:00:01' as time in row 3, expected a finite number, or a stamp as"
            " 2026-03-01T12:00:00.5Z in every row. Repair it.",
        ),
        (
            ["2026-02-30 12:00:00", "2026-03-01 12:00:01"],
            "run.csv has '2026-02-30 12:00:00' as time in row 2, expected a stamp as"
            " 2026-03-01T12:00:00.5Z, with a zone"
            " in every row or in none. Repair it.",
        ),
        (["2026-03-01 12:00:00", ""], "run.csv has an empty time in row 3. Fill it in."),
        (
            ["2026-03-01 12:00:01", "2026-03-01 12:00:00"],
            "run.csv: position has a clock running backwards at 0.000 s (by 1 s), expected times that"
            " never decrease. Cut"
            " the recording there.",
        ),
    ],
)
def test_half_broken_stamps_are_named(tmp_path, stamps, message):
    assert refusal(write(tmp_path, stamps)) == message


def test_only_the_time_has_stamps_and_stamps_have_no_unit(tmp_path):
    path = write(tmp_path, ["2026-03-01 12:00:00", "2026-03-01 12:00:01"])
    signals = {"time": {"column": "position"}, "position": {"column": "time"}}
    assert refusal(path, signals=signals) == (
        "run.csv has stamps in the column time, expected numbers: only the time has stamps. Name another column."
    )
    assert refusal(path, signals={"time": {"column": "time", "unit": "ms"}}) == (
        "signals: time has a unit, run.csv has stamps in time. Leave it out."
    )
