"""The audit blames the signal that was changed, and none where only the actuator differs from its description."""

import importlib.util
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.audit import audit
from pierburg_ros.identification.description.told import bench
from pierburg_ros.identification.experiment.synthetic import synthetic_recording
from pierburg_ros.plant import Inputs, Model, simulate
from pierburg_ros.recording import Channel, Recording


def benchmark(name):
    """A script of the folder of benchmarks, as a module."""
    spec = importlib.util.spec_from_file_location(name, Path(__file__).parents[2] / f"benchmarks/{name}.py")
    found = sys.modules[name] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(found)
    return found


rotor, faults = benchmark("rotor"), benchmark("input_faults")
ODRIVE = Path(__file__).parents[3] / "shared/data/odrive"

VALVE = Model.nominal(read_actuator("pierburg"))
TIME = np.arange(6000) / 500.0


def steps(seed, low=-0.1, high=0.4):
    """Duties [1] held for 0.4 s, of which some take the valve to either stop, some leave it between."""
    return np.repeat(np.random.default_rng(seed).uniform(low, high, 30), 200)


def recorded(seed=1, **changes):
    """A recording of a valve that differs from the description by `changes`, `effect__parameter` for dotted names."""
    values = {name.replace("__", "."): value for name, value in changes.items()}
    setpoints = Channel(TIME[::200], np.random.default_rng(seed + 50).uniform(0.0, 1.5, 30))
    return replace(synthetic_recording(VALVE.with_values(values), TIME, steps(seed)), setpoints=setpoints)


FOUND = [fault for fault in faults.FAULTS if "valve" in fault.on]
HIDDEN = {
    "duty: setpoint in its place [rad]": "these setpoints are not what this valve followed",
    "duty: setpoint in its place, share of the travel": "these setpoints are not what this valve followed",
    "duty: logged at a tenth of the rate": "a duty in force for 0.4 s is logged ten times as often",
}


@pytest.mark.parametrize("fault", [f for f in FOUND if f.name not in HIDDEN], ids=lambda fault: fault.name)
def test_names_the_signal_that_is_not_what_it_is_read_as(fault):
    lines = faults.told(fault.make, recorded(), recorded(2), VALVE)
    assert faults.is_found(fault, lines), lines


DIFFERENT = [
    {},
    {"armature_resistance": 4.139 * 6.0 / 4.0},
    {"coulomb_friction": 0.05},
    {"spring_preload": 0.4, "torque_constant": 0.018},
    {"static_friction__breakaway_torque": 0.35, "static_friction__stribeck_velocity": 0.1},
    {"input_delay__delay": 0.04},
    {"sensor_lag__time_constant": 0.025},
    {"pwm_deadband__width": 0.03},
    {"backlash__gap": 0.1, "backlash__motor_friction_share": 0.5},
    {"stop_compliance__stiffness": 6.0, "stop_compliance__damping": 0.01},
    {"sensor_nonlinearity__amplitude": 0.05, "sensor_nonlinearity__half_waves": 1.0},
    {"hall_voltage_closed": 0.55, "hall_voltage_open": 4.6},
]


@pytest.mark.parametrize("changes", DIFFERENT, ids=lambda changes: ", ".join(changes) or "as described")
def test_an_actuator_that_differs_from_its_description_is_no_fault(changes):
    assert audit([recorded(**changes)], VALVE) == []


def test_a_late_answer_is_no_fault_and_an_early_one_is():
    one = recorded()
    late, early = (replace(one, command=Channel(one.command.time + by, one.command.values)) for by in (-0.03, 0.03))
    assert audit([late], VALVE) == []
    (fault,) = audit([early], VALVE)
    assert fault.signal == "duty" and "30 ms late" in fault.what


@pytest.mark.parametrize("rate, said", [(1.004, "fast"), (0.996, "slow")])
def test_a_clock_that_runs_away_is_named(rate, said):
    one = recorded(seed=3)
    (fault,) = audit([replace(one, command=Channel(rate * one.command.time, one.command.values))], VALVE)
    clock, found, percent, way = fault.what.split()
    assert (fault.signal, clock, percent, way) == ("duty", "clock", "%", said)
    assert float(found) == pytest.approx(0.4, rel=0.2)


def test_lags_on_a_line_by_chance_are_no_clock_that_runs_away():
    """A curved sensor: four of six parts tell a lag, as if the clock were 0.04 % fast; undone, no more is explained."""
    curved = {"sensor_nonlinearity.amplitude": 0.0434918, "sensor_nonlinearity.half_waves": 2.0}
    assert audit([faults.bench(VALVE.with_values({**curved, "torque_constant": 0.0229859}), 1)], VALVE) == []


