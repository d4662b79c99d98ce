"""Plant, controller and recorder as one graph, in a namespace of their own if one is named."""

from pathlib import Path

from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare

from launch import LaunchDescription

ARGUMENTS = {
    "namespace": ("", "namespace of the three nodes; it also begins the name of the joint"),
    "actuator": ("pierburg", "what is simulated: the name of an actuator, or the path of its description"),
    "model": ("", "model file with other values and effects for the plant; none: the actuator's nominal ones"),
    "setpoint": ("0.0", "wanted angle at the start [rad]"),
    "output": ("recordings/", "file (.mcap) or folder of the recording; in a folder the name is the time"),
    "record": ("true", "whether the recorder runs"),
    "log_level": ("info", "least severity that the nodes print: debug, info, warn, error or fatal"),
    "config": (
        "",
        "folder with plant.yaml, controller.yaml and recorder.yaml; none: the package's own. The other arguments win",
    ),
}
"""Default and description of each argument but `time`."""
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
TIME = (
    "wall: the computer's clock; simulated: the plant makes the time, at its pace; lockstep: it also waits for each"
    " duty, as fast as they come, repeatable to the bit"
)


def generate_launch_description():
    """The arguments, and the nodes that they make."""
    declared = [
        DeclareLaunchArgument(name, default_value=default, description=description)
        for name, (default, description) in ARGUMENTS.items()
    ]
    time = DeclareLaunchArgument("time", default_value="wall", choices=list(TIMES), description=TIME)
    return LaunchDescription([*declared, time, OpaqueFunction(function=nodes)])


def nodes(context):
    """The three nodes, or two of them, with the parameters that the arguments stand for."""
    given = {name: LaunchConfiguration(name).perform(context) for name in (*ARGUMENTS, "time")}
    config = Path(given["config"] or Path(FindPackageShare("pierburg_ros").perform(context)) / "config")
    plant, controller, recorder = TIMES[given["time"]]
    chosen = {
        "plant": {**plant, "actuator": given["actuator"], "model": given["model"]},
        "controller": {**controller, "setpoint": float(given["setpoint"])},
        "recorder": {**recorder, "output": given["output"]},
    }
    if given["record"].lower() not in ("true", "1"):
        del chosen["recorder"]
    return [
        Node(
            package="pierburg_ros",
            executable=name,
            name=name,
            namespace=given["namespace"],
            parameters=[str(config / f"{name}.yaml"), parameters],
            ros_arguments=["--log-level", given["log_level"]],
            output="screen",
        )
        for name, parameters in chosen.items()
    ]
