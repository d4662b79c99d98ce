"""Decodes and encodes the few message types the project reads, many messages at a time.

CDR (OMG, Common Data Representation): four bytes of header, of which the second tells the byte order, then
the fields, each aligned to its own size counted from the end of the header.
"""

from __future__ import annotations

import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pierburg_ros.errors import InputError
from pierburg_ros.recording.formats.messages import Integers, Messages

FLOAT64 = "std_msgs/msg/Float64"
BOOL = "std_msgs/msg/Bool"
CLOCK = "rosgraph_msgs/msg/Clock"
JOINT_STATE = "sensor_msgs/msg/JointState"
HEADER = 4
LITTLE = b"\x00\x01\x00\x00"
NAMES = HEADER + 8
"""Where the frame and the names of sensor_msgs/JointState begin, after its stamp."""
ARRAYS = ("position", "velocity", "effort")
"""What sensor_msgs/JointState has of each joint, in this order."""
SHAFT = "swirl_shaft"
"""Name of the joint that is taken where a message carries several."""


def byte_order(data: bytes) -> str:
    """`<` or `>` as the header of a message says."""
    return "<" if data[1] & 1 else ">"


def field(messages: Messages, kind: str, offset: int = HEADER) -> NDArray[Any]:
    """The field of NumPy type `kind` at one `offset` of all messages, shape (messages,)."""
    size = np.dtype(kind).itemsize
    short = [place for place, data in enumerate(messages.data) if len(data) < offset + size]
    if short:
        raise InputError(
            f"{messages.topic}: message {short[0]} ends after {len(messages.data[short[0]])} bytes, expected"
            f" a {messages.type}. Record again."
        )
    order = byte_order(messages.data[0]) if messages.data else "<"
    content = b"".join(data[offset : offset + size] for data in messages.data)
    return np.frombuffer(content, order + kind).astype(kind)


def float64(messages: Messages) -> NDArray[np.float64]:
    """Values of std_msgs/Float64."""
    return field(messages, "f8").astype(np.float64)


def boolean(messages: Messages) -> NDArray[np.float64]:
    """Values of std_msgs/Bool as 0 and 1."""
    return np.where(field(messages, "u1"), 1.0, 0.0)


def stamp(messages: Messages) -> Integers:
    """The leading builtin_interfaces/Time [ns] of rosgraph_msgs/Clock or of a message with a header."""
    seconds, nanoseconds = field(messages, "i4"), field(messages, "u4", HEADER + 4)
    return seconds.astype(np.int64) * 1_000_000_000 + nanoseconds.astype(np.int64)


def position(messages: Messages) -> NDArray[np.float64]:
    """Shaft position [rad] of sensor_msgs/JointState: that of the only joint, or of the one with the shaft's name."""
    return joint(messages, "position", None)[1]


def joint(messages: Messages, array: str, wanted: str | None) -> tuple[NDArray[np.bool_], NDArray[np.float64]]:
    """Which sensor_msgs/JointState tell of the joint `wanted`, and its numbers in `array` in those.

    `array` is position, velocity or effort; None wants the shaft. The names are looked up anew wherever other bytes
    stand for them: drivers that share a topic send other joints, or the same in another order.
    """
    kept, values = np.ones(len(messages), bool), np.empty(len(messages))
    block, names, after = b"", [""], NAMES
    for place, data in enumerate(messages.data):
        if not block or data[NAMES:after] != block:
            names, after = joint_names(messages, data)
            block = data[NAMES:after]
        start, count = numbers_of_joints(messages, data, after, array)
        index = shaft(messages.topic, names, count) if wanted is None else place_of(wanted, names)
        if index is None:
            kept[place] = False
        elif index >= count:
            raise IndexError(place)
        else:
            (values[place],) = struct.unpack_from(byte_order(data) + "d", data, start + 8 * index)
    return kept, values[kept]


def joint_names(messages: Messages, data: bytes) -> tuple[list[str], int]:
    """The names in one sensor_msgs/JointState, and where they end."""
    length = struct.Struct(byte_order(data) + "I")
    names: list[str] = []
    try:
        (size,) = length.unpack_from(data, NAMES)
        cursor = aligned(NAMES + 4 + size, 4)
        (joints,) = length.unpack_from(data, cursor)
        cursor += 4
        for _ in range(joints):
            cursor = aligned(cursor, 4)
            (size,) = length.unpack_from(data, cursor)
            names.append(data[cursor + 4 : cursor + 3 + size].decode())
            cursor += 4 + size
    except (struct.error, UnicodeDecodeError) as error:
        raise no_joint_state(messages, error) from error
    return names, cursor


def numbers_of_joints(messages: Messages, data: bytes, after: int, array: str) -> tuple[int, int]:
    """Where the numbers of `array` begin in one sensor_msgs/JointState whose names end at `after`, and how many."""
    cursor = after
    try:
        for name in ARRAYS:
            cursor = aligned(cursor, 4)
            (count,) = struct.unpack_from(byte_order(data) + "I", data, cursor)
            start = aligned(cursor + 4, 8) if count else cursor + 4
            cursor = start + 8 * count
            if name == array:
                break
    except struct.error as error:
        raise no_joint_state(messages, error) from error
    if cursor > len(data):
        raise no_joint_state(messages, f"{count} numbers in {len(data)} bytes")
    return start, count


def no_joint_state(messages: Messages, reason: object) -> InputError:
    """What to say of a message that is none."""
    return InputError(f"{messages.topic}: a message is not a {JOINT_STATE} ({reason}). Record again.")


def place_of(wanted: str, names: list[str]) -> int | None:
    """Where a joint stands among the names, if it does."""
    return names.index(wanted) if wanted in names else None


def shaft(topic: str, names: list[str], count: int) -> int:
    """Which of `count` joints is the shaft: the only one, or the one with its name."""
    if count == 1:
        return 0
    if SHAFT in names[:count]:
        return names.index(SHAFT)
    raise InputError(
        f"{topic} has {count} positions (joints: {', '.join(names) or 'unnamed'}), expected one joint,"
        f" or one named {SHAFT}. Choose with a signal map, position: {{topic: {topic}, field: 'position[NAME]'}}."
    )


def aligned(cursor: int, size: int) -> int:
    """The next place from `cursor` on where a field of `size` bytes may start."""
    return cursor + (HEADER - cursor) % size


def encode_float64(values: NDArray[np.float64]) -> list[bytes]:
    """One std_msgs/Float64 for each value."""
    content = np.asarray(values, "<f8").tobytes()
    return [LITTLE + content[start : start + 8] for start in range(0, len(content), 8)]


def encode_bool(values: NDArray[np.float64]) -> list[bytes]:
    """One std_msgs/Bool for each value."""
    return [LITTLE + (b"\x01" if value else b"\x00") for value in values]
