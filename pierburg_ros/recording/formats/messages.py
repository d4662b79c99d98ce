"""Serialised messages as they lie in a file, before anything is decoded or timed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Integers = NDArray[np.int64]
Wanted = Callable[[str], bool]
"""Whether a topic of this name is to be kept."""


@dataclass(frozen=True)
class Messages:
    """The messages of one topic in the order of the file; the arrays have shape (messages,).

    `log_time` and `publish_time` [ns] are 0 throughout where the file has none, `place` counts the messages
    of all topics, `data` is CDR.
    """

    topic: str
    type: str
    log_time: Integers
    publish_time: Integers
    sequence: Integers
    place: Integers
    data: list[bytes]

    def __len__(self) -> int:
        return len(self.data)


@dataclass
class Bag:
    """Collects the messages of a recording: the type of every topic, and the messages of those wanted."""

    name: str
    wanted: Wanted
    types: dict[str, str] = field(default_factory=dict)
    count: int = 0
    headers: dict[str, list[tuple[int, int, int, int]]] = field(default_factory=dict)
    data: dict[str, list[bytes]] = field(default_factory=dict)

    def declare(self, topic: str, type_name: str) -> bool:
        """Note that `topic` exists; True if its messages are wanted."""
        self.types.setdefault(topic, type_name)
        self.headers.setdefault(topic, [])
        self.data.setdefault(topic, [])
        return self.wanted(topic)

    def messages(self, topic: str) -> Messages:
        """Everything collected of `topic`."""
        log_time, publish_time, sequence, place = np.array(self.headers[topic], np.int64).reshape(-1, 4).T
        data = self.data[topic]
        return Messages(topic, self.types[topic], log_time, publish_time, sequence, place, data)
