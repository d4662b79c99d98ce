"""A recording against a model, and the result in PlotJuggler if that is wanted."""

from pathlib import Path

from launch.actions import DeclareLaunchArgument, ExecuteProcess, OpaqueFunction, RegisterEventHandler
from launch.event_handlers import OnProcessExit
from launch.substitutions import LaunchConfiguration
from launch_ros.substitutions import ExecutableInPackage, FindPackageShare

from launch import LaunchDescription

RECORDING = "recording to simulate again: MCAP, rosbag2 directory or CSV"
ARGUMENTS = {
    "actuator": ("pierburg", "what was recorded: the name of an actuator, or the path of its description"),
    "model": ("", "model file to simulate with; none: the actuator as described"),
    "signals": ("", "signal map, where topics or columns are not called as usual; none: by their names"),
    "output": ("replayed", "folder for the results"),
}
"""Default and description of each argument that has a default."""
VIEWERS = ["none", "plotjuggler"]
VIEWER = "what opens the result once it is there: plotjuggler, if it is installed, or none"


def generate_launch_description():
    """The arguments, and the processes that they make."""
    declared = [
        DeclareLaunchArgument(name, default_value=default, description=description)
        for name, (default, description) in ARGUMENTS.items()
    ]
    recording = DeclareLaunchArgument("recording", description=RECORDING)
    viewer = DeclareLaunchArgument("viewer", default_value=VIEWERS[0], choices=VIEWERS, description=VIEWER)
    return LaunchDescription([recording, *declared, viewer, OpaqueFunction(function=processes)])


def processes(context):
    """The replay, and what opens its result where it gave one."""
    given = {name: LaunchConfiguration(name).perform(context) for name in ("recording", *ARGUMENTS, "viewer")}
    named = ["--model", given["model"]] if given["model"] else ["--actuator", given["actuator"]]
    signals = ["--signals", given["signals"]] if given["signals"] else []
    command = [given["recording"], *named, *signals, "--output", given["output"]]
    replay = ExecuteProcess(cmd=[ExecutableInPackage("replay", "pierburg_ros"), *command], output="screen")
    if given["viewer"] == "none":
        return [replay]
    layout = Path(FindPackageShare("pierburg_ros").perform(context)) / "layouts" / f"{given['viewer']}_replay.xml"
    opened = ["--datafile", str(Path(given["output"]) / "replay.mcap"), "--layout", str(layout)]

    def view(event, _):
        shown = ExecuteProcess(cmd=[ExecutableInPackage("plotjuggler", "plotjuggler"), *opened], output="screen")
        return [shown] if event.returncode == 0 else []

    return [replay, RegisterEventHandler(OnProcessExit(target_action=replay, on_exit=view))]
