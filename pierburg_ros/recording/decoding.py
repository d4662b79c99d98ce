"""The numbers in messages of any type: one of each message, found by its path."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray
from rosbags.serde import SerdeError
from rosbags.typesys.store import Typestore

from pierburg_ros.errors import InputError, near
from pierburg_ros.recording.formats import cdr
from pierburg_ros.recording.formats.definitions import types_of
from pierburg_ros.recording.formats.messages import LONGEST_MESSAGE, Messages
from pierburg_ros.recording.message_types import completed
from pierburg_ros.recording.signal_map.field_path import Absent, FieldPath, Named, names_beside, value_at

Parts: TypeAlias = "tuple[NDArray[np.bool_], Sequence[Any] | NDArray[np.float64]]"
"""Which messages have a number, and those numbers."""
DECODERS = {cdr.FLOAT64: cdr.float64, cdr.BOOL: cdr.boolean, cdr.JOINT_STATE: cdr.position}
"""What reads the usual number of the types that the graph records, many messages at a time."""


@dataclass(frozen=True)
class Numbers:
    """The number of each message that has one; `kept` says which do. A stamp is in whole ns, and `is_stamp` says so."""

    kept: NDArray[np.bool_]
    raw: NDArray[Any]
    is_stamp: bool = False


def numbers(messages: Messages, path: FieldPath | None, origin: str, *, usual: bool = False) -> Numbers:
    """The numbers at `path` of all `messages`, without it their only ones; `origin` is where that was asked for.

    `usual` takes the usual number of a type that the graph records.
    """
    if messages.encoding != "cdr":
        raise InputError(
            f"{origin}: {messages.topic} is encoded as {messages.encoding!r}, expected 'cdr'."
            " Convert it with a ROS 2 bag tool."
        )
    if usual and messages.type in DECODERS:
        return Numbers(np.ones(len(messages), bool), DECODERS[messages.type](messages))
    store = types_of(messages.type, messages.definition)
    steps, is_stamp = completed(store, messages, path, origin)
    try:
        kept, found = joint_in(messages, steps) or values_in(store, messages, steps, is_stamp)
    except (IndexError, Several) as error:
        place = error.args[0]
        raise InputError(
            f"{origin}: message {place} of {messages.topic} has"
            f" {elements(store, messages, messages.data[place], steps, error)}."
        ) from None
    if messages.data and not len(found):
        names = elements_named(store, messages, steps)
        raise InputError(
            f"{origin}: no message of {messages.topic} has {steps.written} (found: {', '.join(names[:20]) or 'none'})."
            f"{near(next(step.name for step in steps.steps if isinstance(step, Named)), names)} Name one of those."
        )
    return Numbers(kept, np.array(found, np.int64 if is_stamp or whole(found) else np.float64), is_stamp)


def joint_in(messages: Messages, path: FieldPath) -> Parts | None:
    """The same as `values_in` for one joint of joint states, ten times as fast; None for all else."""
    if messages.type != cdr.JOINT_STATE or len(path.steps) != 2:
        return None
    array, element = path.steps
    return cdr.joint(messages, array, element.name) if array in cdr.ARRAYS and isinstance(element, Named) else None


def values_in(store: Typestore, messages: Messages, path: FieldPath, is_stamp: bool) -> Parts:
    """Which messages have the element that is wanted, and what they have there.

    IndexError or Several, with the place of the message, where an array is too short or stands for a number.
    """
    kept, found = np.ones(len(messages), bool), []
    for place, data in enumerate(messages.data):
        try:
            value = value_at(decoded(store, messages, place, data), path)
            found.append(nanoseconds(value) if is_stamp else single(value))
        except Absent:
            kept[place] = False
        except Several as error:
            raise Several(place, *error.args) from None
        except IndexError:
            raise IndexError(place) from None
    return kept, found


class Several(Exception):
    """An array of so many elements stands where one number is wanted."""


def single(value: Any) -> float | int:
    """A number, also the only one of an array."""
    if isinstance(value, (list, np.ndarray)):
        if len(value) != 1:
            raise Several(len(value))
        value = value[0]
    return value if type(value) is int and abs(value) < 2**62 else float(value)


def whole(found: Sequence[Any] | NDArray[np.float64]) -> bool:
    """Whether all numbers are whole ones, which 64 bits hold to the last digit."""
    return len(found) > 0 and all(type(value) is int for value in found)


def nanoseconds(stamp: Any) -> int:
    """A stamp or a duration [ns]."""
    return int(stamp.sec) * 1_000_000_000 + int(stamp.nanosec)


def decoded(store: Typestore, messages: Messages, place: int, data: bytes) -> Any:
    """One message."""
    if not data:
        raise InputError(
            f"{messages.topic} has messages of more than {LONGEST_MESSAGE >> 10} KiB, expected those of a signal."
            " Name another."
        )
    try:
        return store.deserialize_cdr(data, messages.type)
    except (SerdeError, RecursionError) as error:
        reason = " ".join(str(error).split())[:80]
        raise InputError(
            f"{messages.topic}: message {place} is not the {messages.type} that the file defines ({reason})."
            " Record again."
        ) from error


def elements(store: Typestore, messages: Messages, data: bytes, path: FieldPath, error: Exception) -> str:
    """What to say of an array without the element that is wanted."""
    names = elements_named(store, messages, path, data)
    if isinstance(error, Several):
        example = f"{path.written}[{names[0] if names else 0}]"
        listed = f" ({', '.join(names[:20])})" if names else ""
        return f"{error.args[1]} elements in {path.written}{listed}, expected one. Choose it, as {example}"
    return f"fewer elements than {path.written} asks for, expected at least so many. Choose another place or name"


def elements_named(store: Typestore, messages: Messages, path: FieldPath, data: bytes | None = None) -> list[str]:
    """The names that the array in `path` has for its elements, in one message or in the first."""
    message = store.deserialize_cdr(messages.data[0] if data is None else data, messages.type)
    around, node = [message], message
    for step in path.steps:
        if not isinstance(step, str):
            break
        node = getattr(node, step, node)
        around.append(node)
    own = [each.name for each in node if hasattr(each, "name")] if isinstance(node, list) else []
    return own or next(names_beside(around), [])
