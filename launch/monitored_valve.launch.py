"""A real valve, or one that another launch file simulates: driver, monitor, and the picture of the valve."""

from pathlib import Path

from launch.actions import DeclareLaunchArgument, OpaqueFunction, SetEnvironmentVariable
from launch.substitutions import EnvironmentVariable, LaunchConfiguration
from launch_ros.actions import Node

from launch import LaunchDescription
from pierburg_ros.nodes.core.joint import SHAFT, joint_name
from pierburg_ros.processes import parameter_arguments

RANGE = "ROS_AUTOMATIC_DISCOVERY_RANGE"
URDF = Path(__file__).parent.parent / "urdf" / "valve.urdf"
"""Beside this folder in the sources as in share/pierburg_ros."""
ARGUMENTS = {
    "namespace": ("", "namespace of all nodes; it also begins the names of the joint and of the frames"),
    "port": ("/dev/ttyACM0", "serial line of the device"),
    "speed": ("921600", "speed of the line [baud]; lines over USB ignore it"),
    "actuator": ("pierburg", "name of the actuator, or path of its description"),
    "model": ("", "model file that the monitor compares with; empty: the actuator as described"),
    "recorder": ("recorder", "node that the monitor asks to split its recording; empty: none"),
}
"""Default and description of each argument but those with choices."""
SWITCH = ["true", "false"]
CHOICES = {
    "driver": (SWITCH, "start the serial driver; false where a plant is simulated"),
    "monitor": (SWITCH, "start the monitor"),
    "picture": (SWITCH, "start robot_state_publisher with the URDF of the valve"),
    "log_level": (["info", "debug", "warn", "error", "fatal"], "least severity that the nodes print"),
}
"""Choices, the first of which is the default, and description of the other arguments."""


def generate_launch_description():
    """The arguments and the nodes that they make; discovery stays on this machine unless told otherwise."""
    declared = [
        DeclareLaunchArgument(name, default_value=default, description=description)
        for name, (default, description) in ARGUMENTS.items()
    ]
    chosen = [
        DeclareLaunchArgument(name, default_value=choices[0], choices=choices, description=description)
        for name, (choices, description) in CHOICES.items()
    ]
    here = SetEnvironmentVariable(RANGE, EnvironmentVariable(RANGE, default_value="LOCALHOST"))
    return LaunchDescription([*declared, *chosen, here, OpaqueFunction(function=nodes)])


def nodes(context):
    """The three nodes, each of which an argument leaves out."""
    given = {name: LaunchConfiguration(name).perform(context) for name in (*ARGUMENTS, *CHOICES)}
    line = {"port": given["port"], "speed": int(given["speed"]), "actuator": given["actuator"]}
    model = {name: given[name] for name in ("actuator", "model", "recorder")}
    chosen = {
        "driver": ("pierburg_ros", "serial_driver", line),
        "monitor": ("pierburg_ros", "monitor", model),
        "picture": ("robot_state_publisher", "robot_state_publisher", picture(given["namespace"])),
    }
    return [
        Node(
            package=package,
            executable=executable,
            name=executable,
            namespace=given["namespace"],
            ros_arguments=["--log-level", given["log_level"], *parameter_arguments(parameters)],
            output="screen",
        )
        for switch, (package, executable, parameters) in chosen.items()
        if given[switch] == "true"
    ]


def picture(namespace):
    """The parameters of the picture: the joint has the name that `joint_states` gives it, as have the frames."""
    joint = joint_name("", namespace)
    urdf = URDF.read_text(encoding="utf-8").replace(f'name="{SHAFT}"', f'name="{joint}"')
    return {"robot_description": urdf, "frame_prefix": joint.removesuffix(SHAFT)}