def test_a_shaft_that_stands_still_is_not_held_against_anything():
    one = recorded()
    resting = replace(one, command=Channel(one.time, np.zeros(one.time.size)), measured=one.measured[0] + 0.0 * TIME)
    assert audit([resting], VALVE) == []


def test_what_it_says_mends_the_signal():
    one = recorded()
    (fault,) = audit([replace(one, measured=1000.0 * one.measured)], VALVE)
    assert (fault.signal, fault.mend) == ("hall_voltage", "`hall_voltage: {scale: 0.001}`")
    assert str(fault).startswith("simulated: hall_voltage: millivolts read as volts. It reads ")


def test_a_model_with_effects_is_held_against_recordings_too():
    """Numbers that must keep an order, such as breakaway torque above sliding friction, stay in it while they drift."""
    worn = {"static_friction.breakaway_torque": 0.21, "static_friction.stribeck_velocity": 0.1}
    one = recorded(coulomb_friction=0.3)
    assert audit([one], VALVE.with_values(worn)) == []
    (fault,) = audit([replace(one, command=Channel(one.command.time, -one.command.values))], VALVE.with_values(worn))
    assert (fault.signal, fault.mend) == ("duty", "`duty: {sign: -1}`")


def test_a_supply_beside_a_torque_says_nothing():
    arm = Model.nominal(read_actuator("ak80"))
    one = bench(arm)
    assert audit([replace(one, supply_voltage=Channel(one.time[:1], np.array([24.0])))], arm) == []
    (fault,) = audit([replace(one, measured=np.rad2deg(one.measured))], arm)
    assert fault.mend == "`position: {unit: deg}`"


def test_recordings_of_two_valves_are_told_apart():
    assert audit([recorded(1), recorded(2)], VALVE) == []
    (fault,) = audit([recorded(1), recorded(2, torque_constant=0.012)], VALVE)
    assert fault.signal == "recording" and "They differ most in" in fault.evidence


@pytest.mark.skipif(
    not (ODRIVE / "README.md").exists(), reason="the recordings of the rotor are not beside this checkout"
)
def test_slow_turns_of_a_rotor_over_its_poles_tell_nothing_of_its_numbers():
    """The cogging that the description lacks bends them otherwise at each speed."""
    slow = sorted(ODRIVE.glob("slow2_*.npy"))
    assert len(slow) == 3
    assert (
        audit([rotor.recorded(path.stem, *np.load(path)) for path in slow], Model.nominal(read_actuator("odrive")))
        == []
    )


def test_a_winding_that_is_hotter_is_given_as_a_reason_where_it_is_one():
    """Copper rises by 0.39 % a kelvin: 75 K are 29 %."""
    hot = recorded(2, armature_resistance=4.139 * (1.0 + 75.0 * 0.0039))
    (fault,) = audit([recorded(1), hot], VALVE)
    words = fault.evidence.split("A winding ")[1].split()
    assert words[1:3] == ["K", "hotter"] and float(words[0]) == pytest.approx(75.0, abs=10.0)
    (fault,) = audit([recorded(1), recorded(2, torque_constant=0.012)], VALVE)
    assert "winding" not in fault.evidence


@pytest.mark.parametrize("samples", [2, 30, 90])
def test_recordings_that_are_too_short_are_left_to_others(samples):
    one = recorded()
    short = replace(one, time=one.time[:samples], measured=one.measured[:samples], setpoints=None)
    assert audit([short], VALVE) == []


def test_a_bridge_that_was_open_for_a_while_is_no_duty_of_another_run():
    """It was where most moves; the duty still causes the motion before and after."""
    time = np.arange(30_000) / 500.0
    duty = np.repeat(np.random.default_rng(1).uniform(-0.1, 0.4, 75), 400)
    duty = np.where(np.abs(time - 30.0) > 10.0, 0.15 + 0.3 * (duty - 0.15), duty)
    away = (time > 25.0) & (time < 34.0)
    hall = simulate(VALVE, Inputs(time, duty, None, ~away), time)
    noise = 0.002 * np.random.default_rng(2).standard_normal(time.size)
    given = Recording("open.mcap", "hall_voltage", time, hall + noise, Channel(time, duty))
    assert not audit([given], VALVE)
    other = Channel(time, np.repeat(np.random.default_rng(9).uniform(-0.1, 0.4, 75), 400))
    assert audit([replace(given, command=other)], VALVE)
