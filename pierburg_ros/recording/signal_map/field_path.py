"""Paths to a number in a message: `pwm.data[2]`, `position[elbow]`, `motors[left].current`."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, TypeAlias

PATH = re.compile(r"[A-Za-z]\w*(\[[^\[\]]+\])*(\.[A-Za-z]\w*(\[[^\[\]]+\])*)*")
STEP = re.compile(r"(?P<field>\w+)|\[(?P<element>[^\[\]]+)\]")
QUOTES = "'\""
LONGEST_PATH = 300
"""Characters of a path at most."""


@dataclass(frozen=True)
class Named:
    """The element of an array by its name: that of its `name` field, or at its place in an array of names beside it."""

    name: str


Step: TypeAlias = "str | int | Named"
"""A field, the place of an element, or its name."""


@dataclass(frozen=True)
class FieldPath:
    """The steps from a message to a number in it."""

    written: str
    steps: tuple[Step, ...]


class Absent(Exception):
    """The message has no element of that name: it is about others, as of another joint's."""


def field_path(written: str) -> FieldPath:
    """The path that is `written`; ValueError where it is none."""
    if len(written) > LONGEST_PATH or not PATH.fullmatch(written):
        raise ValueError(f"{written[:60]!r} is no field path")
    return FieldPath(written, tuple(step_of(part) for part in STEP.finditer(written)))


def step_of(part: re.Match[str]) -> Step:
    """One step; a whole number in brackets is a place, anything else a name, and so is what stands in quotes."""
    if part["field"] is not None:
        return part["field"]
    element = part["element"]
    if element.isdecimal() and len(element) < 10:
        return int(element)
    quoted = len(element) > 2 and element[0] == element[-1] and element[0] in QUOTES
    return Named(element[1:-1] if quoted else element)


def value_at(message: Any, path: FieldPath) -> Any:
    """What stands at `path` in a decoded message; Absent or IndexError where an element is not there."""
    node, around = message, [message]
    for step in path.steps:
        if isinstance(step, str):
            node = attribute(node, step)
        elif isinstance(step, int):
            node = node[step]
        else:
            node = node[place_of(step.name, node, around)]
        around.append(node)
    return node


def attribute(message: Any, name: str) -> Any:
    """A field; one that is called like a word of Python has a line behind its name."""
    return getattr(message, name) if hasattr(message, name) else getattr(message, name + "_")


def place_of(name: str, array: Any, around: list[Any]) -> int:
    """Where in `array` the element `name` stands; `around` are the messages that hold it, from the outermost."""
    for place, each in enumerate(array):
        if getattr(each, "name", None) == name:
            return place
    for names in names_beside(around):
        if name in names:
            return names.index(name)
    raise Absent(name)


def names_beside(around: list[Any]) -> Iterator[list[str]]:
    """The arrays of names in the messages `around`, the innermost first and the one called `name` before others."""
    for message in reversed(around):
        fields = getattr(message, "__dataclass_fields__", {})
        for field in sorted(fields, key=lambda each: each != "name"):
            value = getattr(message, field)
            if isinstance(value, list) and value and all(isinstance(each, str) for each in value):
                yield value
