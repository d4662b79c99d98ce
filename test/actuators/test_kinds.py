"""Descriptions of every kind of actuator: what each needs, what means nothing in it, and its units."""

from __future__ import annotations

from typing import Any

import pytest

from pierburg_ros.actuators import SHIPPED, actuator_of, read_actuator
from pierburg_ros.actuators.gauge import in_ratio
from pierburg_ros.actuators.units import LINEAR, unit_of
from pierburg_ros.actuators.values import check
from pierburg_ros.actuators.wording import input_title, place
from pierburg_ros.effects import DECLARED, EFFECT
from pierburg_ros.errors import InputError


def number(nominal: float, **more: Any) -> dict[str, Any]:
    return {"nominal": nominal, "minimum": 1e-6, "maximum": 100.0, "origin": "test", **more}


AXIS: dict[str, Any] = {
    "name": "axis",
    "drive": "current",
    "load": "spring",
    "sensor": "position",
    "motion": "linear",
    "joint": "slide",
    "stops": {"lower": 0.0, "upper": 0.05},
    "winding": {"rated_current": 2.0, "time_constant": 20.0, "origin": "data sheet"},
    "parameters": {
        "gear_ratio": number(50.0),
        "torque_constant": number(0.02),
        "spring_stiffness": number(0.0, minimum=0.0),
        "spring_preload": number(3.0),
        "coulomb_friction": number(1.0),
        "total_inertia": number(0.5, free=False, fixed_by="weighed"),
    },
}


def changed(**changes: Any) -> dict[str, Any]:
    return {**AXIS, **changes}


def without(name: str, **more: Any) -> dict[str, Any]:
    return {key: value for key, value in AXIS["parameters"].items() if key != name} | more


def test_a_linear_current_driven_axis_is_read() -> None:
    axis = actuator_of(AXIS, "axis.yaml")
    assert (axis.input, axis.unit, axis.joint, axis.has_stops) == ("current", "m", "slide", True)
    assert axis.winding is not None and axis.winding.rated_current == 2.0
    assert axis.parameters["total_inertia"].fixed_by == "weighed"
    assert {name: axis.shown(p.unit) for name, p in axis.parameters.items()} == {
        "sensor_scale": "1",
        "sensor_offset": "m",
        "gear_ratio": "1",
        "torque_constant": "N.m/A",
        "spring_stiffness": "N/m",
        "spring_preload": "N",
        "coulomb_friction": "N",
        "total_inertia": "kg",
    }


@pytest.mark.parametrize(
    ("description", "why"),
    (
        (changed(parameters=without("torque_constant")), "parameters lacks torque_constant, needed with drive current"),
        (
            changed(parameters=without("", supply_voltage=number(12.0))),
            "has supply_voltage, without meaning",
        ),
        (changed(parameters=without("", hall_voltage_open=number(4.0))), "has hall_voltage_open, without meaning"),
        (changed(drive="hydraulic"), "drive: Input should be 'voltage', 'current' or 'torque'"),
        (changed(drive="torque"), "parameters has gear_ratio, torque_constant, without meaning with drive torque"),
        (changed(load="none"), "parameters has spring_preload, spring_stiffness, without meaning"),
        (changed(motion="sideways"), "motion: Input should be 'rotary' or 'linear'"),
        (changed(winding={"rated_current": -1.0, "time_constant": 1.0, "origin": "x"}), "winding.rated_current"),
    ),
)
def test_what_does_not_fit_together_is_refused(description: dict[str, Any], why: str) -> None:
    with pytest.raises(InputError) as refused:
        actuator_of(description, "axis.yaml")
    assert why in str(refused.value) and "\n" not in str(refused.value)


def test_a_sensor_of_angle_or_speed_may_be_off_and_a_hall_sensor_has_its_ends() -> None:
    axis = actuator_of(AXIS, "axis")
    assert {"sensor_scale", "sensor_offset"} <= set(axis.free)
    valve = read_actuator("pierburg")
    assert not {"sensor_scale", "sensor_offset", "hall_voltage_open"} & set(valve.free)


@pytest.mark.parametrize("name", SHIPPED)
def test_every_number_of_a_shipped_actuator_has_its_origin(name: str) -> None:
    actuator = read_actuator(name)
    assert all(p.origin for p in actuator.parameters.values())
    assert actuator.description is None


def test_the_shipped_rotor_says_what_its_recordings_cannot_tell() -> None:
    rotor, pendulum = read_actuator("odrive"), read_actuator("ak80")
    assert "torque_constant" not in rotor.free and "ratio" in rotor.parameters["torque_constant"].fixed_by
    assert "gravity_torque" not in pendulum.free and "torque_scale" in pendulum.free


def test_every_unit_with_an_angle_or_a_torque_at_the_output_has_a_linear_one() -> None:
    units = {p.unit for p in DECLARED.values()} | {p.unit for p in actuator_of(AXIS, "axis").parameters.values()}
    turning = {unit for unit in units if "rad" in unit or "N.m" in unit or "m^2" in unit} - {"N.m/A"}
    assert turning <= set(LINEAR)
    assert unit_of("N.m.s/rad", "linear") == "N.s/m" and unit_of("N.m.s/rad", "rotary") == "N.m.s/rad"


def test_people_read_a_linear_axis_in_millimetres_and_newtons() -> None:
    assert place(0.0, 0.0123, "linear") == "0 to 12.3 mm" and place(0.7, 0.7, "rotary") == "40 degrees"
    assert input_title("torque", "linear") == "force [N]" and input_title("current", "linear") == "current [A]"
    assert input_title("duty", "rotary") == "duty [%]"


@pytest.mark.parametrize(
    ("actuator", "cannot"),
    (
        ("pierburg", set()),
        ("xl330", {"nonlinear_spring", "stop_compliance", "sensor_nonlinearity"}),
        (
            "odrive",
            {
                "pwm_deadband",
                "supply_sag",
                "thermal_resistance",
                "armature_inductance",
                "nonlinear_spring",
                "stop_compliance",
                "sensor_nonlinearity",
            },
        ),
    ),
)
def test_what_an_actuator_cannot_have(actuator: str, cannot: set[str]) -> None:
    kind = read_actuator(actuator)
    assert {effect.id for effect in EFFECT.values() if kind.obstacle(effect)} == cannot


def test_the_size_of_all_torques_is_told_by_no_torque_and_motion():
    assert in_ratio(read_actuator("ak80"), "torque_scale") == ("gravity_torque",)
    assert in_ratio(read_actuator("ak80"), "total_inertia") == ()
    assert (
        in_ratio(read_actuator("odrive"), "torque_constant")
        == in_ratio(read_actuator("pierburg"), "torque_scale")
        == ()
    )


def test_a_step_has_the_unit_of_what_is_measured_and_a_wave_has_an_angle_for_its_phase() -> None:
    steps = {name: read_actuator(name).unit_of("sensor_quantization.step") for name in SHIPPED}
    assert steps == {"pierburg": "V", "xl330": "rad", "ak80": "rad", "odrive": "rad"}
    axis = actuator_of(AXIS, "axis")
    names = ("sensor_quantization.step", "cogging_torque.phase", "cogging_torque.amplitude", "spring_preload")
    assert [axis.unit_of(name) for name in names] == ["m", "rad", "N", "N"]
    with pytest.raises(InputError, match=r"lacks step \[m\]"):
        actuator_of(changed(effects={"sensor_quantization": {}}), "axis")
    with pytest.raises(InputError, match=r"to 1e\+09 m\."):
        check(axis, "sensor_quantization.step", -1.0)
