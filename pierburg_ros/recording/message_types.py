"""What a message type has at a path: a number, a stamp, a text, or what leads to none of them."""

from __future__ import annotations

from collections.abc import Iterator

from rosbags.interfaces import Nodetype
from rosbags.typesys.store import Typestore

from pierburg_ros.errors import InputError, near
from pierburg_ros.recording.formats.definitions import HEADER, Description
from pierburg_ros.recording.formats.messages import Messages
from pierburg_ros.recording.signal_map.field_path import FieldPath, Named, Step

TIMES = {"builtin_interfaces/msg/Time", "builtin_interfaces/msg/Duration"}
DEEPEST_MESSAGES = 8
"""Messages in messages that are looked into."""
MOST_FIELDS = 200
"""Fields of a type that are listed."""


def completed(store: Typestore, messages: Messages, path: FieldPath | None, origin: str) -> tuple[FieldPath, bool]:
    """The path down to a number, and whether it ends at a stamp; what does not lead to one number is refused."""
    steps = path.steps if path else ()
    description = described(store, messages, steps, origin)
    while description[0] == Nodetype.NAME and description[1] not in TIMES:
        below = [name for name, inner in fields_of(store, description[1]) if has_number(store, inner, DEEPEST_MESSAGES)]
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
    if inner in TIMES or inner == HEADER or depth == 0:
        return False
    return any(has_number(store, each, depth - 1) for _, each in fields_of(store, inner))


def listed(store: Typestore, name: str) -> list[tuple[str, Description]]:
    """The paths to the numbers and stamps of a type, arrays marked with [], as many as a list may have."""
    found = []
    for path, description in leaves(store, (Nodetype.NAME, name), "", DEEPEST_MESSAGES):
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
