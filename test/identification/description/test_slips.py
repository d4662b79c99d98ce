"""A slip of unit or sign in one number of a description stands out, and shipped descriptions hold none."""

from dataclasses import replace

import pytest

from pierburg_ros.actuators import SHIPPED, read_actuator
from pierburg_ros.identification.description.derived import derived
from pierburg_ros.identification.description.slips import remarks

VALVE = read_actuator("pierburg")


def with_number(name, value):
    parameter = VALVE.parameters[name]
    ends = min(parameter.minimum, value), max(parameter.maximum, value)
    changed = replace(parameter, default=value, minimum=ends[0] - 1e-9, maximum=ends[1] * 1.01)
    return replace(VALVE, parameters={**VALVE.parameters, name: changed})


@pytest.mark.parametrize("name", SHIPPED)
def test_shipped_descriptions_are_plausible(name):
    assert remarks(read_actuator(name)) == []


def test_derives_what_the_papers_numbers_imply():
    found = {each.name: each.value for each in derived(VALVE)}
    per_current = 37.3 * 0.022
    assert found["no-load speed"] == pytest.approx(13.5 / per_current)
    assert found["stall torque"] == pytest.approx(13.5 * per_current / 4.139)
    needed = 0.29 + 0.1419 * 1.5707963 + 0.2007
    assert found["stall torque over load and friction"] == pytest.approx(found["stall torque"] / needed)


@pytest.mark.parametrize(
    ("name", "factor"),
    [
        ("armature_resistance", 1e3),
        ("armature_resistance", 1e-3),
        ("torque_constant", 1e3),
        ("spring_preload", 1e3),
        ("spring_stiffness", 57.295779513),
        ("coulomb_friction", 1e3),
        ("total_inertia", 1e7),
        ("supply_voltage", 1e3),
        ("supply_voltage", 1e-3),
    ],
)
def test_names_the_number_in_another_unit(name, factor):
    right = VALVE.parameters[name].nominal
    said = [remark.what for remark in remarks(with_number(name, factor * right)) if remark.about == name]
    assert any(f"with {right:.4g} all is plausible" in what for what in said), said


def test_names_a_negative_magnitude_and_a_reversed_sensor():
    assert any(remark.about == "spring_stiffness" for remark in remarks(with_number("spring_stiffness", -0.1)))
    assert any(remark.about == "hall_voltage_open" for remark in remarks(with_number("hall_voltage_open", 0.1)))


def test_stops_in_degrees_stand_out():
    (travel,) = [remark for remark in remarks(replace(VALVE, upper_stop=90.0)) if remark.about == "travel"]
    assert "90 rad" in travel.what
