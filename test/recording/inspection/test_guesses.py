"""What a number could be, by its name, its type and its range."""

import numpy as np
import pytest

from pierburg_ros.recording.inspection.fields import Field
from pierburg_ros.recording.inspection.guesses import guess
from pierburg_ros.recording.inspection.table_time import time_guess

JOINT = "sensor_msgs/msg/JointState"


def field(name, path, low, high, whole=False, kind="bench/msg/X"):
    """A field whose values run from `low` to `high`."""
    values = np.linspace(low, high, 50)
    return Field(name, kind, path, np.round(values) if whole else values)


@pytest.mark.parametrize(
    ("given", "signal", "unit"),
    [
        (field("/motor/command", "pwm.data[2]", -80, 80), "duty", "percent"),
        (field("/motor/command", "pwm", -0.8, 0.8), "duty", "1"),
        (field("/motor/command", "pwm", -800, 885, whole=True), "duty", "counts"),
        (field("/applied_duty", "data", -1, 1), "applied_duty", "1"),
        (field("/arm/joint_states", "position[elbow]", 0, 1.57, kind=JOINT), "position", "rad"),
        (field("/arm/joint_states", "velocity[elbow]", -9, 9, kind=JOINT), "speed", "rad/s"),
        (field("/arm/joint_states", "effort[elbow]", -9, 9, kind=JOINT), "torque", "N.m"),
        (field("/arm/joint_states", "velocity[target_motor_current]", -9, 9, kind=JOINT), "speed", "rad/s"),
        (field("/joint_commands", "position[elbow]", 0, 20, kind=JOINT), "setpoints", "rad"),
        (field("/effort_controller/commands", "data[0]", -9, 9), "torque", "N.m"),
        (field("/encoder_output", "data", 0, 3), "position", "rad"),
        (field("theta_dot", "", -9, 9), "speed", "rad/s"),
        (field("/encoder", "data", 0, 16000, whole=True), "position", "counts"),
        (field("winkel", "", 0, 90), "position", "deg"),
        (field("position", "", -7.2, 2.0), "position", "rad"),
        (field("angle_rad", "", 0, 9), "position", "rad"),
        (field("/board", "adc", 0, 4000, whole=True), "hall_voltage", "counts"),
        (field("hall [mV]", "", 420, 4520), "hall_voltage", "mV"),
        (field("vbat", "", 11.5, 13.9), "supply_voltage", "V"),
        (field("/battery_state", "voltage", 11.5, 13.9, kind="sensor_msgs/msg/BatteryState"), "supply_voltage", "V"),
        (field("Iq", "", -2, 2), "current", "A"),
        (field("motor_current_mA", "", -1500, 1500), "current", "mA"),
        (field("/wheel", "rpm", -3000, 3000), "speed", "rpm"),
        (field("/driver", "temperature", 20, 60), "temperature", "degC"),
        (field("target_position", "", 0, 1.5), "setpoints", "rad"),
        (field("motor_enabled", "", 0, 1, whole=True), "enabled", "1"),
        (field("ch3", "", 3, 4001, whole=True), "hall_voltage", "counts"),
        (field("ch1", "", -100, 100), "duty", "percent"),
        (field("/cmd", "data", -1, 1), "duty", "1"),
        (field("position_cmd", "", -1, 1), "setpoints", "rad"),
        (field("/command", "data", 0, 2), "setpoints", "rad"),
        (field("Strom [mA]", "", -300, 300), "current", "mA"),
        (field("n_rpm", "", -300, 300), "speed", "rpm"),
        (field("PWM [%]", "", -0.5, 0.5), "duty", "percent"),
    ],
)
def test_a_number_is_taken_for(given, signal, unit):
    found = guess(given)
    assert (found.signal, found.unit) == (signal, unit)
    assert f"[{'fraction' if unit == '1' and 'duty' in signal else found.unit}" in str(found) or signal == "enabled"


@pytest.mark.parametrize(
    "given",
    [
        field("/x", "header.stamp.sec", 1e9, 1e9 + 50, whole=True),
        field("/x", "seq", 0, 50, whole=True),
        field("/x", "gain", 7, 7),
        field("/camera", "height", 480, 481.5),
        field("/velocity_controller/commands", "data[0]", -1, 1),
        field("/tracking_error", "data", -1, 1),
        Field("/x", "bench/msg/X", "duty", np.full(3, np.nan)),
    ],
)
def test_nothing_speaks_for_anything(given):
    assert guess(given) is None


def test_counts_are_scaled_by_the_whole_range_of_their_converter():
    assert guess(field("/adc", "data", 0, 3900, whole=True)).scale == pytest.approx(3.3 / 4096)
    assert guess(field("/adc", "data", 0, 900, whole=True)).scale == pytest.approx(3.3 / 1024)
    assert guess(field("/encoder", "data", 0, 4090, whole=True)).scale == pytest.approx(2 * np.pi / 4096)


@pytest.mark.parametrize(
    ("name", "first", "step", "unit"),
    [
        ("time", 0.0, 0.002, "s"),
        ("t", 0.0, 2.0, "ms"),
        ("t", 0.0, 2000.0, "us"),
        ("t", 0.0, 2e6, "ns"),
        ("time [ms]", 0.0, 0.1, "ms"),
        ("t_us", 5.0, 3.0, "us"),
        ("stamp", 1.7e9, 0.01, "s"),
        ("stamp", 1.7e12, 10.0, "ms"),
        ("stamp", 1.7e15, 1e4, "us"),
        ("stamp", 1.7e18, 1e7, "ns"),
    ],
)
def test_the_unit_of_a_time_follows_from_its_name_its_origin_or_its_steps(name, first, step, unit):
    columns = {"rising": np.arange(40.0) * 7, name: first + step * np.arange(40)}
    found = time_guess(columns)
    assert (found.columns, found.unit) == ((name,), unit)


def test_stamps_of_ros_in_two_columns_are_one_time():
    nanoseconds = 900_000_000 + 10_000_000 * np.arange(40)
    found = time_guess({"stamp.sec": 5.0 + nanoseconds // 10**9, "stamp.nanosec": (nanoseconds % 10**9).astype(float)})
    assert found.columns == ("stamp.sec", "stamp.nanosec")
    np.testing.assert_allclose(found.seconds, 0.01 * np.arange(40), atol=1e-9)


def test_no_column_rises():
    assert time_guess({"time": np.array([1.0, 0.5, 2.0]), "x": np.zeros(3)}) is None
