"""A real valve, or one that another launch file simulates: driver, monitor, and the picture of the valve."""

from pathlib import Path

from launch.actions import DeclareLaunchArgument, SetEnvironmentVariable
from launch.conditions import IfCondition
from launch.substitutions import EnvironmentVariable, LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue

from launch import LaunchDescription

RANGE = "ROS_AUTOMATIC_DISCOVERY_RANGE"
URDF = Path(__file__).parent.parent / "urdf" / "valve.urdf"
"""Beside this folder in the sources as in share/pierburg_ros."""
ARGUMENTS = {
    "namespace": ("", "namespace of all nodes"),
    "port": ("/dev/ttyACM0", "serial line of the device"),
    "speed": ("921600", "speed of the line [baud]; lines over USB ignore it"),
    "actuator": ("pierburg", "name of the actuator, or path of its description"),
    "model": ("", "model file that the monitor compares with; empty: the actuator as described"),
    "recorder": ("recorder", "node that the monitor asks to split its recording; empty: none"),
    "driver": ("true", "start the serial driver; false where a plant is simulated"),
    "monitor": ("true", "start the monitor"),
    "picture": ("true", "start robot_state_publisher with the URDF of the valve"),
    "log_level": ("info", "lowest level that is logged: debug, info, warn, error"),
}


def generate_launch_description():
    """The three nodes, each of which an argument leaves out; discovery stays on this machine unless told otherwise."""
    given = {name: LaunchConfiguration(name) for name in ARGUMENTS}
    common = {"namespace": given["namespace"], "arguments": ["--ros-args", "--log-level", given["log_level"]]}
    return LaunchDescription(
        [
            *(
                DeclareLaunchArgument(name, default_value=default, description=description)
                for name, (default, description) in ARGUMENTS.items()
            ),
            SetEnvironmentVariable(RANGE, EnvironmentVariable(RANGE, default_value="LOCALHOST")),
            Node(
                package="pierburg_ros",
                executable="serial_driver",
                name="serial_driver",
                parameters=[{name: given[name] for name in ("port", "speed", "actuator")}],
                condition=IfCondition(given["driver"]),
                **common,
            ),
            Node(
                package="pierburg_ros",
                executable="monitor",
                name="monitor",
                parameters=[{name: given[name] for name in ("actuator", "model", "recorder")}],
                condition=IfCondition(given["monitor"]),
                **common,
            ),
            Node(
                package="robot_state_publisher",
                executable="robot_state_publisher",
                name="robot_state_publisher",
                parameters=[{"robot_description": ParameterValue(URDF.read_text(encoding="utf-8"), value_type=str)}],
                condition=IfCondition(given["picture"]),
                **common,
            ),
        ]
    )
