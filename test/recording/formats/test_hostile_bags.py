"""rosbag2 directories and sqlite3 files that rosbag2 does not write, each the smallest that once broke a reader."""

import sqlite3
import struct

import pytest
import zstandard
from support.tables import refusal

from pierburg_ros.recording import read_recording

INFORMATION = (
    "rosbag2_bagfile_information:"
    " {{relative_file_paths: {names}, compression_mode: '{mode}', compression_format: {kind}}}\n"
)
TABLES = (
    "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, serialization_format TEXT, qos TEXT)",
    "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, data BLOB)",
    "INSERT INTO topics VALUES (1, '/duty', 'std_msgs/msg/Float64', 'cdr', '')",
    "INSERT INTO topics VALUES (2, '/hall_voltage', 'std_msgs/msg/Float64', 'cdr', '')",
)

VALUE = b"\0\1\0\0" + struct.pack("<d", 0.5)


def packed(data: bytes) -> bytes:
    return zstandard.ZstdCompressor().compress(data)


def database(path, *statements, count=20, content=VALUE):
    with sqlite3.connect(path) as connection:
        for statement in TABLES:
            connection.execute(statement)
        rows = [(topic, 10_000_000 * k, content) for k in range(count) for topic in (1, 2)]
        connection.executemany("INSERT INTO messages VALUES (NULL, ?, ?, ?)", rows)
        for statement in statements:
            connection.execute(statement)
    connection.close()
    return path


def bag(folder, names="[a_0.db3]", mode="", kind="zstd", **files):
    (folder / "metadata.yaml").write_text(INFORMATION.format(names=names, mode=mode, kind=kind))
    for name, content in files.items():
        (folder / name).write_bytes(content)
    return folder


def test_a_plain_file_and_every_packing_read_alike(tmp_path):
    plain = database(tmp_path / "a_0.db3")
    assert read_recording(plain).time.size == 20
    assert read_recording(bag(tmp_path)).time.size == 20
    (tmp_path / "a_0.db3.zstd").write_bytes(packed(plain.read_bytes()))
    assert read_recording(bag(tmp_path, "[a_0.db3.zstd]", "FILE")).time.size == 20
    (tmp_path / "b").mkdir()
    database(tmp_path / "b/a_0.db3", content=packed(VALUE))
    assert read_recording(bag(tmp_path / "b", mode="MESSAGE")).time.size == 20


@pytest.mark.parametrize(
    ("statement", "reason"),
    [
        ("DROP TABLE messages", "has no table messages"),
        ("ALTER TABLE topics RENAME COLUMN type TO kind", "has no table topics"),
        ("UPDATE messages SET data = 'text'", "has no whole time and bytes"),
        ("UPDATE messages SET data = NULL", "has no whole time and bytes"),
        ("UPDATE messages SET timestamp = 'soon'", "has no whole time and bytes"),
        ("UPDATE messages SET timestamp = 1e300", "has no whole time and bytes"),
        ("UPDATE messages SET timestamp = -timestamp - 1", "or a negative one"),
        ("UPDATE topics SET name = x'00ff'", "without number, name, type or encoding"),
        ("UPDATE topics SET type = NULL", "without number, name, type or encoding"),
        ("UPDATE topics SET serialization_format = 'json'", "is encoded as 'json'"),
        ("UPDATE topics SET name = CAST(x'ff' AS TEXT)", "is damaged after 0 messages (Could not decode to UTF-8"),
    ],
)
def test_content_of_another_kind_is_one_line(tmp_path, statement, reason):
    assert reason in refusal(database(tmp_path / "run.db3", statement))


@pytest.mark.parametrize(
    "schema",
    [
        "CREATE VIEW messages AS WITH RECURSIVE n(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM n)"
        " SELECT 1 AS topic_id, x AS timestamp, x'00' AS data FROM n",
        "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER,"
        " data BLOB AS (zeroblob(900000000)))",
    ],
)
def test_tables_that_compute_are_refused_before_they_are_asked(tmp_path, schema):
    path = database(tmp_path / "run.db3", "DROP TABLE messages", schema)
    assert "has no table messages with data, timestamp, topic_id" in refusal(path)


def test_a_damaged_database_is_one_line(tmp_path):
    path = database(tmp_path / "run.db3")
    path.write_bytes(path.read_bytes()[:5000])
    assert "is damaged after" in refusal(path)


def test_no_database_at_all_is_one_line(tmp_path):
    (tmp_path / "run.db3").write_text("hello")
    assert "run.db3 is not a sqlite3 file" in refusal(tmp_path / "run.db3")


@pytest.mark.parametrize(
    ("names", "mode", "kind", "reason"),
    [
        ("3", "", "''", "does not list the files"),
        ("[]", "", "''", "does not list the files"),
        ("[1, 2]", "", "''", "does not list the files"),
        ("[{a: b}]", "", "''", "does not list the files"),
        ("[gone.db3]", "", "''", "lists gone.db3, which does not exist"),
        ("[/etc/passwd]", "", "''", "lists passwd, which does not exist"),
        ("[../a_0.db3, a_0.db3]", "", "''", "lists a file twice"),
        ("[a_0.db3]", "FILE", "lz4", "expected zstd of each file or message"),
        ("[a_0.db3]", "FILE", "zstd", "expected a file packed with zstd"),
        ("[a_0.db3]", "MESSAGE", "zstd", "A packed message is damaged"),
        ("[metadata.yaml]", "", "''", "is not a storage of rosbag2 known here"),
    ],
)
def test_metadata_of_another_kind_is_one_line(tmp_path, names, mode, kind, reason):
    database(tmp_path / "a_0.db3")
    assert reason in refusal(bag(tmp_path, names, mode, kind))


def test_metadata_that_is_no_text_is_one_line(tmp_path):
    (tmp_path / "metadata.yaml").write_bytes(b"\xff\xfe\x00")
    assert "metadata.yaml is not text in UTF-8" in refusal(tmp_path)


def test_a_packed_bomb_is_refused_before_it_fills_the_disk(tmp_path):
    frame = packed(bytes(64 << 20))
    bag(tmp_path, "[a_0.db3.zstd]", "FILE", **{"a_0.db3.zstd": frame * 20})
    assert "a_0.db3.zstd unpacks to more than" in refusal(tmp_path)


def test_a_packed_message_that_is_a_bomb_is_refused(tmp_path):
    database(tmp_path / "a_0.db3", count=1, content=packed(bytes(64 << 20)))
    assert "A packed message is damaged" in refusal(bag(tmp_path, mode="MESSAGE"))
