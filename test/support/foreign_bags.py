"""Bags of message types that are not of ROS, as a bench of one's own records them, with their definitions."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

DEFINITIONS = {
    "bench/msg/Command": "std_msgs/Header header\nuint64 micros\nbench/Pwm pwm\n",
    "bench/msg/Pwm": "float32[4] data\nbool on\n",
    "bench/msg/Board": "bench/Channel[] channels\nstring note\nint16 counts\n",
    "bench/msg/DynamicState": "string[] frames\nstring[] joint_names\nbench/Interfaces[] interface_values\n",
    "bench/msg/Interfaces": "string[] interface_names\nfloat64[] values\n",
    "bench/msg/Channel": "string name\nfloat64 volts\n",
}


def bench_types():
    """A store of the types of ROS and of the bench."""
    store = get_typestore(Stores.ROS2_JAZZY)
    types: dict[str, Any] = {}
    for name, text in DEFINITIONS.items():
        types.update(get_types_from_msg(text, name))
    store.register(types)
    return store


STORE = bench_types()
T = STORE.types


def stamp(seconds: float) -> Any:
    """builtin_interfaces/Time."""
    nanoseconds = round(seconds * 1e9)
    return T["builtin_interfaces/msg/Time"](nanoseconds // 10**9, nanoseconds % 10**9)


def header(seconds: float) -> Any:
    """std_msgs/Header."""
    return T["std_msgs/msg/Header"](stamp(seconds), "bench")


def command(seconds: float, duty: float) -> Any:
    """A command of four motors: the duty [1] of the third in percent, stamped in its header and in microseconds."""
    values = np.array([-1.0, 2.0, 100.0 * duty, 4.0], np.float32)
    return T["bench/msg/Command"](header(seconds), round(seconds * 1e6), T["bench/msg/Pwm"](values, True))


def board(volts: float, counts: int) -> Any:
    """The voltages of a board by name, and counts of a converter."""
    channels = [T["bench/msg/Channel"](name, value) for name, value in (("spare", -9.0), ("supply", volts))]
    return T["bench/msg/Board"](channels, "a text", counts)


def joints(seconds: float, **positions: float) -> Any:
    """sensor_msgs/JointState: positions [rad], velocities 10 and efforts 100 times as large."""
    values = np.array(list(positions.values()))
    return T["sensor_msgs/msg/JointState"](header(seconds), list(positions), values, 10.0 * values, 100.0 * values)


def write_foreign(
    folder: Path,
    messages: list[tuple[str, str, float, Any]],
    plugin: StoragePlugin = StoragePlugin.MCAP,
    packing: CompressionMode = CompressionMode.NONE,
) -> Path:
    """A rosbag2 directory of messages: topic, type, log time [s] and content."""
    writer = Writer(folder, version=9, storage_plugin=plugin)
    if packing != CompressionMode.NONE:
        writer.set_compression(packing, CompressionFormat.ZSTD)
    with writer:
        connections: dict[str, Any] = {}
        for topic, kind, time, content in messages:
            if topic not in connections:
                connections[topic] = writer.add_connection(topic, kind, typestore=STORE)
            writer.write(connections[topic], round(time * 1e9), STORE.serialize_cdr(content, kind))
    return folder


def bench_run(count: int = 60, late: Callable[[int], float] = lambda k: 0.0) -> list[tuple[str, str, float, Any]]:
    """A run at 100 Hz from 1000 s: commands, two joints and a board; `late` [s] is the way of message k."""
    found = []
    for k in range(count):
        time = 1000.0 + 0.01 * k
        log = time + late(k)
        duty, angle = 0.3 * np.sin(0.3 * k), 0.02 * k
        found.append(("/motor/command", "bench/msg/Command", log, command(time, duty)))
        found.append(("/joint_states", "sensor_msgs/msg/JointState", log, joints(time, shoulder=-angle, elbow=angle)))
        found.append(("/board", "bench/msg/Board", log, board(13.0 + 0.01 * k, 100 * k % 4096)))
    return found
