"""A fault is told with the line that mends it, and no clean recording is refused, whatever physics it shows."""

import importlib.util
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.audit import audit
from pierburg_ros.errors import InputError
from pierburg_ros.library.reading import read
from pierburg_ros.plant import Model
from pierburg_ros.recording import Channel
from pierburg_ros.recording.signal_map import read_signal_map


def benchmark(name):
    """A script of the folder of benchmarks, as a module."""
    spec = importlib.util.spec_from_file_location(name, Path(__file__).parents[2] / f"benchmarks/{name}.py")
    found = sys.modules[name] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(found)
    return found


rotor, faults = benchmark("rotor"), benchmark("input_faults")
DATA = Path(__file__).parents[3] / "shared/data"
VALVE, SERVO, ARM = (Model.nominal(read_actuator(name)) for name in ("pierburg", "xl330", "ak80"))


@pytest.mark.parametrize("number", range(0, 200, 5))
def test_a_recording_is_not_refused_for_missing_physics(number):
    what, nominal, recording = faults.simulated_clean(number)
    assert audit([recording], nominal) == [], what


def commanded(change):
    return lambda one: replace(one, command=Channel(one.command.time, change(one.command.values)))


def sensed(change):
    return lambda one: replace(one, measured=change(one.measured))


def late(by):
    return lambda one: replace(one, command=Channel(one.command.time + by, one.command.values))


MADE = {
    "reversed command of a valve": (VALVE, commanded(np.negative), "duty", "`duty: {sign: -1}`"),
    "duty divided by 100": (VALVE, commanded(lambda duty: duty / 100.0), "duty", "`duty: {scale: 100}`"),
    "reversed sensor of a valve": (VALVE, sensed(lambda volts: 4.94 - volts), "hall_voltage", "sign: -1, offset: 4.94"),
    "millivolts": (VALVE, sensed(lambda volts: 1e3 * volts), "hall_voltage", "`hall_voltage: {scale: 0.001}`"),
    "a gain of 2": (VALVE, sensed(lambda volts: 2.0 * volts), "hall_voltage", "`hall_voltage: {scale: 0.5}`"),
    "degrees of a servo": (SERVO, sensed(np.rad2deg), "position", "`position: {unit: deg}`"),
    "reversed command of a servo": (SERVO, commanded(np.negative), "duty", "`duty: {sign: -1}`"),
    "reversed torque of an arm": (ARM, commanded(np.negative), "torque", "`torque: {sign: -1}`"),
    "degrees of an arm": (ARM, sensed(np.rad2deg), "position", "`position: {unit: deg}`"),
    "a late command of an arm": (ARM, late(0.5), "torque", "--time"),
}


@pytest.mark.parametrize("effect", [{}, {"load_dependent_friction.coefficient": 0.15}], ids=["", "load-dependent"])
@pytest.mark.parametrize("closed", [False, True], ids=["open", "closed"])
@pytest.mark.parametrize("name", MADE)
def test_a_fault_is_told_with_the_line_that_mends_it(name, closed, effect):
    nominal, make, signal, mend = MADE[name]
    worn = nominal.with_values(effect)
    one = faults.in_loop(worn, 3) if closed else faults.standard(worn, 3)
    (fault,) = audit([replace(make(one), setpoints=None)], nominal)
    assert (fault.signal, mend in fault.mend) == (signal, True), fault


def test_what_is_said_to_be_exact_is_not_doubted():
    one = commanded(np.negative)(faults.standard(VALVE, 3))
    assert [fault.signal for fault in audit([one], VALVE)] == ["duty"]
    assert "duty" not in [fault.signal for fault in audit([replace(one, exact=frozenset({"duty"}))], VALVE)]


def test_recorded_setpoints_in_place_of_the_duty_are_told():
    one = faults.in_loop(VALVE, 3)
    inside = Channel(one.setpoints.time, one.setpoints.values / 2.0)
    (fault,) = audit([replace(one, command=inside, setpoints=inside)], VALVE)
    assert fault.what == "a setpoint in place of the duty"


