"""Makes a cut MCAP file, or a rosbag2 directory of them, whole for every reader; the original stays as it is."""

from __future__ import annotations

import mmap
import os
import re
import shutil
import struct
import tempfile
import zlib
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import IO

import numpy as np
import yaml
from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Attachment, Channel, Chunk, Header, Metadata, Schema
from mcap.writer import MCAP0_MAGIC

from pierburg_ros.errors import InputError
from pierburg_ros.recording.formats.compression import Damaged, unpacked
from pierburg_ros.recording.formats.mcap_file import MESSAGE, RECORD
from pierburg_ros.recording.formats.mcap_writer import QOS_PROFILES, McapWriter, bag_metadata
from pierburg_ros.recording.loss import LOSSES, are_numbered

METADATA = "metadata.yaml"
Content = bytes | mmap.mmap
DAMAGE = (McapError, Damaged, struct.error, UnicodeDecodeError, EOFError)
"""What reading a record raises that is not what its writer wrote."""


@dataclass(frozen=True)
class Recovered:
    """What was saved: where it is now, how many messages, how many damaged chunks were left out."""

    path: Path
    messages: int
    damaged: int


def recover(path: Path, target: Path) -> Recovered:
    """Write a whole copy of the MCAP file or rosbag2 directory at `path` to `target`, all of it or nothing."""
    if target.exists():
        raise InputError(f"{target} exists, expected a new name. Choose another --output.")
    files = mcap_files(path)
    folder = Path(tempfile.mkdtemp(prefix=f".{target.name}-", dir=target.resolve().parent))
    try:
        copies = {name_of(file): copied(file, folder / name_of(file)) for file in files}
        messages = sum(sum(copy.counts.values()) for copy in copies.values())
        if not messages:
            raise InputError(f"{path} holds no whole message, expected at least one. Nothing can be recovered.")
        if path.is_dir():
            text = yaml.safe_dump(bag_metadata(copies), sort_keys=False)
            (folder / METADATA).write_text(text, encoding="utf-8")
            folder.chmod(0o755)
        os.replace(folder if path.is_dir() else folder / name_of(path), target)
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    return Recovered(target, messages, sum(copy.damaged for copy in copies.values()))


def is_whole(path: Path) -> bool:
    """Whether every file has its end, and a directory the metadata that lists its files."""
    files = mcap_files(path)
    if path.is_dir():
        try:
            listed = yaml.safe_load((path / METADATA).read_text())["rosbag2_bagfile_information"]["relative_file_paths"]
        except (OSError, UnicodeDecodeError, yaml.YAMLError, KeyError, TypeError):
            return False
        if sorted(listed) != sorted(file.name for file in files):
            return False
    return all(has_end(file) for file in files)


def has_end(file: Path) -> bool:
    """Whether an MCAP file ends as its writer ends it."""
    with file.open("rb") as stream:
        stream.seek(max(file.stat().st_size - len(MCAP0_MAGIC), 0))
        return file.stat().st_size > 2 * len(MCAP0_MAGIC) and stream.read() == MCAP0_MAGIC


def mcap_files(path: Path) -> list[Path]:
    """The MCAP file, or those of a directory in the order of their numbers."""
    if not path.exists():
        raise InputError(f"{path} does not exist, expected a recording. Check the path.")
    files = sorted(path.glob("*.mcap"), key=number_of) if path.is_dir() else [path]
    for file in files:
        with file.open("rb") as stream:
            if stream.read(len(MCAP0_MAGIC)) != MCAP0_MAGIC:
                raise InputError(f"{file} is not an MCAP file, expected one. Only MCAP can be recovered.")
    if not files:
        raise InputError(f"{path} holds no .mcap file, expected one or more. Only MCAP can be recovered.")
    return files


def number_of(file: Path) -> tuple[int, str]:
    """The number at the end of a file's name, by which rosbag2 orders its files."""
    found = re.search(r"_(\d+)$", file.stem.removesuffix(".cut"))
    return (int(found[1]) if found else -1, file.name)


def name_of(file: Path) -> str:
    """The name of a file once it is whole."""
    return f"{file.stem.removesuffix('.cut')}.mcap"


def copied(file: Path, target: Path) -> Copy:
    """A whole copy of an MCAP file at `target`, as far as its records go."""
    with file.open("rb") as source, target.open("wb") as stream:
        with mmap.mmap(source.fileno(), 0, access=mmap.ACCESS_READ) as content:
            copy = Copy(stream, profile_of(content))
            copy.take(content, len(MCAP0_MAGIC))
        copy.note(LOSSES, copy.losses())
        copy.finish()
    return copy


