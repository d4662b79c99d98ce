"""identification.json as the contract fixes it, and recordings that cannot be identified."""

import json

import numpy as np
import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.errors import InputError
from pierburg_ros.identification.identify import free_names, identify
from pierburg_ros.plant import Model
from pierburg_ros.recording import Channel, Recording


@pytest.fixture(scope="module")
def content(nominal, rich_recording):
    mapping = identify(nominal, [rich_recording]).as_mapping()
    return json.loads(json.dumps(mapping, allow_nan=False))


def test_the_file_has_the_keys_of_the_contract(content):
    assert list(content) == ["schema", "parameters", "lumps", "static_characteristic", "fit"]
    resistance = content["parameters"]["armature_resistance"]
    assert set(resistance) == {"value", "unit", "ci95", "identifiable", "fixed"}
    assert resistance["unit"] == "ohm"
    assert set(content["lumps"]) == {"time_constant", "gain", "preload_angle", "friction_angle"}
    assert set(content["static_characteristic"]) == {"D_c", "D_pre"}
    assert set(content["fit"]) == {"training", "validation"}


def test_lumps_of_the_nominal_valve_within_one_percent(content):
    expected = {"time_constant": 1.1465, "gain": 18.862, "preload_angle": 2.0437, "friction_angle": 1.4144}
    for name, value in expected.items():
        assert content["lumps"][name]["value"] == pytest.approx(value, rel=0.01)
    assert content["static_characteristic"]["D_c"]["value"] == pytest.approx(0.07499, rel=0.01)
    assert content["static_characteristic"]["D_pre"]["value"] == pytest.approx(0.10835, rel=0.01)


def test_errors_on_seen_and_unseen_data_are_the_noise(content):
    assert content["fit"]["training"]["rmse"] == pytest.approx(0.003, rel=0.05)
    assert content["fit"]["validation"]["rmse"] == pytest.approx(0.003, rel=0.1)


def test_held_parameters_have_no_interval(content):
    inertia = content["parameters"]["total_inertia"]
    assert inertia["fixed"] and not inertia["identifiable"] and inertia["ci95"] is None


def test_a_pendulum_has_neither_lumps_nor_static_characteristic():
    model = Model.nominal(read_actuator("xl330"))
    assert "gravity_torque" not in free_names(model)
    assert "viscous_friction.coefficient" in free_names(model)
    time = np.arange(3000) / 500.0
    duty = Channel(np.arange(6.0), np.array([0.0, 0.2, -0.2, 0.3, 0.0, 0.1]))
    angle = np.sin(2.0 * time) + 1e-4 * np.random.default_rng(1).standard_normal(time.size)
    found = identify(model, [Recording("swing", "position", time, angle, duty)]).as_mapping()
    assert found["lumps"] is None
    assert found["static_characteristic"] is None


def test_free_and_fix_change_what_is_fitted(nominal):
    names = free_names(nominal, free=["supply_voltage"], fixed=["torque_constant"])
    assert "supply_voltage" in names
    assert "torque_constant" not in names


def test_a_shaft_that_does_not_move_is_refused(nominal):
    time = np.arange(2000) / 500.0
    still = 0.42 + 0.003 * np.random.default_rng(0).standard_normal(time.size)
    recording = Recording("still.mcap", "hall_voltage", time, still, Channel(np.zeros(1), np.zeros(1)))
    with pytest.raises(InputError, match=r"still\.mcap shows no motion to identify from"):
        identify(nominal, [recording])


def test_an_unknown_parameter_is_refused(nominal):
    with pytest.raises(InputError, match="There is no parameter bearing"):
        free_names(nominal, free=["bearing"])


def test_a_parameter_both_free_and_fixed_is_refused(nominal):
    with pytest.raises(InputError, match="Found supply_voltage in --free and in --fix, expected it in one of them"):
        free_names(nominal, free=["supply_voltage"], fixed=["supply_voltage"])