def test_samples_that_were_stamped_as_they_were_written_are_told():
    """Twenty at once, 10 us apart: nothing else is wrong with them."""
    one = faults.standard(VALVE, 3)
    number = np.arange(one.time.size)
    stamps = 20 * one.time[1] * (number // 20) + 1e-5 * (number % 20)
    (fault,) = audit([replace(one, time=stamps, command=Channel(stamps, one.command.at(one.time)))], VALVE)
    assert (fault.signal, fault.what) == ("time", "stamped in bursts") and "s apart on average" in fault.evidence


def test_a_sensor_that_is_not_read_is_told_and_a_shaft_at_rest_is_not():
    one = faults.standard(VALVE, 3)
    still = replace(one, measured=np.full(one.time.size, 0.42))
    (fault,) = audit([still], VALVE)
    assert (fault.signal, fault.what) == ("hall_voltage", "constant")
    assert audit([replace(still, command=Channel(one.time, np.zeros(one.time.size)))], VALVE) == []


@pytest.mark.parametrize("samples", [2, 30, 90])
def test_recordings_that_are_too_short_are_left_to_others(samples):
    one = faults.standard(VALVE, 3)
    short = replace(one, time=one.time[:samples], measured=one.measured[:samples], setpoints=None)
    assert audit([short], VALVE) == []


def described(name):
    if not (DATA / name).exists():
        pytest.skip(f"{name} is not beside this checkout")
    return Model.nominal(read_actuator(str(DATA / name)))


@pytest.mark.parametrize("part", ["train", "test"])
def test_a_joint_whose_viscous_friction_dominates_is_clean_and_its_reversed_torque_is_told(part):
    joint, path = described("tx40/j4.yaml"), DATA / f"tx40/{part}.csv"
    assert audit([read(path, signals=DATA / "tx40/sig.yaml", actuator=joint.actuator)], joint) == []
    (fault,) = audit([read(path, signals=DATA / "tx40/sig_wrong.yaml", actuator=joint.actuator)], joint)
    assert fault.mend == '`torque: {column: "torque [N.m]", sign: -1}`'


@pytest.mark.parametrize("part", ["randomStepSequence", "fixedStepSequence", "closedLoop"])
def test_a_duty_that_is_a_staircase_is_clean(part):
    motor = described("ce109/bh.yaml")
    one = read(DATA / f"ce109/{part}.csv", signals=DATA / "ce109/sig.yaml", actuator=motor.actuator)
    assert audit([one], motor) == []


@pytest.mark.skipif(not (DATA / "xl330").exists(), reason="the servo's recordings are not beside this checkout")
@pytest.mark.parametrize("path", sorted((DATA / "xl330").glob("*.mcap")), ids=lambda path: path.stem)
def test_a_servo_whose_duty_resembles_its_setpoint_is_clean(path):
    assert audit([read(path, actuator=SERVO.actuator)], SERVO) == []


def test_a_mend_is_the_final_line_with_what_is_written_already():
    given = {"position": {"column": "a b", "unit": "deg", "scale": 0.5, "sign": -1, "offset": 0.1}}
    source = read_signal_map(given).sources["position"]
    assert source.mended(-1.0, 0.0).line("position") == 'position: {column: "a b", unit: deg, scale: 0.5, offset: -0.1}'
    plain = read_signal_map({"speed": {"topic": "/wheel", "exact": True}}).sources["speed"]
    assert plain.mended(0.1047, 0.0, "rpm").line("speed") == "speed: {topic: /wheel, unit: rpm, exact: true}"


def test_exact_signals_are_named_in_the_map_or_by_an_option(tmp_path):
    path = tmp_path / "run.csv"
    path.write_text("time,applied_duty,position\n" + "".join(f"{k / 100},{k % 2},{k / 50}\n" for k in range(100)))
    assert read(path).exact == frozenset()
    assert read(path, exact=["applied_duty"]).exact == {"duty"}
    assert read(path, signals={"applied_duty": {"column": "applied_duty", "exact": True}}).exact == {"duty"}
    with pytest.raises(InputError, match="--exact found 'dutty'"):
        read(path, exact=["dutty"])
    with pytest.raises(InputError, match="exact 'yes', expected true or false"):
        read(path, signals={"applied_duty": {"column": "applied_duty", "exact": "yes"}})
