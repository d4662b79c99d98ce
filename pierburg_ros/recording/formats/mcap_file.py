"""Reads MCAP as a stream, so that a file without its end, from a writer that was killed, reads too."""

from __future__ import annotations

import os
import struct
import zlib
from pathlib import Path
from typing import BinaryIO

from mcap.opcode import Opcode
from mcap.writer import MCAP0_MAGIC

from pierburg_ros.errors import InputError
from pierburg_ros.intake import opened
from pierburg_ros.recording.formats.compression import MOST_UNPACKED, Damaged, most_unpacked, unpacked
from pierburg_ros.recording.formats.definitions import UNDEFINED, Definition
from pierburg_ros.recording.formats.format import Format, as_bag
from pierburg_ros.recording.formats.messages import Bag

RECORD = struct.Struct("<BQ")
"""Opcode and length before every record."""
MESSAGE = struct.Struct("<HIQQ")
"""Channel, sequence, log time [ns] and publish time [ns] before every message's data."""
CHUNK = struct.Struct("<QQQI")
"""Start and end time [ns], size and checksum of what a chunk unpacks to."""
DECLARED = struct.Struct("<HH")
"""A channel and its schema, before its topic."""
IN_CHUNK = (Opcode.SCHEMA, Opcode.CHANNEL, Opcode.MESSAGE)
PRIVATE = 0x80
"""Opcodes from here on are for applications of their own, which others pass over."""
LEAST_PACKED = 2
"""Bytes that a message takes at least, packed. Measured: 3.7 of the densest there is, two topics of one constant value
at perfectly regular times in one chunk, by zstd at level 19; not varied."""
SLACK = 65_536
"""Records that a file may hold beyond one in `LEAST_PACKED` bytes."""


def read_mcap(path: Path, bag: Bag) -> None:
    """Add the messages of the MCAP file at `path` to `bag`, up to its end or as far as its writer came."""
    with opened(path, "an MCAP file") as file:
        if file.read(len(MCAP0_MAGIC)) != MCAP0_MAGIC:
            raise InputError(
                f"{path.name} is not an MCAP file (its first bytes are others)."
                " Give an .mcap, a rosbag2 directory or a .csv."
            )
        try:
            McapRecords(bag, os.fstat(file.fileno()).st_size).take(file)
        except (Damaged, struct.error, UnicodeDecodeError) as error:
            raise InputError(
                f"{path.name} is damaged after {bag.count} messages ({error}), expected whole records."
                " Recover it with 'pierburg recover', or record again."
            ) from error


