"""The numbers in messages of any type: one of each message, found by its path."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from rosbags.interfaces import Nodetype
from rosbags.serde import SerdeError
from rosbags.typesys.store import Typestore

from pierburg_ros.errors import InputError
from pierburg_ros.recording.formats import cdr
from pierburg_ros.recording.formats.definitions import Description, types_of
from pierburg_ros.recording.formats.messages import Messages
from pierburg_ros.recording.signal_map.field_path import Absent, FieldPath, Named, Step, names_beside, value_at
from pierburg_ros.recording.signals import near

DECODERS = {cdr.FLOAT64: cdr.float64, cdr.BOOL: cdr.boolean, cdr.JOINT_STATE: cdr.position}
"""What reads the usual number of the types that the graph records, many messages at a time."""
TIMES = {"builtin_interfaces/msg/Time", "builtin_interfaces/msg/Duration"}
HEADER = "header"
DEEPEST = 8
"""Messages in messages that are looked into."""
MOST_FIELDS = 200
"""Fields of a type that are listed."""


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
    kept, found = np.ones(len(messages), bool), []
    for place, data in enumerate(messages.data):
        try:
            value = value_at(decoded(store, messages, place, data), steps)
            found.append(nanoseconds(value) if is_stamp else single(value))
        except Absent:
            kept[place] = False
        except (IndexError, Several) as error:
            raise InputError(
                f"{origin}: message {place} of {messages.topic} has {elements(store, messages, data, steps, error)}."
            ) from None
    if messages.data and not found:
        names = elements_named(store, messages, steps)
        raise InputError(
            f"{origin}: no message of {messages.topic} has {steps.written} (found: {', '.join(names[:20]) or 'none'})."
            f"{near(next(step.name for step in steps.steps if isinstance(step, Named)), names)} Name one of those."
        )
    return Numbers(kept, np.array(found, np.int64 if is_stamp or whole(found) else np.float64), is_stamp)


class Several(Exception):
    """An array stands where one number is wanted."""


def single(value: Any) -> float | int:
    """A number, also the only one of an array."""
    if isinstance(value, (list, np.ndarray)):
        if len(value) != 1:
            raise Several(len(value))
        value = value[0]
    return value if type(value) is int and abs(value) < 2**62 else float(value)


def whole(found: list[float | int]) -> bool:
    """Whether all numbers are whole ones, which 64 bits hold to the last digit."""
    return bool(found) and all(type(value) is int for value in found)


def nanoseconds(stamp: Any) -> int:
    """A stamp or a duration [ns]."""
    return int(stamp.sec) * 1_000_000_000 + int(stamp.nanosec)


def decoded(store: Typestore, messages: Messages, place: int, data: bytes) -> Any:
    """One message."""
    if not data:
        raise InputError(f"{messages.topic} has messages that are too long to be kept, expected those of a signal.")
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
        return f"{error.args[0]} elements in {path.written}{listed}, expected one. Choose it, as {example}"
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


def completed(store: Typestore, messages: Messages, path: FieldPath | None, origin: str) -> tuple[FieldPath, bool]:
    """The path down to a number, and whether it ends at a stamp; what does not lead to one number is refused."""
    steps = path.steps if path else ()
    description = described(store, messages, steps, origin)
    while description[0] == Nodetype.NAME and description[1] not in TIMES:
        below = [name for name, inner in fields_of(store, description[1]) if has_number(store, inner, DEEPEST)]
        if len(below) != 1:
            raise InputError(
                f"{origin}: {messages.topic} ({messages.type}) holds {'several numbers' if below else 'no number'}"
                f"{' in ' + path.written if path else ''}, expected one. Say which with field: one of"
                f" {', '.join(name for name, _ in listed(store, description[1]))}."
            )
        steps = (*steps, below[0])
        description = described(store, messages, steps, origin)
    kind = description[0]
    inner = description[1][0] if kind in (Nodetype.ARRAY, Nodetype.SEQUENCE) else description
    if inner[0] == Nodetype.BASE and inner[1][0] == "string":
        raise InputError(
            f"{origin}: {written(steps)} of {messages.topic} is a text, expected a number. Choose another."
        )
    if inner[0] == Nodetype.NAME and kind != Nodetype.NAME:
        raise InputError(
            f"{origin}: {written(steps)} of {messages.topic} is a list of {inner[1]}, expected one number."
            f" Choose it, as {written(steps)}[0].{next((name for name, _ in listed(store, inner[1])), 'field')}."
        )
    return FieldPath(written(steps), steps), description[0] == Nodetype.NAME


def described(store: Typestore, messages: Messages, steps: tuple[Step, ...], origin: str) -> Description:
    """What the type has at the end of `steps`."""
    description: Description = (Nodetype.NAME, messages.type)
    for place, step in enumerate(steps):
        kind, inner = description
        if isinstance(step, str):
            fields = dict(fields_of(store, inner)) if kind == Nodetype.NAME else {}
            if step not in fields:
                known = [name for name, _ in listed(store, messages.type)]
                raise InputError(
                    f"{origin}: {messages.type} of {messages.topic} has no field {written(steps[: place + 1])},"
                    f" expected one of {', '.join(known)}.{near(written(steps), known)}"
                )
            description = fields[step]
        elif kind in (Nodetype.ARRAY, Nodetype.SEQUENCE):
            description = inner[0]
        else:
            raise InputError(
                f"{origin}: {written(steps[:place])} of {messages.topic} is no array, expected it without"
                f" {written(steps[place : place + 1])}."
            )
    return description


def fields_of(store: Typestore, name: str) -> list[tuple[str, Description]]:
    """Fields of a message type, with what they are; those called like a word of Python by their own name."""
    return list(store.fielddefs[name][1]) if name in store.fielddefs else []


def has_number(store: Typestore, description: Description, depth: int) -> bool:
    """Whether a field is a number or holds one; headers and stamps tell of time."""
    kind, inner = description
    if kind in (Nodetype.ARRAY, Nodetype.SEQUENCE):
        return has_number(store, inner[0], depth)
    if kind == Nodetype.BASE:
        return bool(inner[0] != "string")
    if inner in TIMES or inner == "std_msgs/msg/Header" or depth == 0:
        return False
    return any(has_number(store, each, depth - 1) for _, each in fields_of(store, inner))


def listed(store: Typestore, name: str) -> list[tuple[str, Description]]:
    """The paths to the numbers and stamps of a type, arrays marked with [], as many as a list may have."""
    found = []
    for path, description in leaves(store, (Nodetype.NAME, name), "", DEEPEST):
        found.append((path, description))
        if len(found) == MOST_FIELDS:
            break
    return found


def leaves(store: Typestore, description: Description, path: str, depth: int) -> Iterator[tuple[str, Description]]:
    """The numbers and stamps below `path`."""
    kind, inner = description
    if kind in (Nodetype.ARRAY, Nodetype.SEQUENCE):
        yield from leaves(store, inner[0], f"{path}[]", depth)
    elif kind == Nodetype.BASE or inner in TIMES:
        if kind != Nodetype.BASE or inner[0] != "string":
            yield path, description
    elif depth:
        for name, each in fields_of(store, inner):
            yield from leaves(store, each, f"{path}.{name}" if path else name, depth - 1)


def written(steps: tuple[Step, ...]) -> str:
    """Steps as they are written."""
    text = ""
    for step in steps:
        text += f".{step}" if isinstance(step, str) else f"[{step.name if isinstance(step, Named) else step}]"
    return text.removeprefix(".")
