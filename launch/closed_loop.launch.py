"""Plant, controller and recorder as one graph, in a namespace of their own if one is named."""

from pathlib import Path

from launch.actions import DeclareLaunchArgument, OpaqueFunction, Shutdown
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare

from launch import LaunchDescription
from pierburg_ros.processes import parameter_arguments

ARGUMENTS = {
    "namespace": ("", "namespace of the three nodes; it also begins the name of the joint"),
    "actuator": ("pierburg", "what is simulated: the name of an actuator, or the path of its description"),
    "model": ("", "model file with other values and effects for the plant; none: the actuator's nominal ones"),
    "setpoint": ("0.0", "wanted angle at the start [rad]"),
    "output": ("recordings/", "file (.mcap) or folder of the recording; in a folder the name is the time"),
    "config": (
        "",
        "folder with plant.yaml, controller.yaml and recorder.yaml; none: the package's own. The other arguments win",
    ),
}
"""Default and description of each argument but those with choices."""
CHOICES = {
    "record": (["true", "false"], "whether the recorder runs"),
    "time": (
        ["wall", "simulated", "lockstep"],
        "wall: the computer's clock; simulated: the plant makes the time, at its pace; lockstep: it also waits for each"
        " duty, as fast as they come, repeatable to the bit",
    ),
    "on_exit": (
        ["shutdown", "respawn", "ignore"],
        "what follows when plant or controller ends: the launch ends too, the node is started again, or nothing",
    ),
    "log_level": (["info", "debug", "warn", "error", "fatal"], "least severity that the nodes print"),
}
"""Choices, the first of which is the default, and description of the other arguments."""
SIMULATED = {"use_sim_time": True}
TIMES = {
    "wall": ({"simulated_time": False, "lockstep": False}, {"use_sim_time": False}, {"use_sim_time": False}),
    "simulated": ({"simulated_time": True, "lockstep": False}, SIMULATED, SIMULATED),
    "lockstep": (
        {"simulated_time": True, "lockstep": True, "time_factor": 0.0},
        {**SIMULATED, "hall_timeout": 0.0},
        SIMULATED,
    ),
}
"""Parameters of plant, controller and recorder for each kind of time."""


def generate_launch_description():
    """The arguments, and the nodes that they make."""
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
    """The three nodes, or two of them, with the parameters that the arguments stand for."""
    given = {name: LaunchConfiguration(name).perform(context) for name in (*ARGUMENTS, *CHOICES)}
    config = Path(given["config"] or Path(FindPackageShare("pierburg_ros").perform(context)) / "config")
    plant, controller, recorder = TIMES[given["time"]]
    chosen = {
        "plant": {**plant, "actuator": given["actuator"], "model": given["model"]},
        "controller": {**controller, "setpoint": number("setpoint", given["setpoint"])},
        "recorder": {**recorder, "output": given["output"]},
    }
    if given["record"] == "false":
        del chosen["recorder"]
    return [node(name, parameters, config, given) for name, parameters in chosen.items()]


def node(name, parameters, config, given):
    """A node with the file of its name in `config`, and these parameters, each of the type that it has here."""
    ends = {"shutdown": {"on_exit": Shutdown(reason=f"{name} ended")}, "respawn": {"respawn": True}, "ignore": {}}
    own = parameter_arguments(parameters)
    return Node(
        package="pierburg_ros",
        executable=name,
        name=name,
        namespace=given["namespace"],
        ros_arguments=["--log-level", given["log_level"], "--params-file", str(config / f"{name}.yaml"), *own],
        output="screen",
        respawn_delay=1.0,
        **({} if name == "recorder" else ends[given["on_exit"]]),
    )


def number(name, text):
    """The number in an argument; ValueError where it is none."""
    try:
        return float(text)
    except ValueError as error:
        raise ValueError(f"{name} is {text!r}; expected a number, as in {name}:=0.785.") from error
