"""One recording on disk as it grows, in chunks small enough that a kill costs little."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pierburg_ros.nodes.definitions import definition, type_hash
from pierburg_ros.recording.formats.mcap_writer import McapWriter

CHUNK = 64 * 1024
"""Bytes that a writer which is killed may lose; with the usual 1 MiB peers lost seconds."""


@dataclass(frozen=True)
class Topic:
    """A recorded topic with its type and the quality of service that its publishers offer."""

    name: str
    kind: str
    qos: tuple[dict[str, Any], ...] = ()


class RecordingFile:
    """An MCAP file being written."""

    def __init__(self, path: Path) -> None:
        path.parent.mkdir(parents=True, exist_ok=True)
        self.path = path
        self._stream = path.open("xb")
        self.writer = McapWriter(self._stream, CHUNK)

    @property
    def messages(self) -> int:
        """How many messages there are so far."""
        return sum(self.writer.counts.values())

    def add(self, topic: Topic, data: bytes, sequence: int, publish_time: int, log_time: int) -> None:
        """Append a message: its CDR bytes, its number among its publisher's, and its times [ns]."""
        if topic.name not in self.writer.channels:
            kind = topic.kind
            self.writer.declare(topic.name, kind, definition(kind), type_hash(kind), list(topic.qos))
        self.writer.write(topic.name, data, log_time, publish_time, sequence & 0xFFFFFFFF)

    def flush(self) -> None:
        """Put what has come so far on disk."""
        self.writer.flush()

    def finish(self) -> None:
        """Complete the file."""
        self.writer.finish()
        self._stream.close()
