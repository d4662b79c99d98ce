"""Recordings as a foreign writer leaves them: encoded by rosbags, framed by the mcap library."""

from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

import numpy as np
from mcap.writer import Writer
from rosbags.typesys import Stores, get_typestore

TYPES = get_typestore(Stores.ROS2_JAZZY)
NAMES = {
    "float": "std_msgs/msg/Float64",
    "bool": "std_msgs/msg/Bool",
    "clock": "rosgraph_msgs/msg/Clock",
    "joint": "sensor_msgs/msg/JointState",
    "text": "std_msgs/msg/String",
}


class Message(NamedTuple):
    """One message: times [s], and a value or, for a joint, (stamp [s], position [rad])."""

    topic: str
    kind: str
    log: float
    publish: float
    sequence: int
    value: object


def time_of(seconds: float) -> object:
    """builtin_interfaces/Time of `seconds`."""
    nanoseconds = round(seconds * 1e9)
    return TYPES.types["builtin_interfaces/msg/Time"](nanoseconds // 10**9, nanoseconds % 10**9)


def joint_state(stamp: float, positions: dict[str, float]) -> object:
    """sensor_msgs/JointState of the named joints, with velocities that nobody may read."""
    header = TYPES.types["std_msgs/msg/Header"](time_of(stamp), "a frame")
    values = np.array(list(positions.values()))
    return TYPES.types[NAMES["joint"]](header, list(positions), values, values * 1e6, np.zeros(0))


def encode(kind: str, value: object) -> bytes:
    """CDR of one value."""
    if kind == "joint":
        stamp, position = value
        message = joint_state(stamp, position if isinstance(position, dict) else {"swirl_shaft": position})
    elif kind == "clock":
        message = TYPES.types[NAMES[kind]](time_of(value))
    else:
        message = TYPES.types[NAMES[kind]](value)
    return bytes(TYPES.serialize_cdr(message, NAMES[kind]))


def write_mcap(path: Path, messages: Iterable[Message], chunk_size: int, empty: dict[str, str]) -> Path:
    """Write `messages` in their order; `empty` topics are declared and stay without messages."""
    with path.open("wb") as stream:
        writer = Writer(stream, chunk_size=chunk_size)
        writer.start(profile="ros2", library="test")
        schemas: dict[str, int] = {}
        channels: dict[str, int] = {}

        def channel(topic: str, kind: str) -> int:
            if kind not in schemas:
                definition = TYPES.generate_msgdef(NAMES[kind], ros_version=2)[0]
                schemas[kind] = writer.register_schema(NAMES[kind], "ros2msg", definition.encode())
            if topic not in channels:
                channels[topic] = writer.register_channel(topic, "cdr", schemas[kind])
            return channels[topic]

        for topic, kind in empty.items():
            channel(topic, kind)
        for item in messages:
            writer.add_message(
                channel(item.topic, item.kind),
                round(item.log * 1e9),
                encode(item.kind, item.value),
                round(item.publish * 1e9),
                item.sequence,
            )
        writer.finish()
    return path
