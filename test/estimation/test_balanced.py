"""The balance of torques finds the numbers of motions that are written down, from descriptions that are far off."""

import numpy as np
import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.estimation.balanced import Motion, balanced, window
from pierburg_ros.plant import Inputs, Model

PENDULUM, ROTOR, SERVO = (Model.nominal(read_actuator(name)) for name in ("ak80", "odrive", "xl330"))
TIME = np.arange(0.0, 8.0, 0.004)
NAMES = ("total_inertia", "coulomb_friction", "viscous_friction.coefficient")


def swung(model, seed=0, noise=2e-4):
    """Angle of a sum of sines, and the torque that it takes by equation (6): time, angle, velocity, torque."""
    random = np.random.default_rng(seed)
    angle, velocity, acceleration = np.zeros(TIME.size), np.zeros(TIME.size), np.zeros(TIME.size)
    for rate, phase in zip((1.3, 3.1, 7.7), random.uniform(0.0, 6.0, 3), strict=True):
        angle += 0.5 * np.sin(rate * TIME + phase)
        velocity += 0.5 * rate * np.cos(rate * TIME + phase)
        acceleration -= 0.5 * rate**2 * np.sin(rate * TIME + phase)
    value = model.values
    torque = value["total_inertia"] * acceleration + value["coulomb_friction"] * np.sign(velocity)
    torque += value["viscous_friction.coefficient"] * velocity + value.get("gravity_torque", 0.0) * np.sin(angle)
    return angle + noise * random.standard_normal(TIME.size), velocity, torque


def factors(found, model, names=NAMES):
    return {name: found.values[name] / model.values[name] for name in names}


@pytest.mark.parametrize("off", [1 / 20, 1 / 5, 1.0, 5.0, 20.0])
@pytest.mark.parametrize("seed", [0, 1])
def test_finds_a_pendulum_under_torque(off, seed):
    angle, _, torque = swung(PENDULUM, seed)
    start = PENDULUM.with_values({"total_inertia": off * 0.147, "coulomb_friction": 0.184 / off**0.5})
    found = balanced(start, [Motion(Inputs(TIME, torque), TIME, angle, "position")], (*NAMES, "torque_scale"))
    assert found.values["torque_scale"] == pytest.approx(1.0, rel=0.05)
    assert factors(found, PENDULUM, NAMES[:1])["total_inertia"] == pytest.approx(1.0, rel=0.05)
    assert factors(found, PENDULUM, NAMES[1:2])["coulomb_friction"] == pytest.approx(1.0, rel=0.15)


@pytest.mark.parametrize("off", [1 / 20, 20.0])
def test_finds_a_rotor_under_current(off):
    model = ROTOR.with_values({"viscous_friction.coefficient": 1e-4})
    angle, _, torque = swung(model)
    motion = Motion(Inputs(TIME, torque / model.values["torque_constant"]), TIME, angle, "position")
    found = balanced(model.with_values({"total_inertia": off * model.values["total_inertia"]}), [motion], NAMES)
    assert found.values["total_inertia"] == pytest.approx(model.values["total_inertia"], rel=0.05)


@pytest.mark.parametrize("recorded", [False, True])
def test_finds_the_lumps_of_a_servo_under_duty(recorded):
    """Resistance and constant are tied by their friction; what the voltage makes is not, nor what brakes."""
    angle, velocity, torque = swung(SERVO)
    value = SERVO.values
    volts = torque * value["armature_resistance"] / value["torque_constant"] + value["torque_constant"] * velocity
    supply = np.full(TIME.size, 9.0) if recorded else None
    inputs = Inputs(TIME, volts / (9.0 if recorded else value["supply_voltage"]), supply)
    start = SERVO.with_values({"total_inertia": 0.1 * value["total_inertia"], "armature_resistance": 9.0})
    names = (*NAMES, "armature_resistance", "torque_constant")
    found = balanced(start, [Motion(inputs, TIME, angle, "position")], names).values
    driving = [each["torque_constant"] / each["armature_resistance"] for each in (found, value)]
    braking = [each["torque_constant"] * part for each, part in zip((found, value), driving, strict=True)]
    braking = [part + each["viscous_friction.coefficient"] for each, part in zip((found, value), braking, strict=True)]
    assert driving[0] == pytest.approx(driving[1], rel=0.03)
    assert braking[0] == pytest.approx(braking[1], rel=0.05)
    assert found["total_inertia"] == pytest.approx(value["total_inertia"], rel=0.05)


@pytest.mark.parametrize("unit", [0.01, 10.0])
def test_it_finds_the_same_in_other_units_of_torque(unit):
    angle, _, torque = swung(PENDULUM)
    start = PENDULUM.with_values({"total_inertia": 0.05})
    scaled = {name: unit * start.values[name] for name in (*NAMES, "gravity_torque")}
    pairs = (start, torque), (start.with_values(scaled), unit * torque)
    one, other = (balanced(model, [Motion(Inputs(TIME, u), TIME, angle, "position")], NAMES) for model, u in pairs)
    for name in NAMES:
        assert other.values[name] == pytest.approx(unit * one.values[name], rel=1e-3)


def test_a_shaft_that_rests_tells_nothing():
    noise = 1e-3 * np.random.default_rng(0).standard_normal(TIME.size)
    assert balanced(PENDULUM, [Motion(Inputs(TIME, np.zeros(TIME.size)), TIME, noise, "position")], NAMES) is None


def test_a_noisier_motion_is_told_over_a_longer_window():
    angle, _, _ = swung(PENDULUM, noise=0.0)
    widths = [window(angle, noise, 0.004, 2) for noise in (1e-6, 1e-3, 1e-1)]
    assert widths[0] < widths[1] < widths[2]
