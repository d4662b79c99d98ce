"""Message types by the definitions that a file carries, or else those that ROS 2 Jazzy brings."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, TypeAlias

from rosbags.interfaces import Nodetype
from rosbags.typesys import Stores, get_types_from_idl, get_types_from_msg, get_typestore
from rosbags.typesys.store import Typestore

from pierburg_ros.errors import InputError

Description: TypeAlias = Any
"""What a field is, as rosbags tells it: a kind of node, and what belongs to it."""
SEPARATOR = re.compile(r"^={80}\nIDL: .*\n", flags=re.MULTILINE)
"""What stands before each type of a definition in IDL."""
INCLUDE = re.compile(r"^#include .*$", flags=re.MULTILINE)
"""A line of IDL that names another file; all that it names stands in the definition."""
HEADER = "std_msgs/msg/Header"
LONGEST_DEFINITION = 1 << 18
"""Characters of a definition at most; those of the largest types of ROS, with all that they hold, have 20,000."""
MOST_ELEMENTS = 1 << 20
"""Elements of an array at most."""


@dataclass(frozen=True)
class Definition:
    """The text of a message type and of all that it holds, and its language: ros2msg, ros2idl, or none."""

    language: str = ""
    text: str = ""


UNDEFINED = Definition()


def types_from_idl(text: str, _: str) -> dict[str, Any]:
    """The types of a definition in IDL, those of each of its files."""
    types: dict[str, Any] = {}
    for part in SEPARATOR.split(text):
        if part.strip():
            types.update(get_types_from_idl(INCLUDE.sub("", part)))
    return types


PARSERS: dict[str, Callable[[str, str], dict[str, Any]]] = {"ros2msg": get_types_from_msg, "ros2idl": types_from_idl}


@lru_cache(maxsize=64)
def types_of(name: str, definition: Definition) -> Typestore:
    """The message type `name` and all that it holds; InputError where it is not defined."""
    standard = get_typestore(Stores.ROS2_JAZZY)
    if not definition.text and name in standard.fielddefs:
        return standard
    if not definition.text or definition.language not in PARSERS or len(definition.text) > LONGEST_DEFINITION:
        raise InputError(
            f"{name} has no definition in the file that is read here ({definition.language or 'none'}), expected one"
            " in ros2msg or ros2idl. Record to MCAP, or with ROS 2 Iron or later."
        )
    try:
        types = PARSERS[definition.language](definition.text, name)
        store = Typestore(max_sequence_length=MOST_ELEMENTS)
        store.register({**missing(types, standard.fielddefs), **types})
        store.get_msgdef(name)
    except Exception as error:  # whatever a library answers to a hostile text
        reason = " ".join(str(error).split())[:60]
        raise InputError(f"The definition of {name} in the file is not usable ({reason}). Record again.") from error
    return store


def first_field(name: str, definition: Definition) -> str:
    """The message type that the first field of the type `name` has, or nothing."""
    try:
        fields = types_of(name, definition).fielddefs[name][1]
    except InputError:
        return ""
    return str(fields[0][1][1]) if fields and fields[0][1][0] == Nodetype.NAME else ""


def missing(types: dict[str, Any], standard: dict[str, Any]) -> dict[str, Any]:
    """The standard types that `types` hold and do not define."""
    found: dict[str, Any] = {}
    wanted = [name for definition in types.values() for name in names_in(definition)]
    while wanted:
        name = wanted.pop()
        if name not in types and name not in found and name in standard:
            found[name] = standard[name]
            wanted.extend(names_in(standard[name]))
    return found


def names_in(definition: Any) -> Iterator[str]:
    """The types that a definition names."""
    for _, (kind, inner) in definition[1]:
        if kind in (Nodetype.ARRAY, Nodetype.SEQUENCE):
            kind, inner = inner[0]
        if kind == Nodetype.NAME:
            yield inner
