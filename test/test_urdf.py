"""The URDF of the valve against the actuator's numbers and the topics that move it."""

import math
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.nodes.core.joint import SHAFT

ROBOT = ElementTree.parse(Path(__file__).parent.parent / "urdf" / "valve.urdf").getroot()
JOINT = ROBOT.find("joint")


def value(name):
    """A nominal number of the valve."""
    return read_actuator("pierburg").parameters[name].nominal


def test_it_is_a_tree_of_links_with_one_root():
    links = [link.attrib["name"] for link in ROBOT.findall("link")]
    children = [joint.find("child").attrib["link"] for joint in ROBOT.findall("joint")]
    parents = [joint.find("parent").attrib["link"] for joint in ROBOT.findall("joint")]
    assert len(set(links)) == len(links)
    assert set(children) | set(parents) == set(links)
    assert len(set(links) - set(children)) == 1


def test_the_joint_is_the_one_in_joint_states():
    assert JOINT.attrib["name"] == SHAFT
    assert JOINT.attrib["type"] == "revolute"


def test_ros2_control_commands_the_joint_within_its_range_and_by_the_topics_of_the_nodes():
    control = ROBOT.find("ros2_control")
    topics = {each.attrib["name"]: each.text for each in control.iterfind("hardware/param")}
    assert (topics["joint_commands_topic"], topics["joint_states_topic"]) == ("joint_commands", "joint_states")
    (joint,) = control.findall("joint")
    assert joint.attrib == {"name": JOINT.attrib["name"]}
    limits = {
        each.attrib["name"]: tuple(float(limit.text) for limit in each) for each in joint.findall("command_interface")
    }
    stops = tuple(float(JOINT.find("limit").attrib[name]) for name in ("lower", "upper"))
    assert limits == {"position": stops, "effort": (-1.0, 1.0)}
    states = {each.attrib["name"] for each in joint.findall("state_interface")}
    assert states == {"position", "velocity", *limits}


def test_its_limits_are_the_actuators():
    actuator, limit = read_actuator("pierburg"), JOINT.find("limit").attrib
    motor = value("gear_ratio") * value("torque_constant")
    assert float(limit["lower"]) == actuator.lower_stop
    assert float(limit["upper"]) == pytest.approx(actuator.upper_stop)
    assert float(limit["effort"]) == pytest.approx(
        motor * value("supply_voltage") / value("armature_resistance"), rel=1e-4
    )
    assert float(limit["velocity"]) == pytest.approx(value("supply_voltage") / motor, rel=1e-4)
    dynamics = JOINT.find("dynamics").attrib
    assert float(dynamics["friction"]) == value("coulomb_friction")
    assert float(dynamics["damping"]) == pytest.approx(motor**2 / value("armature_resistance"), rel=1e-3)


def test_every_axis_is_a_unit_vector_and_every_inertia_possible():
    for axis in ROBOT.iter("axis"):
        assert math.hypot(*map(float, axis.attrib["xyz"].split())) == pytest.approx(1.0)
    for inertia in ROBOT.iter("inertia"):
        x, y, z = (float(inertia.attrib[name]) for name in ("ixx", "iyy", "izz"))
        assert x + y >= z and y + z >= x and z + x >= y


def test_materials_that_are_used_are_defined():
    defined = {material.attrib["name"] for material in ROBOT.findall("material")}
    used = {material.attrib["name"] for material in ROBOT.iter("material")}
    assert used == defined
