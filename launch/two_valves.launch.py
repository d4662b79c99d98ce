"""Two simulated valves side by side, `left` and `right`, each with controller, recorder, monitor and picture."""

from pathlib import Path

from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription, OpaqueFunction
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration

from launch import LaunchDescription

SIDES = ("left", "right")
"""Namespaces of the two."""
ARGUMENTS = {
    "output": ("recordings", "folder in which the recordings of each valve have a folder of their own"),
    "picture": ("true", "start robot_state_publisher with the URDF of each valve: true or false"),
}
"""Default and description of each argument."""


def generate_launch_description():
    """The arguments, and what they make."""
    declared = [
        DeclareLaunchArgument(name, default_value=default, description=description)
        for name, (default, description) in ARGUMENTS.items()
    ]
    return LaunchDescription([*declared, OpaqueFunction(function=valves)])


def valves(context):
    """The loop of each side, and what watches it."""
    given = {name: LaunchConfiguration(name).perform(context) for name in ARGUMENTS}
    return [each for side in SIDES for each in valve(side, given)]


def valve(side, given):
    """One valve in the namespace of its side."""
    return [
        included("closed_loop", namespace=side, output=f"{given['output']}/{side}/"),
        included("monitored_valve", namespace=side, driver="false", picture=given["picture"]),
    ]


def included(name, **arguments):
    """A launch file of this folder with all that it needs to be told."""
    source = PythonLaunchDescriptionSource(str(Path(__file__).parent / f"{name}.launch.py"))
    return IncludeLaunchDescription(source, launch_arguments=arguments.items())
