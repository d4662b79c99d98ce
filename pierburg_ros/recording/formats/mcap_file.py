"""Reads MCAP as a stream, so that a file without its end, from a writer that was killed, reads too."""

from __future__ import annotations

import mmap
import struct
from io import BytesIO
from pathlib import Path

from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Channel, Chunk, Schema
from mcap.stream_reader import CRCValidationError, get_chunk_data_stream
from mcap.writer import MCAP0_MAGIC
from zstandard import ZstdError

from pierburg_ros.errors import InputError
from pierburg_ros.recording.formats.messages import Bag

RECORD = struct.Struct("<BQ")
"""Opcode and length before every record."""
MESSAGE = struct.Struct("<HIQQ")
"""Channel, sequence, log time [ns] and publish time [ns] before every message's data."""
DAMAGE = (McapError, CRCValidationError, ZstdError, struct.error, UnicodeDecodeError, RuntimeError)
"""What the libraries raise on content that is not what was written; lz4 raises RuntimeError."""


def read_mcap(path: Path, bag: Bag) -> None:
    """Add the messages of the MCAP file at `path` to `bag`, up to its end or as far as its writer came."""
    with path.open("rb") as file:
        if file.read(len(MCAP0_MAGIC)) != MCAP0_MAGIC:
            raise InputError(
                f"{path.name} is not an MCAP file (its first bytes are others)."
                " Give an .mcap, a rosbag2 directory or a .csv."
            )
        with mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as content:
            try:
                McapRecords(bag).take(content, len(MCAP0_MAGIC))
            except DAMAGE as error:
                raise InputError(
                    f"{path.name} is damaged after {bag.count} messages ({error}), expected whole records."
                    " Recover it with 'mcap recover', or record again."
                ) from error


class McapRecords:
    """Adds the messages among MCAP records to a bag; knows the schemas and channels declared so far."""

    def __init__(self, bag: Bag) -> None:
        self.bag = bag
        self.schemas: dict[int, str] = {}
        self.topics: dict[int, str | None] = {}

    def take(self, content: bytes | mmap.mmap, start: int = 0) -> None:
        """Take the records of `content`, a file or a decompressed chunk; one that is cut off ends it."""
        while start + RECORD.size <= len(content):
            opcode, length = RECORD.unpack_from(content, start)
            start += RECORD.size
            end = start + length
            if end > len(content) or opcode == Opcode.DATA_END:
                return
            if opcode == Opcode.MESSAGE:
                self.message(content, start, end)
            elif opcode in (Opcode.SCHEMA, Opcode.CHANNEL, Opcode.CHUNK):
                self.declaration(opcode, ReadDataStream(BytesIO(content[start:end])))
            start = end

    def message(self, content: bytes | mmap.mmap, start: int, end: int) -> None:
        """Keep the message in content[start:end] if its channel is wanted."""
        channel, sequence, log_time, publish_time = MESSAGE.unpack_from(content, start)
        topic = self.topics.get(channel)
        if topic is not None:
            self.bag.headers[topic].append((log_time, publish_time, sequence, self.bag.count))
            self.bag.data[topic].append(content[start + MESSAGE.size : end])
        self.bag.count += 1

    def declaration(self, opcode: int, record: ReadDataStream) -> None:
        """Note a schema or a channel, or take the records of a chunk."""
        if opcode == Opcode.SCHEMA:
            schema = Schema.read(record)
            self.schemas[schema.id] = schema.name
        elif opcode == Opcode.CHANNEL:
            self.channel(Channel.read(record))
        else:
            chunk, length = get_chunk_data_stream(Chunk.read(record), validate_crc=True)
            self.take(chunk.read(length))

    def channel(self, channel: Channel) -> None:
        """Note a channel; its messages are kept if its topic is wanted."""
        wanted = self.bag.declare(channel.topic, self.schemas.get(channel.schema_id, "of no known type"))
        if wanted and channel.message_encoding != "cdr":
            raise InputError(
                f"{self.bag.name}: {channel.topic} is encoded as {channel.message_encoding!r}, expected"
                " 'cdr'. Convert it with a ROS 2 bag tool."
            )
        self.topics[channel.id] = channel.topic if wanted else None
