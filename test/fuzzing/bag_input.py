"""rosbag2 inputs: metadata beside MCAP or sqlite3 files, plain or compressed, and sqlite3 files alone."""

import random
import sqlite3
import struct
import tempfile
from pathlib import Path

import zstandard
from fuzzing.mcap_input import FLOAT64, mcap, payload, wrong_payload
from fuzzing.mutations import mutated_bytes, mutated_text
from fuzzing.values import NAMES, integer

Files = dict[str, bytes]
METADATA = """rosbag2_bagfile_information:
  version: 5
  storage_identifier: {storage}
  relative_file_paths: [{name}]
  duration: {{nanoseconds: 1000000000}}
  starting_time: {{nanoseconds_since_epoch: 0}}
  message_count: 40
  topics_with_message_count:
    - topic_metadata: {{name: /duty, type: {kind}, serialization_format: cdr, offered_qos_profiles: ""}}
      message_count: 20
    - topic_metadata: {{name: /hall_voltage, type: {kind}, serialization_format: cdr, offered_qos_profiles: ""}}
      message_count: 20
  compression_format: "{packing}"
  compression_mode: "{mode}"
  files:
    - path: {name}
      starting_time: {{nanoseconds_since_epoch: 0}}
      duration: {{nanoseconds: 1000000000}}
      message_count: 40
"""
TABLES = """
CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, serialization_format TEXT NOT NULL,
                    offered_qos_profiles TEXT NOT NULL);
CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL,
                      data BLOB NOT NULL);
"""
ENDLESS = """
CREATE VIEW messages AS WITH RECURSIVE n(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM n)
SELECT x AS id, 1 AS topic_id, x AS timestamp, x'00010000' AS data FROM n
"""
STATEMENTS = (
    "DROP TABLE topics",
    "DROP TABLE messages",
    "UPDATE topics SET type = NULL",
    "UPDATE topics SET name = x'00ff'",
    "UPDATE messages SET topic_id = 99",
    "UPDATE messages SET timestamp = 'soon'",
    "UPDATE messages SET timestamp = 1e300",
    "UPDATE messages SET timestamp = -timestamp",
    "UPDATE messages SET data = 'text'",
    "UPDATE messages SET data = 7",
    "UPDATE messages SET data = NULL",
    "ALTER TABLE messages RENAME TO other",
    "ALTER TABLE messages RENAME COLUMN data TO content",
    "DELETE FROM topics",
)


def database(chance: random.Random) -> bytes:
    """A sqlite3 file as rosbag2 writes it, or nearly."""
    wrong = chance.choice((0.0, 0.0, 0.1, 1.0))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "a.db3"
        connection = sqlite3.connect(path)
        connection.executescript("PRAGMA journal_mode=OFF; PRAGMA synchronous=OFF;" + TABLES.replace(" NOT NULL", ""))
        for topic, name in enumerate(("/duty", "/hall_voltage"), 1):
            named = chance.choice(NAMES).replace("\0", "") if chance.random() < wrong / 3 else name
            connection.execute("INSERT INTO topics VALUES (?, ?, ?, 'cdr', '')", (topic, named, FLOAT64))
        for k in range(chance.choice((0, 1, 20))):
            for topic in (1, 2):
                data, when = payload(chance, "/duty", 0), 2_000_000 * k
                if chance.random() < wrong / 2:
                    data, when = wrong_payload(chance, data), max(min(integer(chance), 2**63 - 1), -(2**63))
                connection.execute("INSERT INTO messages VALUES (NULL, ?, ?, ?)", (topic, when, data))
        if chance.random() < wrong:
            _damaged(chance, connection)
        connection.commit()
        connection.close()
        content = path.read_bytes()
    return mutated_bytes(chance, content) if chance.random() < 0.4 else content


def _damaged(chance: random.Random, connection: sqlite3.Connection) -> None:
    """Another content, or another schema, by SQL."""
    connection.execute(chance.choice(STATEMENTS))
    if chance.random() < 0.1:
        connection.executescript(f"DROP TABLE IF EXISTS messages; {ENDLESS}")


def bag(chance: random.Random) -> Files:
    """A rosbag2 directory."""
    storage = chance.choice(("mcap", "sqlite3"))
    content = mcap(chance) if storage == "mcap" else database(chance)
    mode, name = chance.choice(("", "", "FILE", "MESSAGE")), "a_0.mcap" if storage == "mcap" else "a_0.db3"
    if mode == "FILE":
        name += ".zstd"
        content = packed(chance, content)
    text = METADATA.format(storage=storage, name=name, kind=FLOAT64, packing="zstd" if mode else "", mode=mode)
    if chance.random() < 0.6:
        text = mutated_text(chance, text)
    return {"bag/metadata.yaml": text.encode("utf-8", "surrogateescape"), f"bag/{name}": content}


def packed(chance: random.Random, content: bytes) -> bytes:
    """A file as rosbag2 compresses it, at times a bomb, at times damaged."""
    data = zstandard.ZstdCompressor(level=1).compress(content)
    if chance.random() < 0.01:
        data += zstandard.ZstdCompressor(level=1).compress(bytes(64 << 20)) * chance.choice((1, 1, 50))
    if chance.random() < 0.1:
        data = data[:5] + struct.pack("<Q", integer(chance) % 2**64) + data[13:]
    return mutated_bytes(chance, data) if chance.random() < 0.2 else data
