"""Serialised messages as they lie in a file, before anything is decoded or timed."""

from __future__ import annotations

from array import array
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from pierburg_ros.errors import InputError, printable
from pierburg_ros.recording.formats.definitions import UNDEFINED, Definition

Integers = NDArray[np.int64]
Wanted = Callable[[str], bool]
"""Whether a topic of this name is to be kept."""
LATEST = 2**63 - 1
"""Latest time [ns] that a signed number of 64 bits holds, as ROS and NumPy count."""
OVERHEAD = 80
"""Bytes that a kept message takes in memory besides its own: object, reference, times, sequence and place."""
MOST_KEPT = 1 << 30
"""Bytes of messages kept at most, half of the 2 GiB that a command may take; the arrays made of them have the rest.
It is 3 h at 1 kHz of all the topics that are read."""
LONGEST_MESSAGE = 1 << 14
"""Bytes of a message that is kept: 2,000 numbers. Of larger ones, as pictures and clouds of points, the times are kept,
so that a camera beside an actuator does not take the memory."""


@dataclass(frozen=True)
class Messages:
    """The messages of one topic in the order of the file; the arrays have shape (messages,).

    `log_time` and `publish_time` [ns] are 0 throughout where the file has none, `place` counts the messages
    of all topics, `data` is CDR, empty where a message is too long to be kept.
    """

    topic: str
    type: str
    log_time: Integers
    publish_time: Integers
    sequence: Integers
    place: Integers
    data: list[bytes]
    definition: Definition = UNDEFINED
    encoding: str = "cdr"

    def __len__(self) -> int:
        return len(self.data)

    def select(self, kept: NDArray[np.bool_]) -> Messages:
        """Some of the messages; their numbers, which then say nothing of losses, are 0."""
        if np.all(kept):
            return self
        data = [self.data[place] for place in np.flatnonzero(kept)]
        return replace(
            self,
            log_time=self.log_time[kept],
            publish_time=self.publish_time[kept],
            sequence=np.zeros(len(data), np.int64),
            place=self.place[kept],
            data=data,
        )


@dataclass
class Bag:
    """Collects the messages of a recording: type and encoding of every topic, and the messages of those wanted.

    `unpack` gives the CDR of a message as it lies in the file.
    """

    name: str
    wanted: Wanted
    unpack: Callable[[bytes], bytes] = bytes
    types: dict[str, str] = field(default_factory=dict)
    encodings: dict[str, str] = field(default_factory=dict)
    definitions: dict[str, Definition] = field(default_factory=dict)
    count: int = 0
    weight: int = 0
    headers: dict[str, array[int]] = field(default_factory=dict)
    data: dict[str, list[bytes]] = field(default_factory=dict)

    def declare(self, topic: str, type_name: str, encoding: str, definition: Definition = UNDEFINED) -> str | None:
        """Note that `topic` exists; its name if its messages are wanted."""
        topic, type_name = printable(topic), printable(type_name)
        self.types.setdefault(topic, type_name)
        self.headers.setdefault(topic, array("q"))
        self.data.setdefault(topic, [])
        self.encodings.setdefault(topic, encoding)
        self.definitions.setdefault(topic, definition)
        return topic if self.wanted(topic) else None

    def add(self, topic: str, log_time: int, publish_time: int, sequence: int, data: bytes) -> None:
        """Keep a message; times [ns]."""
        if not (0 <= log_time <= LATEST and 0 <= publish_time <= LATEST):
            raise InputError(
                f"{self.name}: message {self.count + 1}, on {topic}, has the time {max(log_time, publish_time)} ns or"
                " a negative one, expected a time before the year 2262. Cut or repair the recording there."
            )
        data = self.unpack(data)
        data = data if len(data) <= LONGEST_MESSAGE else b""
        self.weight += len(data) + OVERHEAD
        if self.weight > MOST_KEPT:
            raise InputError(
                f"{self.name} has more than {MOST_KEPT >> 20} MiB of the signals wanted, expected less than memory"
                " holds. Cut it into parts."
            )
        self.headers[topic].extend((log_time, publish_time, sequence, self.count))
        self.data[topic].append(data)
        self.count += 1

    def messages(self, topic: str) -> Messages:
        """Everything collected of `topic`."""
        log_time, publish_time, sequence, place = np.array(self.headers[topic], np.int64).reshape(-1, 4).T
        data = self.data[topic]
        return Messages(
            topic,
            self.types[topic],
            log_time,
            publish_time,
            sequence,
            place,
            data,
            self.definitions[topic],
            self.encodings[topic],
        )