def profile_of(content: Content) -> str:
    """The profile in the header, as far as there is one."""
    for opcode, body in records(content, len(MCAP0_MAGIC)):
        if opcode == Opcode.HEADER:
            return str(Header.read(ReadDataStream(BytesIO(body))).profile)
        break
    return "ros2"


def records(content: Content, start: int) -> Iterator[tuple[int, bytes]]:
    """Opcode and body of the records that are there in full, up to the end of the data."""
    while start + RECORD.size <= len(content):
        opcode, length = RECORD.unpack_from(content, start)
        start += RECORD.size
        if start + length > len(content) or opcode == Opcode.DATA_END:
            return
        yield opcode, content[start : start + length]
        start += length


class Copy(McapWriter):
    """Writes the records of another file again, with everything that they declare."""

    def __init__(self, stream: IO[bytes], profile: str) -> None:
        super().__init__(stream, profile=profile)
        self.damaged = 0
        self._schemas: dict[int, tuple[int, str]] = {0: (0, "")}
        self._channels: dict[int, tuple[int, str]] = {}
        self._sequences: dict[str, list[int]] = defaultdict(list)

    def take(self, content: Content, start: int = 0) -> None:
        """Write the records of a file or of a decompressed chunk."""
        for opcode, body in records(content, start):
            if opcode == Opcode.MESSAGE:
                self._message(body)
            elif opcode in TAKEN:
                self._other(opcode, body)

    def losses(self) -> dict[str, str]:
        """Lost of sent messages by topic, for topics whose messages are numbered."""
        found = {}
        for topic, numbers in self._sequences.items():
            sequence = np.array(numbers, np.int64)
            if are_numbered(sequence):
                steps = np.diff(sequence)
                lost = int(np.sum(steps[steps > 1] - 1))
                found[topic] = f"{lost} of {lost + sequence.size}"
        return found

    def _message(self, body: bytes) -> None:
        channel, sequence, log_time, publish_time = MESSAGE.unpack_from(body)
        if channel not in self._channels:
            return
        number, topic = self._channels[channel]
        self.writer.add_message(number, log_time, body[MESSAGE.size :], publish_time, sequence)
        self._sequences[topic].append(sequence)
        self.count(topic, log_time)

    def _other(self, opcode: int, body: bytes) -> None:
        try:
            TAKEN[Opcode(opcode)](self, ReadDataStream(BytesIO(body)))
        except DAMAGE:
            self.damaged += 1

    def _schema(self, record: ReadDataStream) -> None:
        schema = Schema.read(record)
        if schema.id not in self._schemas:
            number = self.writer.register_schema(schema.name, schema.encoding, schema.data)
            self._schemas[schema.id] = (number, schema.name)

    def _channel(self, record: ReadDataStream) -> None:
        channel = Channel.read(record)
        if channel.id in self._channels:
            return
        if channel.schema_id not in self._schemas:
            raise McapError(f"channel {channel.topic} has no schema")
        schema, kind = self._schemas[channel.schema_id]
        metadata = channel.metadata
        number = self.writer.register_channel(channel.topic, channel.message_encoding, schema, metadata)
        self._channels[channel.id] = (number, channel.topic)
        qos = yaml.safe_load(metadata.get("offered_qos_profiles", "")) or QOS_PROFILES
        self.describe(channel.topic, kind, metadata.get("topic_type_hash", ""), qos)

    def _chunk(self, record: ReadDataStream) -> None:
        chunk = Chunk.read(record)
        content = unpacked(chunk.compression, chunk.data)
        if chunk.uncompressed_crc not in (0, zlib.crc32(content)):
            raise Damaged("a chunk whose checksum is another")
        self.take(content)

    def _attachment(self, record: ReadDataStream) -> None:
        one = Attachment.read(record)
        self.writer.add_attachment(one.create_time, one.log_time, one.name, one.media_type, one.data)

    def _metadata(self, record: ReadDataStream) -> None:
        one = Metadata.read(record)
        if one.name != LOSSES:
            self.note(one.name, one.metadata)


TAKEN = {
    Opcode.SCHEMA: Copy._schema,
    Opcode.CHANNEL: Copy._channel,
    Opcode.CHUNK: Copy._chunk,
    Opcode.ATTACHMENT: Copy._attachment,
    Opcode.METADATA: Copy._metadata,
}
"""What is done with each kind of record beside messages; indexes are made anew."""
