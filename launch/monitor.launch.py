"""The monitor alone, beside a running actuator, simulated or real."""

from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

from launch import LaunchDescription
from pierburg_ros.processes import parameter_arguments

ARGUMENTS = {
    "namespace": ("", "namespace in which the actuator's topics are"),
    "actuator": ("pierburg", "what runs: the name of an actuator, or the path of its description"),
    "model": ("", "model file that the monitor compares with; none: the actuator as described"),
    "joint": ("", "name of the joint in joint_states; none: swirl_shaft, with the namespace before it"),
    "recorder": ("recorder", "node that is asked to split its recording at a finding; empty: none"),
}
"""Default and description of each argument but those with choices."""
CHOICES = {
    "angle": (["joint_states", "hall_voltage"], "topic of the sensor; joint_states says when a sample was taken"),
    "duty": (["applied_duty", "duty"], "topic of the duty; applied_duty is what the actuator really obeyed"),
    "simulated_time": (["false", "true"], "whether time comes from /clock, as with a plant in simulated time"),
    "log_level": (["info", "debug", "warn", "error", "fatal"], "least severity that the node prints"),
}
"""Choices, the first of which is the default, and description of the other arguments."""


def generate_launch_description():
    """The arguments, and the node that they make."""
    declared = [
        DeclareLaunchArgument(name, default_value=default, description=description)
        for name, (default, description) in ARGUMENTS.items()
    ]
    chosen = [
        DeclareLaunchArgument(name, default_value=choices[0], choices=choices, description=description)
        for name, (choices, description) in CHOICES.items()
    ]
    return LaunchDescription([*declared, *chosen, OpaqueFunction(function=nodes)])


def nodes(context):
    """The monitor with the parameters that the arguments stand for."""
    given = {name: LaunchConfiguration(name).perform(context) for name in (*ARGUMENTS, *CHOICES)}
    parameters = {
        **{name: given[name] for name in ("actuator", "model", "joint", "recorder")},
        "angle_topic": given["angle"],
        "duty_topic": given["duty"],
        "use_sim_time": given["simulated_time"] == "true",
    }
    return [
        Node(
            package="pierburg_ros",
            executable="monitor",
            name="monitor",
            namespace=given["namespace"],
            ros_arguments=["--log-level", given["log_level"], *parameter_arguments(parameters)],
            output="screen",
        )
    ]
