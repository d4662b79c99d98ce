"""Plant, controller and recorder as one graph."""

from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare

from launch import LaunchDescription

CONFIG = PathJoinSubstitution([FindPackageShare("pierburg_ros"), "config"])


def generate_launch_description():
    """Three nodes with the package's parameter files; any of the files can be replaced by an argument."""
    simulated_time = LaunchConfiguration("simulated_time")
    return LaunchDescription(
        [
            DeclareLaunchArgument("plant", default_value=PathJoinSubstitution([CONFIG, "plant.yaml"])),
            DeclareLaunchArgument("controller", default_value=PathJoinSubstitution([CONFIG, "controller.yaml"])),
            DeclareLaunchArgument("recorder", default_value=PathJoinSubstitution([CONFIG, "recorder.yaml"])),
            DeclareLaunchArgument("simulated_time", default_value="false"),
            DeclareLaunchArgument("record", default_value="true"),
            Node(
                package="pierburg_ros",
                executable="plant",
                name="plant",
                parameters=[LaunchConfiguration("plant"), {"simulated_time": simulated_time}],
            ),
            Node(
                package="pierburg_ros",
                executable="controller",
                name="controller",
                parameters=[LaunchConfiguration("controller"), {"use_sim_time": simulated_time}],
            ),
            Node(
                package="pierburg_ros",
                executable="recorder",
                name="recorder",
                parameters=[LaunchConfiguration("recorder"), {"use_sim_time": simulated_time}],
                condition=IfCondition(LaunchConfiguration("record")),
            ),
        ]
    )
