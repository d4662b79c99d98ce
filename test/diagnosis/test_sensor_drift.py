"""A sensor of position: its zero and scale as drifts, and the units of what moves along a line."""

from importlib import resources

import numpy as np
import pytest
import yaml

from pierburg_ros.actuators import actuator_of
from pierburg_ros.diagnosis.diagnose import diagnose
from pierburg_ros.diagnosis.report.figures import signal_figure
from pierburg_ros.plant import Inputs, Model, simulate
from pierburg_ros.recording import Channel, Recording

STUCK = {"static_friction.breakaway_torque": 0.27, "static_friction.stribeck_velocity": 0.1}


def valve_by_position(motion: str) -> Model:
    """The nominal valve with a sensor that gives the position itself, its numbers in rad or in m."""
    file = resources.files("pierburg_ros.actuators") / "pierburg.yaml"
    description = yaml.safe_load(file.read_text(encoding="utf-8")) | {"name": "by_position", "sensor": "position"}
    description["motion"] = motion
    for name in ("hall_voltage_closed", "hall_voltage_open"):
        del description["parameters"][name]
    return Model.nominal(actuator_of(description, "by_position"))


def recorded(nominal: Model, changes: dict[str, float]) -> Recording:
    """Random steps of duty through the valve with `changes`, 1 mrad (or mm) of noise."""
    random = np.random.default_rng(0)
    time = np.arange(0.0, 24.0, 0.002)
    duty = random.uniform(-0.05, 0.36, 41)[(time / 0.6).astype(int)]
    duty[time < 0.3] = 0.0
    angle = simulate(nominal.with_values(changes), Inputs(time, duty), time) + 0.001 * random.standard_normal(time.size)
    return Recording("off", "position", time, angle, Channel(time, duty))


@pytest.mark.search
@pytest.mark.parametrize(
    ("changes", "effects", "drifted"),
    (
        (STUCK | {"sensor_offset": 0.05}, ["static_friction"], {"sensor_offset": 0.05}),
        ({"sensor_scale": 1.05}, [], {"sensor_scale": 1.05}),
    ),
    ids=("zero beside static friction", "scale"),
)
def test_scale_or_zero_of_a_position_sensor_is_one_drift(changes, effects, drifted):
    nominal = valve_by_position("rotary")
    found = diagnose([recorded(nominal, changes)], nominal).diagnosis
    assert [effect.id for effect in found.effects] == effects
    values = {name: p.value for name, p in found.parameters.items() if p.drifted}
    assert values == pytest.approx(drifted, abs=1e-4)


@pytest.mark.search
def test_a_linear_actuator_is_spoken_of_in_metres():
    nominal = valve_by_position("linear")
    result = diagnose([recorded(nominal, {"armature_resistance": 5.2})], nominal)
    assert result.diagnosis.verdict == "parameter_drift"
    speaks_of_metres(result)


def speaks_of_metres(result):
    """Nothing in the results of a linear actuator is in radians, degrees or newton metres."""
    text = result.diagnosis.text() + signal_figure(result.diagnosis, result.signals).to_json()
    assert result.diagnosis.unit == "m" and result.diagnosis.parameters["spring_stiffness"].unit == "N/m"
    assert "mm" in result.diagnosis.data_quality.excited and "m/s" in result.diagnosis.data_quality.excited
    for unit in ('"rad"', "rad/s", "degrees", "N.m/rad", '"N.m"', "kg.m^2", "[rad]"):
        assert unit not in text, unit
