"""One recording on disk as it grows, in chunks small enough that a kill costs little."""

from __future__ import annotations

import os
from collections import Counter
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pierburg_ros.nodes.recording.definitions import definition, type_hash
from pierburg_ros.recording.formats.mcap_writer import McapWriter
from pierburg_ros.recording.loss import LOSSES

CHUNK = 64 * 1024
"""Bytes that a writer which is killed may lose; with the usual 1 MiB peers lost seconds."""
ROOM = 4 * CHUNK
"""Bytes that must fit when a file is opened: about two seconds of a graph at 500 Hz. With less, a recording that
begins would end before anybody has read that it began."""


@dataclass(frozen=True)
class Topic:
    """A recorded topic with its type and the quality of service that its publishers offer."""

    name: str
    kind: str
    qos: tuple[dict[str, Any], ...] = ()

    @property
    def lasts(self) -> bool:
        """Whether its newest message holds on for readers that come later."""
        return all(offer["durability"] == "transient_local" for offer in self.qos)


class RecordingFile:
    """An MCAP file being written."""

    def __init__(self, path: Path) -> None:
        """Make the file; OSError, and no file, where it exists or where there is no room for it."""
        path.parent.mkdir(parents=True, exist_ok=True)
        self.path = self.opened_as = path
        self._lost: Counter[str] = Counter()
        self._whole = 0
        self._stream = path.open("xb")
        try:
            self._try_room()
            self.writer = McapWriter(self._stream, CHUNK)
            self.flush()
        except OSError:
            self._drop()
            path.unlink()
            raise

    @property
    def messages(self) -> int:
        """How many messages there are so far."""
        return sum(self.writer.counts.values())

    @property
    def losses(self) -> dict[str, tuple[int, int]]:
        """Messages that are missing in the file and that are in it, by topic."""
        return {topic: (self._lost[topic], got) for topic, got in self.writer.counts.items()}

    def add(self, topic: Topic, data: bytes, missing: int, publish_time: int, log_time: int) -> None:
        """Append a message: its CDR bytes, how many are missing before it, and its times [ns].

        Its number in the file counts the missing ones in, whatever the publishers of the topic count from.
        """
        if topic.name not in self.writer.channels:
            kind = topic.kind
            self.writer.declare(topic.name, kind, definition(kind), type_hash(kind), list(topic.qos))
        self._lost[topic.name] += missing
        number = self.writer.counts[topic.name] + 1 + self._lost[topic.name]
        self.writer.write(topic.name, data, log_time, publish_time, number & 0xFFFFFFFF)

    def flush(self) -> None:
        """Put what has come so far on disk."""
        self.writer.flush()
        self._whole = self._stream.tell()

    def finish(self) -> None:
        """Complete the file, with the lost and sent messages of each topic in a metadata record."""
        self.writer.note(LOSSES, {name: f"{lost} of {lost + got}" for name, (lost, got) in self.losses.items()})
        self.writer.finish()
        self._stream.close()

    def give_up(self) -> None:
        """Leave the file as far as whole chunks came, under a name that says that it is cut."""
        self._drop()
        with suppress(OSError):
            os.truncate(self.path, self._whole)
        self.rename(self.opened_as.with_name(f"{self.opened_as.stem}.cut.mcap"))

    def rename(self, path: Path) -> None:
        """Give the file another name, where that can be done."""
        with suppress(OSError):
            self.path.rename(path)
            self.path = path

    def _try_room(self) -> None:
        self._stream.write(bytes(ROOM))
        self._stream.flush()
        self._stream.seek(0)
        self._stream.truncate()

    def _drop(self) -> None:
        """Close the file without writing what is still in memory, which would fail again."""
        with suppress(OSError):
            self._stream.close()
