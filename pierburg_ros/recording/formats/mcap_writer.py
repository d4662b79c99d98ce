"""Writes MCAP as `ros2 bag record -s mcap` does: profile ros2, ros2msg schemas, CDR, QoS in the channels."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from types import TracebackType
from typing import IO, Any

import yaml
from mcap.writer import CompressionType, Writer
from rosbags.typesys import Stores, get_typestore

LIBRARY = "pierburg_ros"
CHUNK_SIZE = 1024 * 1024
"""Bytes in memory before a chunk is written; what a killed writer loses."""
ENDLESS = {"sec": 9223372036, "nsec": 854775807}
"""A duration that rosbag2 reads as no limit."""
QOS_PROFILES = [
    {
        "history": "keep_last",
        "depth": 10,
        "reliability": "reliable",
        "durability": "volatile",
        "deadline": ENDLESS,
        "lifespan": ENDLESS,
        "liveliness": "automatic",
        "liveliness_lease_duration": ENDLESS,
        "avoid_ros_namespace_conventions": False,
    }
]
"""What the graph's publishers offer; the same in a channel and in the metadata of a rosbag2 directory."""
TYPES = get_typestore(Stores.ROS2_JAZZY)


class McapWriter:
    """Writes messages to `stream`; every topic is declared before its first message."""

    def __init__(self, stream: IO[bytes], chunk_size: int = CHUNK_SIZE, profile: str = "ros2") -> None:
        self.writer = Writer(stream, chunk_size=chunk_size, compression=CompressionType.ZSTD)
        self.writer.start(profile=profile, library=LIBRARY)
        self.schemas: dict[str, int] = {}
        self.channels: dict[str, int] = {}
        self.topics: dict[str, dict[str, Any]] = {}
        self.counts: dict[str, int] = {}
        self.first: int | None = None
        self.last = 0

    def declare(
        self,
        topic: str,
        type_name: str,
        definition: str | None = None,
        type_hash: str | None = None,
        qos: list[dict[str, Any]] = QOS_PROFILES,
    ) -> None:
        """Declare `topic`; `definition` and hash of its type are needed where ROS 2 Jazzy does not bring it."""
        if type_name not in self.schemas:
            text = definition or str(TYPES.generate_msgdef(type_name, ros_version=2)[0])
            self.schemas[type_name] = self.writer.register_schema(type_name, "ros2msg", text.encode())
        number = type_hash or TYPES.hash_rihs01(type_name)
        offered = yaml.safe_dump(qos, sort_keys=False).strip()
        metadata = {"offered_qos_profiles": offered, "topic_type_hash": number}
        self.channels[topic] = self.writer.register_channel(topic, "cdr", self.schemas[type_name], metadata)
        self.describe(topic, type_name, number, qos)

    def describe(self, topic: str, type_name: str, type_hash: str, qos: list[dict[str, Any]]) -> None:
        """Note what the metadata of a rosbag2 directory say of a topic."""
        self.topics[topic] = {
            "name": topic,
            "type": type_name,
            "serialization_format": "cdr",
            "offered_qos_profiles": qos,
            "type_description_hash": type_hash,
        }
        self.counts.setdefault(topic, 0)

    def write(self, topic: str, data: bytes, log_time: int, publish_time: int, sequence: int) -> None:
        """Write one CDR message of a declared topic; times [ns]."""
        self.writer.add_message(self.channels[topic], log_time, data, publish_time, sequence)
        self.count(topic, log_time)

    def count(self, topic: str, log_time: int) -> None:
        """Note a message for the metadata of a rosbag2 directory."""
        self.counts[topic] += 1
        self.first = log_time if self.first is None else min(self.first, log_time)
        self.last = max(self.last, log_time)

    def flush(self) -> None:
        """Put everything written so far on disk, whatever the chunk's size."""
        self.writer.flush()  # type: ignore[no-untyped-call]

    def note(self, name: str, values: Mapping[str, str]) -> None:
        """Write a metadata record, which stands beside the messages and which readers of messages pass over."""
        self.writer.add_metadata(name, dict(values))

    def finish(self) -> None:
        """Write the end of the file, with its index."""
        self.writer.finish()  # type: ignore[no-untyped-call]

    def __enter__(self) -> McapWriter:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if error is None:
            self.finish()


def bag_metadata(files: Mapping[str, McapWriter]) -> dict[str, Any]:
    """What metadata.yaml says of a rosbag2 directory of these files, by name in the order they were written."""
    spans = {name: span([writer]) for name, writer in files.items()}
    topics = {topic: described for writer in files.values() for topic, described in writer.topics.items()}
    counts = Counter[str]()
    for writer in files.values():
        counts.update(writer.counts)
    information = {
        "version": 9,
        "storage_identifier": "mcap",
        "relative_file_paths": list(files),
        **span(list(files.values())),
        "topics_with_message_count": [
            {"topic_metadata": described, "message_count": counts[topic]} for topic, described in topics.items()
        ],
        "compression_format": "",
        "compression_mode": "",
        "files": [{"path": name, **covered} for name, covered in spans.items()],
        "custom_data": None,
        "ros_distro": "jazzy",
    }
    return {"rosbag2_bagfile_information": information}


def span(writers: Sequence[McapWriter]) -> dict[str, Any]:
    """Start, duration and number of messages of some files together."""
    first = min((writer.first for writer in writers if writer.first is not None), default=0)
    last = max((writer.last for writer in writers), default=0)
    return {
        "starting_time": {"nanoseconds_since_epoch": first},
        "duration": {"nanoseconds": max(last - first, 0)},
        "message_count": sum(sum(writer.counts.values()) for writer in writers),
    }
