"""Every format over every effect: each number of a model is in the file or on the list of what it lacks."""

import json
import math
from dataclasses import replace
from xml.etree import ElementTree

import pytest
from support.acting import ACTING, acting

from pierburg_ros.actuators import read_actuator
from pierburg_ros.effects import EFFECT, EFFECTS
from pierburg_ros.errors import InputError
from pierburg_ros.export import FORMATS, export
from pierburg_ros.plant import Model

NOMINAL = Model.nominal(read_actuator("pierburg"))
RESIDUAL = {"angle": [0.0, 1.0], "velocity": [0.0], "torque": [[0.01], [0.02]]}
HELD = {
    "urdf": {"viscous_friction.coefficient"},
    "sdf": {"viscous_friction.coefficient", "stop_compliance.stiffness", "stop_compliance.damping"},
    "mujoco": {
        *("viscous_friction.coefficient", "stop_compliance.stiffness", "stop_compliance.damping", "input_delay.delay"),
        *("static_friction.breakaway_torque", "static_friction.stribeck_velocity"),
        *("presliding.stiffness", "presliding.damping", "armature_inductance.inductance"),
        *("thermal_resistance.thermal_resistance", "thermal_resistance.heat_capacity"),
        *(f"cogging_torque.{name}" for name in ACTING["cogging_torque"]),
        "nonlinear_spring.cubic_stiffness",
    },
}
"""What each format has a place for: from the reference of MuJoCo's XML, the URDF and the SDF 1.9 specification."""
WITHOUT_EQUATION = {"backlash", "gear_compliance", "sensor_hysteresis"}


def test_every_effect_has_a_strength_here():
    assert list(ACTING) == [effect.id for effect in EFFECTS]


@pytest.mark.parametrize("effect", ACTING)
@pytest.mark.parametrize("to", FORMATS)
def test_each_parameter_is_held_or_listed(to, effect):
    numbers = acting(effect)
    exported = export(NOMINAL.with_values(numbers), to)
    listed = {f"{each.effect}.{each.parameter}": each.value for each in exported.left_out if each.effect}
    if to == "modelica":
        held = set() if effect in WITHOUT_EQUATION else set(numbers)
    else:
        held = set(numbers) & HELD.get(to, set(numbers))
    assert listed == {name: value for name, value in numbers.items() if name not in held}


@pytest.mark.parametrize("effect", ACTING)
@pytest.mark.parametrize("to", FORMATS)
def test_what_is_held_changes_the_file_and_what_is_not_stands_in_it(to, effect):
    exported, bare = export(NOMINAL.with_values(acting(effect)), to), export(NOMINAL, to)
    assert exported.text != bare.text
    for each in exported.left_out:
        assert each.text in exported.text
    for name, value in acting(effect).items():
        changed = export(NOMINAL.with_values({**acting(effect), name: value + (1.0 if "half" in name else 0.01)}), to)
        assert changed.text != exported.text, name


@pytest.mark.parametrize("to", FORMATS)
def test_a_residual_torque_is_held_by_json_alone(to):
    exported = export(NOMINAL.with_residual(RESIDUAL), to)
    assert ("residual_torque" in [each.parameter for each in exported.left_out]) == (to != "json")


@pytest.mark.parametrize("to", FORMATS)
def test_base_parameters_left_out_are_those_the_format_has_no_place_for(to):
    listed = {each.parameter for each in export(NOMINAL, to).left_out}
    hall = {"hall_voltage_closed", "hall_voltage_open"}
    assert listed == {"urdf": {"spring_stiffness", "spring_preload", *hall}, "sdf": hall}.get(to, set())


