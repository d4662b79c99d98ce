"""Every number in the messages of a topic, by its path, and what its values are."""

from __future__ import annotations

import keyword
import re
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, field, fields, is_dataclass
from numbers import Real
from typing import Any

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.errors import InputError, printable
from pierburg_ros.recording.decoding import DECODERS, decoded
from pierburg_ros.recording.formats.cdr import JOINT_STATE
from pierburg_ros.recording.formats.definitions import types_of
from pierburg_ros.recording.formats.messages import Messages
from pierburg_ros.recording.message_types import DEEPEST_MESSAGES
from pierburg_ros.recording.signal_map.field_path import names_beside

MOST_LOOKED_AT = 1000
"""Messages of a topic that are decoded, evenly over the recording: some 50 ms for a type of twenty numbers."""
LISTED_ELEMENTS = 16
"""Elements of an array that are listed."""
LISTED_FIELDS = 100
"""Numbers of a message that are listed."""
STAMP = {"sec", "nanosec"}
ELEMENT = re.compile(r"\[([^\[\]]+)\]")
"""An element of an array in a path."""


@dataclass(frozen=True, eq=False)
class Field:
    """One number of a topic or of a table: where it stands, and values of it, shape (messages that were looked at,).

    `time` [s] is when these messages were written, of the same shape, empty in a table. `path` is empty for a column;
    `file` is the table that it stands in where there are several, and `unit` the one that the table states of it, empty
    where none.
    """

    name: str
    type: str
    path: str
    values: Signal
    file: str = ""
    unit: str = ""
    time: Signal = field(default_factory=lambda: np.zeros(0))

    @property
    def bare(self) -> str:
        """The path without the elements of arrays."""
        return ELEMENT.sub("", self.path)

    @property
    def element(self) -> str:
        """The first name of an element in the path, as a rule that of a joint; empty where there is none."""
        return next((name for name in ELEMENT.findall(self.path) if not name.isdecimal()), "")

    @property
    def whole(self) -> bool:
        """Whether all values are whole numbers."""
        return bool(self.values.size) and bool(np.all(self.values == np.round(self.values)))

    @property
    def limits(self) -> tuple[float, float] | None:
        """The least and the largest finite value."""
        finite = self.values[np.isfinite(self.values)]
        return (float(np.min(finite)), float(np.max(finite))) if finite.size else None


def fields_of(messages: Messages) -> tuple[Field, ...]:
    """The numbers in the messages of one topic; none where they cannot be decoded."""
    if not len(messages) or messages.encoding != "cdr" or not all(messages.data[:1]):
        return ()
    if messages.type in DECODERS and messages.type != JOINT_STATE:
        values = DECODERS[messages.type](messages)
        return (Field(messages.topic, messages.type, "data", values, time=written(messages)),)
    try:
        store = types_of(messages.type, messages.definition)
        found: dict[str, list[tuple[int, float]]] = defaultdict(list)
        for place in np.unique(np.linspace(0, len(messages) - 1, MOST_LOOKED_AT).astype(int)):
            message = decoded(store, messages, int(place), messages.data[place])
            for count, (path, value) in enumerate(leaves(message, "", [message], DEEPEST_MESSAGES)):
                if count >= LISTED_FIELDS:
                    break
                found[path].append((int(place), float(value)))
    except InputError:
        return ()
    made = {path: np.array(parts, np.float64).T for path, parts in found.items()}
    time = written(messages)
    return tuple(
        Field(messages.topic, messages.type, path, values, time=time[places.astype(np.int64)])
        for path, (places, values) in made.items()
    )


def written(messages: Messages) -> Signal:
    """When the messages were written [s]."""
    return messages.log_time.astype(np.float64) * 1e-9


def leaves(node: Any, path: str, around: list[Any], depth: int) -> Iterator[tuple[str, float]]:
    """Paths and values of the numbers below `node`; stamps are times and no signals."""
    if isinstance(node, (Real, np.generic)) and not isinstance(node, np.character):
        yield path, float(node)
    elif isinstance(node, (list, np.ndarray)):
        names = names_of(node, around)
        for place, each in enumerate(node[:LISTED_ELEMENTS]):
            yield from leaves(each, f"{path}[{names[place] if names else place}]", [*around, each], depth)
    elif is_dataclass(node) and depth:
        below = [each.name for each in fields(node)]
        for name in () if set(below) >= STAMP else below:
            written = name[:-1] if name.endswith("_") and keyword.iskeyword(name[:-1]) else name
            inner = getattr(node, name)
            yield from leaves(inner, f"{path}.{written}" if path else written, [*around, inner], depth - 1)


def names_of(array: Any, around: list[Any]) -> list[str]:
    """The names that the elements of `array` go by, if a path can hold them; none where they have no names."""
    own = [each.name for each in array if isinstance(getattr(each, "name", None), str)]
    found = own or next((names for names in names_beside(around[:-1]) if len(names) == len(array)), [])
    usable = all(name and printable(name) == name and not set(name) & set("[]'\"") for name in found)
    usable = usable and not any(name.isdecimal() for name in found)
    return found if len(found) == len(array) == len(set(found)) and usable else []
