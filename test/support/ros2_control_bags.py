"""A bag of a robot under ros2_control: an arm of two joints, its controllers and broadcasters, with their types."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

POINT = "trajectory_msgs/JointTrajectoryPoint"
TRANSFORMS = "trajectory_msgs/MultiDOFJointTrajectoryPoint"
PARTS = ("reference", "feedback", "error", "output")
DEFINITIONS = {
    "control_msgs/msg/JointTrajectoryControllerState": "std_msgs/Header header\nstring[] joint_names\n"
    + "".join(f"{POINT} {part}\n" for part in PARTS)
    + "string[] multi_dof_joint_names\n"
    + "".join(f"{TRANSFORMS} multi_dof_{part}\n" for part in PARTS)
    + "float64 speed_scaling_factor\n",
    "control_msgs/msg/DynamicJointState": "std_msgs/Header header\nstring[] joint_names\n"
    "control_msgs/InterfaceValue[] interface_values\n",
    "control_msgs/msg/InterfaceValue": "string[] interface_names\nfloat64[] values\n",
    "control_msgs/msg/MultiDOFStateStamped": "std_msgs/Header header\ncontrol_msgs/SingleDOFState[] dof_states\n",
    "control_msgs/msg/SingleDOFState": "string name\nfloat64 reference\nfloat64 feedback\nfloat64 feedback_dot\n"
    "float64 error\nfloat64 error_dot\nfloat64 time_step\nfloat64 output\n",
}


def control_types():
    """A store of the types of ROS and of ros2_control."""
    store = get_typestore(Stores.ROS2_JAZZY)
    types: dict[str, Any] = {}
    for name, text in DEFINITIONS.items():
        types.update(get_types_from_msg(text, name))
    store.register(types)
    return store


STORE = control_types()
T = STORE.types
RATE = 100.0
NAMES = {"joint_states": ["shoulder", "elbow"], "controller": ["elbow", "shoulder"]}
"""The order of the joints is not the same everywhere."""


def motion(count: int = 500) -> dict[str, dict[str, np.ndarray]]:
    """What each joint does: wanted and measured angle [rad], speed [rad/s], torque [N.m] commanded and measured."""
    time = np.arange(count) / RATE
    found = {}
    for joint, size, pace in (("elbow", 1.2, 2.0), ("shoulder", 0.2, 3.1)):
        found[joint] = {
            "reference": size * np.sin(pace * time),
            "position": size * np.sin(pace * (time - 0.05)),
            "velocity": size * pace * np.cos(pace * (time - 0.05)),
            "command": 3.0 * size * np.cos(pace * time + 0.4),
            "effort": 3.0 * size * np.cos(pace * (time - 0.01) + 0.4),
        }
    return found


def header(seconds: float) -> Any:
    """std_msgs/Header."""
    nanoseconds = round(seconds * 1e9)
    return T["std_msgs/msg/Header"](T["builtin_interfaces/msg/Time"](nanoseconds // 10**9, nanoseconds % 10**9), "")


def joint_states(time: float, now: dict[str, dict[str, float]]) -> Any:
    """sensor_msgs/JointState."""
    names = NAMES["joint_states"]
    arrays = (np.array([now[name][part] for name in names]) for part in ("position", "velocity", "effort"))
    return T["sensor_msgs/msg/JointState"](header(time), names, *arrays)


def dynamic_joint_states(time: float, now: dict[str, dict[str, float]]) -> Any:
    """control_msgs/DynamicJointState."""
    parts = ["effort", "position", "velocity"]
    values = [
        T["control_msgs/msg/InterfaceValue"](parts, np.array([now[name][part] for part in parts]))
        for name in NAMES["controller"]
    ]
    return T["control_msgs/msg/DynamicJointState"](header(time), NAMES["controller"], values)


def point(**arrays: Any) -> Any:
    """trajectory_msgs/JointTrajectoryPoint."""
    filled = {name: arrays.get(name, np.zeros(0)) for name in ("positions", "velocities", "accelerations", "effort")}
    return T["trajectory_msgs/msg/JointTrajectoryPoint"](
        *filled.values(), T["builtin_interfaces/msg/Duration"](0, 1000)
    )


def trajectory_state(time: float, now: dict[str, dict[str, float]]) -> Any:
    """control_msgs/JointTrajectoryControllerState of a controller that commands efforts."""
    names = NAMES["controller"]
    of = {part: np.array([now[name][part] for name in names]) for part in now["elbow"]}
    none = T["trajectory_msgs/msg/MultiDOFJointTrajectoryPoint"]([], [], [], T["builtin_interfaces/msg/Duration"](0, 0))
    return T["control_msgs/msg/JointTrajectoryControllerState"](
        header(time),
        names,
        point(positions=of["reference"], velocities=0.3 * of["velocity"], accelerations=0.1 * of["velocity"]),
        point(positions=of["position"], velocities=of["velocity"]),
        point(positions=of["reference"] - of["position"]),
        point(effort=of["command"]),
        [],
        *4 * [none],
        1.0,
    )


def pid_state(time: float, now: dict[str, dict[str, float]]) -> Any:
    """control_msgs/MultiDOFStateStamped."""
    states = [
        T["control_msgs/msg/SingleDOFState"](
            name,
            now[name]["reference"],
            now[name]["position"],
            now[name]["velocity"],
            now[name]["reference"] - now[name]["position"],
            0.0,
            1.0 / RATE,
            now[name]["command"],
        )
        for name in NAMES["controller"]
    ]
    return T["control_msgs/msg/MultiDOFStateStamped"](header(time), states)


def commands(part: str) -> Any:
    """What makes std_msgs/Float64MultiArray of one part of the motion, without names."""
    layout = T["std_msgs/msg/MultiArrayLayout"]([], 0)

    def make(_: float, now: dict[str, dict[str, float]]) -> Any:
        values = np.array([now[name][part] for name in NAMES["controller"]])
        return T["std_msgs/msg/Float64MultiArray"](layout, values)

    return make


ARRAY = "std_msgs/msg/Float64MultiArray"
TOPICS = {
    "/joint_states": ("sensor_msgs/msg/JointState", joint_states),
    "/dynamic_joint_states": ("control_msgs/msg/DynamicJointState", dynamic_joint_states),
    "/arm_controller/controller_state": ("control_msgs/msg/JointTrajectoryControllerState", trajectory_state),
    "/pid_controller/controller_state": ("control_msgs/msg/MultiDOFStateStamped", pid_state),
    "/controller/commands": (ARRAY, commands("command")),
    "/forward_position_controller/commands": (ARRAY, commands("reference")),
}


def write_arm(folder: Path, *topics: str, plugin: StoragePlugin = StoragePlugin.MCAP) -> Path:
    """A rosbag2 directory with some of the arm's topics, from 1000 s on."""
    moves = motion()
    with Writer(folder, version=9, storage_plugin=plugin) as writer:
        connections = {topic: writer.add_connection(topic, TOPICS[topic][0], typestore=STORE) for topic in topics}
        for k in range(len(moves["elbow"]["position"])):
            time = 1000.0 + k / RATE
            now = {joint: {part: float(values[k]) for part, values in of.items()} for joint, of in moves.items()}
            for topic in topics:
                kind, make = TOPICS[topic]
                writer.write(connections[topic], round(time * 1e9), STORE.serialize_cdr(make(time, now), kind))
    return folder
