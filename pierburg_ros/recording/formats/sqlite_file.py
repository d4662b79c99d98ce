"""Reads the sqlite3 files of rosbag2; their messages have a log time and no other."""

from __future__ import annotations

import os
import sqlite3
from contextlib import closing
from pathlib import Path

from pierburg_ros.errors import InputError
from pierburg_ros.intake import opened
from pierburg_ros.recording.formats.definitions import UNDEFINED, Definition
from pierburg_ros.recording.formats.format import Format, as_bag
from pierburg_ros.recording.formats.messages import Bag

MAGIC = b"SQLite format 3\0"
NEEDED = {
    "topics": {"id", "name", "type", "serialization_format"},
    "messages": {"topic_id", "timestamp", "data"},
}
"""Columns of the two tables that are read."""
DEFINITIONS = {"topic_type", "encoding", "encoded_message_definition"}
"""Columns of the table of definitions, which ROS 2 Iron and later write."""
MOST_DEFINITIONS = 10_000
"""Types of a file at most; all packages of ROS together have some 1,000."""
LENGTH_LIMIT = 0
"""SQLITE_LIMIT_LENGTH, the largest text or bytes that a value may have."""
LEAST_ROW = 8
"""Bytes that a message takes in the file at least; a file that holds more rows lists the same pages again and again."""


def read_sqlite(path: Path, bag: Bag) -> None:
    """Add the messages of the sqlite3 file at `path` to `bag`, by time."""
    with opened(path, "a rosbag2 file") as file:
        size = os.fstat(file.fileno()).st_size
        if file.read(len(MAGIC)) != MAGIC:
            raise InputError(
                f"{path.name} is not a sqlite3 file (its first bytes are others)."
                " Give an .mcap, a rosbag2 directory or a .csv."
            )
    try:
        with closing(sqlite3.connect(f"{path.absolute().as_uri()}?mode=ro&immutable=1", uri=True)) as database:
            take(database, bag, size)
    except sqlite3.Error as error:
        raise InputError(
            f"{path.name} is damaged after {bag.count} messages ({error}), expected a sqlite3 file of rosbag2."
            " Record again."
        ) from error


def take(database: sqlite3.Connection, bag: Bag, size: int) -> None:
    """Add the messages of a file of `size` bytes that is open."""
    if hasattr(database, "setlimit"):  # from Python 3.11 on
        database.setlimit(LENGTH_LIMIT, max(size, 1 << 16))
    for table, columns in NEEDED.items():
        check_table(database, bag.name, table, columns)
    topics = declared(database, bag)
    left = size // LEAST_ROW
    wanted = ", ".join(str(number) for number in topics) or "NULL"
    query = f"SELECT topic_id, timestamp, data FROM messages WHERE topic_id IN ({wanted}) ORDER BY timestamp"
    for number, log_time, data in database.execute(query):
        left -= 1
        if left < 0 or not (isinstance(log_time, int) and isinstance(data, bytes)):
            raise InputError(
                f"{bag.name}: message {bag.count + 1}, on {topics[number]}, has no whole time and bytes, or the file"
                " repeats itself, expected the messages of rosbag2. Record again."
            )
        bag.add(topics[number], log_time, 0, 0, data)


def check_table(database: sqlite3.Connection, name: str, table: str, columns: set[str]) -> None:
    """Refuse all but a plain table: a view or a computed column could go on for ever."""
    kind = database.execute("SELECT type FROM sqlite_master WHERE name = ? AND rootpage > 0", (table,)).fetchall()
    found = {row[1] for row in database.execute(f"PRAGMA table_xinfo({table})") if row[6] == 0}
    if kind != [("table",)] or not columns <= found:
        raise InputError(
            f"{name} has no table {table} with {', '.join(sorted(columns))}, expected a sqlite3 file of rosbag2."
            " Give another file."
        )


def declared(database: sqlite3.Connection, bag: Bag) -> dict[int, str]:
    """The wanted topics by their number."""
    topics: dict[int, str] = {}
    definitions = defined(database)
    for number, topic, kind, encoding in database.execute("SELECT id, name, type, serialization_format FROM topics"):
        if not (isinstance(number, int) and all(isinstance(each, str) for each in (topic, kind, encoding))):
            raise InputError(f"{bag.name} has a topic without number, name, type or encoding. Record again.")
        if (name := bag.declare(topic, kind, encoding, definitions.get(kind, UNDEFINED))) is not None:
            topics[number] = name
    return topics


def defined(database: sqlite3.Connection) -> dict[str, Definition]:
    """The definitions of message types by name, where the file has them."""
    kind = database.execute("SELECT type FROM sqlite_master WHERE name = 'message_definitions' AND rootpage > 0")
    found = {row[1] for row in database.execute("PRAGMA table_xinfo(message_definitions)") if row[6] == 0}
    if kind.fetchall() != [("table",)] or not found >= DEFINITIONS:
        return {}
    query = "SELECT encoded_message_definition, encoding, topic_type FROM message_definitions LIMIT ?"
    rows = database.execute(query, (MOST_DEFINITIONS,))
    return {
        name: Definition(language, text)
        for text, language, name in rows
        if all(isinstance(each, str) for each in (text, language, name))
    }


FORMAT = Format(
    "a .db3 file", lambda path, start: path.suffix == ".db3" or start.startswith(MAGIC), as_bag(read_sqlite)
)