def test_json_has_every_number_with_unit_and_every_effect_with_its_equation():
    changes = {name: value for effect in ("static_friction", "sensor_lag") for name, value in acting(effect).items()}
    model = NOMINAL.with_values({"armature_resistance": 4.7, **changes}).with_residual(RESIDUAL)
    content = json.loads(export(model, "json").text)
    assert {name: each["value"] for name, each in content["parameters"].items()} == {
        name: model.values[name] for name in model.actuator.parameters
    }
    assert all(each["unit"] and each["origin"] for each in content["parameters"].values())
    assert [each["id"] for each in content["effects"]] == ["static_friction", "sensor_lag"]
    for each in content["effects"]:
        assert each["equation"] == EFFECT[each["id"]].equation
        assert {name: one["value"] for name, one in each["parameters"].items()} == ACTING[each["id"]]
    assert content["residual_torque"]["torque"] == RESIDUAL["torque"]
    assert content["stops"] == {"lower": 0.0, "upper": math.pi / 2, "unit": "rad"}


@pytest.mark.parametrize("to", ["mujoco", "urdf", "sdf"])
@pytest.mark.parametrize("actuator", ["pierburg", "xl330"])
def test_xml_is_well_formed_and_weighs_what_the_shaft_does(to, actuator):
    model = Model.nominal(read_actuator(actuator))
    root = ElementTree.fromstring(export(model, to).text)
    inertial = next(root.iter("inertial"))
    if to == "mujoco":
        mass, own = float(inertial.attrib["mass"]), float(inertial.attrib["diaginertia"].split()[2])
        lever = -float(inertial.attrib["pos"].split()[2])
    elif to == "urdf":
        mass, own = float(inertial.find("mass").attrib["value"]), float(inertial.find("inertia").attrib["izz"])
        lever = -float(inertial.find("origin").attrib["xyz"].split()[2])
    else:
        mass, own = float(inertial.find("mass").text), float(inertial.find("inertia/izz").text)
        lever = -float(inertial.find("pose").text.split()[2])
    assert own + mass * lever**2 == pytest.approx(model.values["total_inertia"], rel=1e-9)
    assert 9.81 * mass * lever == pytest.approx(model.values.get("gravity_torque", 0.0), rel=1e-9)


def test_urdf_and_sdf_have_the_numbers_of_the_urdf_that_is_shipped():
    """Stall torque 2.6766 N.m, no-load speed 16.451 rad/s, back-EMF damping 0.1627 N.m.s/rad: urdf/valve.urdf."""
    joint = ElementTree.fromstring(export(NOMINAL, "urdf").text).find("joint")
    axis = ElementTree.fromstring(export(NOMINAL, "sdf").text).find("model/joint[@type='revolute']/axis")
    expected = {"effort": 2.6766, "velocity": 16.451, "lower": 0.0, "upper": math.pi / 2}
    for name, value in expected.items():
        assert float(joint.find("limit").attrib[name]) == pytest.approx(value, rel=1e-4)
        assert float(axis.find(f"limit/{name}").text) == pytest.approx(value, rel=1e-4)
    for name, value in {"damping": 0.1627, "friction": 0.2007}.items():
        assert float(joint.find("dynamics").attrib[name]) == pytest.approx(value, rel=1e-3)
        assert float(axis.find(f"dynamics/{name}").text) == pytest.approx(value, rel=1e-3)
    assert float(axis.find("dynamics/spring_reference").text) == pytest.approx(-0.29 / 0.1419)


def test_an_unknown_format_is_refused():
    with pytest.raises(InputError, match=r"^There is no format stl; expected mujoco, urdf, sdf, modelica, json\. "):
        export(NOMINAL, "stl")


@pytest.mark.parametrize("to", ["urdf", "json"])
def test_a_linear_actuator_is_written_in_its_own_units(to):
    """A valve that slides is no real one, but has every number."""
    sliding = Model.nominal(replace(NOMINAL.actuator, motion="linear", quantity="position"))
    exported = export(sliding.with_values({"sensor_quantization.step": 0.001}), to)
    if to == "urdf":
        units = {each.parameter: each.unit for each in exported.left_out}
    else:
        content = json.loads(exported.text)
        numbers = {**content["parameters"], **content["effects"][0]["parameters"]}
        units = {name: each["unit"] for name, each in numbers.items()}
    assert [units[name] for name in ("spring_preload", "spring_stiffness", "step")] == ["N", "N/m", "m"]