class McapRecords:
    """Adds the messages among MCAP records to a bag; knows the schemas and channels declared so far."""

    def __init__(self, bag: Bag, size: int) -> None:
        self.bag = bag
        self.size = size
        self.records = size // LEAST_PACKED + SLACK
        self.unpacked = most_unpacked(size)
        self.schemas: dict[int, tuple[str, Definition]] = {}
        self.topics: dict[int, str | None] = {}

    def take(self, file: BinaryIO) -> None:
        """Take the records of `file`; one that is cut off ends it."""
        while len(head := file.read(RECORD.size)) == RECORD.size:
            opcode, length = RECORD.unpack(head)
            if opcode == Opcode.DATA_END:
                return
            end = file.tell() + length
            if end > self.size:
                return self.cut(file)
            if opcode == Opcode.CHUNK:
                self.chunk(file.read(self.bounded(length)))
            elif opcode in IN_CHUNK:
                self.record(opcode, file.read(self.bounded(length)))
            else:
                self.passed_over(opcode)
                file.seek(end)

    def cut(self, file: BinaryIO) -> None:
        """A record that reaches beyond the end is the last one of a killed writer, unless the file is finished."""
        file.seek(-len(MCAP0_MAGIC), os.SEEK_END)
        if file.tell() > len(MCAP0_MAGIC) and file.read() == MCAP0_MAGIC:
            raise Damaged("a record reaches beyond the end of a finished file")

    def bounded(self, length: int) -> int:
        """The length of a record that is read whole."""
        if length > MOST_UNPACKED:
            raise Damaged(f"a record of {length} bytes")
        return length

    def passed_over(self, opcode: int) -> None:
        """Refuse what is no record, and an endless number of those that are none of ours."""
        if opcode == 0:
            raise Damaged("zeros in place of a record")
        self.counted()

    def counted(self) -> None:
        """Count a record."""
        self.records -= 1
        if self.records < 0:
            raise Damaged(f"more records than {self.size} bytes hold")

    def chunk(self, content: bytes) -> None:
        """Take the records of a chunk."""
        _, _, size, checksum = CHUNK.unpack_from(content)
        kind, start = text(content, CHUNK.size)
        (length,) = struct.unpack_from("<Q", content, start)
        packed = content[start + 8 : start + 8 + length]
        self.unpacked -= size
        if size > MOST_UNPACKED or self.unpacked < 0 or len(packed) != length:
            raise Damaged(f"a chunk of {length} bytes that says it holds {size}")
        records = unpacked(kind, packed, size)
        if len(records) != size or checksum not in (0, zlib.crc32(records)):
            raise Damaged("a chunk whose size or checksum is another")
        self.take_packed(records)

    def take_packed(self, records: bytes) -> None:
        """Take the records of an unpacked chunk."""
        start = 0
        while start < len(records):
            opcode, length = RECORD.unpack_from(records, start)
            start += RECORD.size
            if (opcode not in IN_CHUNK and opcode < PRIVATE) or start + length > len(records):
                raise Damaged(f"a record of type {opcode} and {length} bytes in a chunk")
            self.record(opcode, records[start : start + length])
            start += length

    def record(self, opcode: int, content: bytes) -> None:
        """Take a message, or note a schema or a channel."""
        self.counted()
        if opcode == Opcode.MESSAGE:
            self.message(content)
        elif opcode == Opcode.SCHEMA:
            self.schema(content)
        elif opcode == Opcode.CHANNEL:
            self.channel(content)

    def message(self, content: bytes) -> None:
        """Keep a message if its channel is wanted."""
        channel, sequence, log_time, publish_time = MESSAGE.unpack_from(content)
        if channel not in self.topics:
            raise Damaged(f"a message on channel {channel}, which is not declared")
        topic = self.topics[channel]
        if topic is None:
            self.bag.count += 1
        else:
            self.bag.add(topic, log_time, publish_time, sequence, content[MESSAGE.size :])

    def schema(self, content: bytes) -> None:
        """Note a message type and its definition."""
        name, start = text(content, 2)
        language, start = text(content, start)
        definition = text(content, start, "replace")[0]
        self.schemas[struct.unpack_from("<H", content)[0]] = name, Definition(language, definition)

    def channel(self, content: bytes) -> None:
        """Note a channel; its messages are kept if its topic is wanted."""
        channel, schema = DECLARED.unpack_from(content)
        topic, start = text(content, DECLARED.size)
        encoding, _ = text(content, start)
        name, definition = self.schemas.get(schema, ("of no known type", UNDEFINED))
        self.topics[channel] = self.bag.declare(topic, name, encoding, definition)


def text(content: bytes, start: int, errors: str = "strict") -> tuple[str, int]:
    """The text at `start`, with its length before it, and where it ends; `errors` as Python decodes."""
    (length,) = struct.unpack_from("<I", content, start)
    end = start + 4 + length
    if end > len(content):
        raise Damaged(f"a text of {length} bytes in a record of {len(content)}")
    return content[start + 4 : end].decode(errors=errors), end


FORMAT = Format(
    "an MCAP file", lambda path, start: path.suffix == ".mcap" or start.startswith(MCAP0_MAGIC), as_bag(read_mcap)
)
