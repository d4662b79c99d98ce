"""Setpoint rules of the contract and the setpoint file."""

import math

import numpy as np
import pytest

from pierburg_ros.control import Setpoints, read_duty_file, read_setpoint_file
from pierburg_ros.errors import InputError


@pytest.mark.parametrize(("offered", "active"), [(-0.002, 0.0), (0.7, 0.7), (math.pi / 2 + 0.0019, math.pi / 2)])
def test_clamps_close_to_a_stop(offered, active):
    assert Setpoints().offer(offered) == active


@pytest.mark.parametrize("offered", [-0.0021, math.pi / 2 + 0.0021, math.nan, math.inf, -math.inf])
def test_refuses_beyond_a_stop_and_keeps_the_last(offered):
    setpoints = Setpoints(initial=0.4)
    with pytest.raises(InputError, match="Setpoint"):
        setpoints.offer(offered)
    assert setpoints.active == 0.4


def test_the_last_writer_wins():
    setpoints = Setpoints()
    setpoints.offer(0.3)
    setpoints.offer(0.2)
    assert setpoints.active == 0.2


def written(folder, text):
    path = folder / "setpoints.csv"
    path.write_text(text)
    return path


def test_a_schedule_holds_each_setpoint_until_the_next(tmp_path):
    schedule = read_setpoint_file(written(tmp_path, "time,setpoint\n0.5,0.1\n1,0.2\n\n2.5,1.5707963\n"))
    assert [schedule.at(time) for time in (0.0, 0.5, 0.999, 1.0, 99.0)] == [0.1, 0.1, 0.1, 0.2, 1.5707963]
    assert np.array_equal(schedule.time, [0.5, 1.0, 2.5])


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("", "does not begin with the header time,setpoint"),
        ("0,0.1\n", "does not begin with the header time,setpoint"),
        ("time,setpoint\n", "holds no setpoint"),
        ("time,setpoint\n0,0.1\n1,x\n", "line 3: '1,x' is not two numbers"),
        ("time,setpoint\n0,0.1,7\n", "line 2: '0,0.1,7' is not two numbers"),
        ("time,setpoint\nnan,0.1\n", "line 2: time nan is not finite"),
        ("time,setpoint\n0,1.7\n", "line 2: Setpoint 1.7 rad is beyond the stops"),
        ("time,setpoint\n1,0.1\n1,0.2\n", "times do not rise"),
    ],
)
def test_says_what_is_wrong_with_a_file(tmp_path, text, reason):
    with pytest.raises(InputError, match=reason):
        read_setpoint_file(written(tmp_path, text))


def test_says_that_a_file_is_missing(tmp_path):
    with pytest.raises(InputError, match="does not exist, expected a setpoint file"):
        read_setpoint_file(tmp_path / "none.csv")


def test_a_duty_file_is_read_the_same_way(tmp_path):
    path = tmp_path / "duty.csv"
    path.write_text("time,duty\n0,0.24\n3.5,-1\n")
    schedule = read_duty_file(path)
    assert [schedule.at(time) for time in (0.0, 3.5)] == [0.24, -1.0]


@pytest.mark.parametrize("duty", ["24", "nan", "-1.01"])
def test_a_duty_beyond_full_is_refused(tmp_path, duty):
    path = tmp_path / "duty.csv"
    path.write_text(f"time,duty\n0,{duty}\n")
    with pytest.raises(InputError, match=r"line 2: Duty .* fraction of the supply voltage"):
        read_duty_file(path)
