"""Writes signals to MCAP in the form that ROS 2 tools open; the file is whole or not there."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np
import yaml
from numpy.typing import ArrayLike, NDArray

from pierburg_ros.errors import InputError
from pierburg_ros.recording.formats import cdr
from pierburg_ros.recording.formats.mcap_writer import TYPES, McapWriter, bag_metadata
from pierburg_ros.recording.formats.messages import Integers
from pierburg_ros.recording.recording import INPUTS, UNITS, Channel

Signal = tuple[str, ArrayLike, ArrayLike]
"""Message type, times [s] and values; values of sensor_msgs/msg/JointState are shaft positions [rad]."""
MEASURED = {
    "hall_voltage": ("/hall_voltage", cdr.FLOAT64),
    "position": ("/joint_states", cdr.JOINT_STATE),
    "speed": ("/speed", cdr.FLOAT64),
}
"""Topic and message type of each measured quantity."""


def write_recording(
    path: str | Path,
    signals: Mapping[str, Signal],
    *,
    as_directory: bool = False,
    numbers: Mapping[str, Integers] | None = None,
) -> None:
    """Write `signals`, by topic, to the MCAP file `path`, or as a rosbag2 directory of that name.

    The earliest time of all becomes 0 if it is negative. Log and publish time are the signal's time; messages
    of one time stand in the order of `signals`; sequence numbers count each topic's messages, unless `numbers` has its
    sender's, which tell what is missing.
    """
    path = Path(path)
    if as_directory and path.exists():
        raise InputError(f"{path} exists, expected a new rosbag2 directory. Choose another name.")
    path.parent.mkdir(parents=True, exist_ok=True)
    folder = Path(tempfile.mkdtemp(prefix=f".{path.name}-", dir=path.parent))
    try:
        file = folder / (f"{path.name}_0.mcap" if as_directory else path.name)
        with file.open("wb") as stream, McapWriter(stream) as writer:
            for topic, (type_name, _, _) in signals.items():
                writer.declare(topic, type_name)
            for message in in_order(signals, numbers or {}):
                writer.write(*message)
        if as_directory:
            (folder / "metadata.yaml").write_text(yaml.safe_dump(bag_metadata({file.name: writer}), sort_keys=False))
            folder.chmod(0o755)
        os.replace(folder if as_directory else file, path)
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def write_simulated(
    path: str | Path,
    time: ArrayLike,
    command: ArrayLike | Channel,
    measured: ArrayLike,
    setpoints: Channel | None = None,
    quantity: str = "hall_voltage",
    driven_by: str = "duty",
) -> None:
    """Write a simulated run to the MCAP file `path`.

    `measured` is Hall voltage [V], position [rad] or speed [rad/s] at `time` [s]; the `command` is a duty [1], current
    [A] or torque [N.m] as `driven_by` says and has one value for each time, in force until the next, or is a channel
    with times of its own; `setpoints` [rad].
    """
    for what, name, known in (("quantity", quantity, UNITS), ("input", driven_by, INPUTS)):
        if name not in known:
            raise InputError(f"found {what} {name!r}, expected one of {', '.join(known)}.")
    topic, kind = MEASURED[quantity]
    inputs = command if isinstance(command, Channel) else Channel(np.asarray(time), np.asarray(command))
    signals: dict[str, Signal] = (
        {} if setpoints is None else {"/setpoints": (cdr.FLOAT64, setpoints.time, setpoints.values)}
    )
    signals[topic] = (kind, time, measured)
    signals[f"/{driven_by}"] = (cdr.FLOAT64, inputs.time, inputs.values)
    write_recording(path, signals)


def in_order(
    signals: Mapping[str, Signal], numbers: Mapping[str, Integers]
) -> Iterator[tuple[str, bytes, int, int, int]]:
    """Topic, data, log time [ns], publish time [ns] and sequence number of every message, by time."""
    seconds = [np.asarray(time, np.float64) for _, time, _ in signals.values()]
    earliest = min((float(np.min(time)) for time in seconds if time.size), default=0.0)
    stamps = [np.round((time - min(earliest, 0.0)) * 1e9).astype(np.int64) for time in seconds]
    encoded = [
        encode(kind, when, np.asarray(values, np.float64))
        for when, (kind, _, values) in zip(stamps, signals.values(), strict=True)
    ]
    topics = list(signals)
    source = np.repeat(np.arange(len(topics)), [when.size for when in stamps])
    place = np.concatenate([np.arange(when.size) for when in stamps])
    for row in np.lexsort((source, np.concatenate(stamps))).tolist():
        topic, number = int(source[row]), int(place[row])
        when = int(stamps[topic][number])
        sent = int(numbers[topics[topic]][number]) if topics[topic] in numbers else number
        yield topics[topic], encoded[topic][number], when, when, sent


def encode(type_name: str, stamps: Integers, values: NDArray[np.float64]) -> list[bytes]:
    """One CDR message for each value."""
    if type_name == cdr.FLOAT64:
        return cdr.encode_float64(values)
    if type_name == cdr.BOOL:
        return cdr.encode_bool(values)
    if type_name == cdr.JOINT_STATE:
        return [joint_state(when, value) for when, value in zip(stamps.tolist(), values, strict=True)]
    raise InputError(f"found message type {type_name}, expected {cdr.FLOAT64}, {cdr.BOOL} or {cdr.JOINT_STATE}.")


def joint_state(stamp: int, position: float) -> bytes:
    """One sensor_msgs/JointState of the shaft: `stamp` [ns], `position` [rad]."""
    time, header, message = (
        TYPES.types[name] for name in ("builtin_interfaces/msg/Time", "std_msgs/msg/Header", cdr.JOINT_STATE)
    )
    stamped = header(time(stamp // 10**9, stamp % 10**9), "")
    nothing = np.zeros(0)
    return bytes(
        TYPES.serialize_cdr(message(stamped, [cdr.SHAFT], np.array([position]), nothing, nothing), cdr.JOINT_STATE)
    )
