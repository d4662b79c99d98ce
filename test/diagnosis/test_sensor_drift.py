"""A sensor that is off is found as that one drift, and hides nothing else."""

from importlib import resources

import numpy as np
import pytest
import yaml

from pierburg_ros.actuators import actuator_of
from pierburg_ros.diagnosis.diagnose import diagnose
from pierburg_ros.plant import Inputs, Model, simulate
from pierburg_ros.recording import Channel, Recording

STUCK = {"static_friction.breakaway_torque": 0.27, "static_friction.stribeck_velocity": 0.1}


def valve_by_position() -> Model:
    """The nominal valve with a sensor that gives the angle itself."""
    file = resources.files("pierburg_ros.actuators") / "pierburg.yaml"
    description = yaml.safe_load(file.read_text(encoding="utf-8")) | {"name": "by_position", "sensor": "position"}
    for name in ("hall_voltage_closed", "hall_voltage_open"):
        del description["parameters"][name]
    return Model.nominal(actuator_of(description, "by_position"))


@pytest.mark.parametrize(
    ("changes", "effects", "drifted"),
    (
        (STUCK | {"sensor_offset": 0.05}, ["static_friction"], {"sensor_offset": 0.05}),
        ({"sensor_scale": 1.05}, [], {"sensor_scale": 1.05}),
    ),
    ids=("zero beside static friction", "scale"),
)
def test_scale_or_zero_of_a_position_sensor_is_one_drift(changes, effects, drifted):
    nominal, random = valve_by_position(), np.random.default_rng(0)
    time = np.arange(0.0, 24.0, 0.002)
    duty = random.uniform(-0.05, 0.36, 41)[(time / 0.6).astype(int)]
    duty[time < 0.3] = 0.0
    angle = simulate(nominal.with_values(changes), Inputs(time, duty), time) + 0.001 * random.standard_normal(time.size)
    found = diagnose([Recording("off", "position", time, angle, Channel(time, duty))], nominal).diagnosis
    assert [effect.id for effect in found.effects] == effects
    values = {name: p.value for name, p in found.parameters.items() if p.drifted}
    assert values == pytest.approx(drifted, abs=1e-4)
