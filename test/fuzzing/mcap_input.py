"""MCAP inputs, framed here so that every length, time and size can be wrong on its own."""

import random
import struct
import zlib

import lz4.frame
import zstandard
from fuzzing.mutations import mutated_bytes
from fuzzing.values import NAMES, integer, number

MAGIC = b"\x89MCAP0\r\n"
FLOAT64, JOINT_STATE = "std_msgs/msg/Float64", "sensor_msgs/msg/JointState"
TOPICS = {"/hall_voltage": FLOAT64, "/duty": FLOAT64, "/joint_states": JOINT_STATE, "/clock": "rosgraph_msgs/msg/Clock"}
BOMB = 48 << 20
"""Bytes of zeros, or of tiny records, in a bomb; several in one file go beyond any memory."""


def text(content: str) -> bytes:
    """A string with its length before it."""
    data = content.encode("utf-8", "surrogatepass")
    return struct.pack("<I", len(data)) + data


def record(opcode: int, content: bytes, length: int | None = None) -> bytes:
    """A record; `length` where it lies about itself."""
    return struct.pack("<BQ", opcode, (len(content) if length is None else length) % 2**64) + content


def message(channel: int, sequence: int, log: int, publish: int, data: bytes) -> bytes:
    """The content of a message record."""
    return struct.pack("<HIQQ", channel % 2**16, sequence % 2**32, log % 2**64, publish % 2**64) + data


def joint_state(stamp: int, position: float) -> bytes:
    """CDR of a sensor_msgs/JointState of one joint."""
    head = struct.pack("<iI", stamp // 10**9 % 2**31, stamp % 10**9) + text("\0")
    named = head + b"\0" * (-len(head) % 4) + struct.pack("<I", 1) + text("swirl_shaft\0")
    counted = named + b"\0" * (-len(named) % 4) + struct.pack("<I", 1)
    return b"\0\1\0\0" + counted + b"\0" * (-len(counted) % 8) + struct.pack("<d", position) + struct.pack("<II", 0, 0)


def payload(chance: random.Random, topic: str, stamp: int) -> bytes:
    """A message that is right."""
    if topic == "/joint_states":
        return joint_state(stamp, chance.uniform(0.0, 1.5))
    if topic == "/clock":
        return b"\0\1\0\0" + struct.pack("<iI", stamp // 10**9, stamp % 10**9)
    return b"\0\1\0\0" + struct.pack("<d", chance.uniform(-1.0, 1.0))


def wrong_payload(chance: random.Random, data: bytes) -> bytes:
    """A message with another number, or other bytes."""
    if len(data) >= 12 and chance.random() < 0.5:
        return data[:4] + struct.pack("<d", number(chance)) + data[12:]
    return mutated_bytes(chance, data)


def records(chance: random.Random, wrong: float) -> tuple[list[bytes], list[bytes]]:
    """Declarations and messages, each wrong with the chance `wrong`."""
    declared, sent = [], []
    topics = [topic for topic in TOPICS if topic in ("/hall_voltage", "/duty") or chance.random() < 0.4]
    for number_of, topic in enumerate(topics, 1):
        kind, name, encoding = TOPICS[topic], topic, "cdr"
        if chance.random() < wrong:
            name, encoding = chance.choice((*NAMES, topic)), chance.choice(("cdr", "json", "", "\x1b[1m"))
            kind = chance.choice((kind, kind, *NAMES))
        declared.append(record(3, struct.pack("<H", number_of) + text(kind) + text("ros2msg") + text("float64 data")))
        channel = struct.pack("<HH", number_of, number_of) + text(name) + text(encoding) + struct.pack("<I", 0)
        declared.append(record(4, channel))
    start = chance.choice((0, 10**9, 1_700_000_000 * 10**9))
    for k in range(chance.choice((0, 1, 2, 20, 40))):
        for number_of, topic in enumerate(topics, 1):
            log = publish = start + 2_000_000 * k
            data, sequence, length = payload(chance, topic, log), k, None
            if chance.random() < wrong / 4:
                data = wrong_payload(chance, data)
                log, publish, sequence = (chance.choice((log, integer(chance))) for _ in range(3))
            content = message(number_of, sequence, log, publish, data)
            if chance.random() < wrong / 20:
                length = integer(chance)
            sent.append(record(5, content, length))
    return declared, sent


def chunk(chance: random.Random, content: bytes, wrong: float) -> bytes:
    """A chunk record around records, its sizes, compression and checksum wrong with the chance `wrong`."""
    kind = chance.choice(("", "zstd", "lz4"))
    packed = compressed(kind, content)
    size, checksum, named = len(content), zlib.crc32(content) if chance.random() < 0.5 else 0, kind
    if chance.random() < wrong:
        size = integer(chance) % 2**64
    if chance.random() < wrong / 2:
        named = chance.choice(("", "zstd", "lz4", "gzip", "\0", "z" * 3000))
    if chance.random() < wrong / 2:
        packed = mutated_bytes(chance, packed)
    length = len(packed) if chance.random() > wrong / 3 else integer(chance) % 2**64
    head = struct.pack("<QQQI", 0, 2**62, size, checksum) + text(named) + struct.pack("<Q", length)
    return record(6, head + packed)


def compressed(kind: str, content: bytes) -> bytes:
    """`content` as the compression `kind` packs it."""
    if kind == "zstd":
        return zstandard.ZstdCompressor(level=1).compress(content)
    return lz4.frame.compress(content) if kind == "lz4" else content


def bomb(chance: random.Random) -> bytes:
    """Chunks that unpack to far more than they are."""
    inner = chance.choice((bytes(1 << 16), record(0x80, b"") * 7000, record(5, message(1, 0, 0, 0, b"")) * 2000))
    packed = compressed(kind := chance.choice(("zstd", "lz4")), inner * (BOMB // len(inner)))
    size = chance.choice((BOMB // len(inner) * len(inner), 2**40, 0))
    head = struct.pack("<QQQI", 0, 2**62, size, 0) + text(kind) + struct.pack("<Q", len(packed))
    return record(6, head + packed) * chance.choice((1, 4, 60))


def mcap(chance: random.Random) -> bytes:
    """An MCAP file, near to one that a recorder writes."""
    wrong = chance.choice((0.0, 0.1, 0.3, 1.0))
    declared, sent = records(chance, wrong)
    parts = [*declared, *sent]
    if chance.random() < 0.2:
        chance.shuffle(parts)
    body = b"".join(parts)
    if chance.random() < 0.7:
        middle = chance.randint(0, len(parts))
        body = chunk(chance, b"".join(parts[:middle]), wrong) + chunk(chance, b"".join(parts[middle:]), wrong)
    if chance.random() < 0.1:
        body = chunk(chance, body, wrong)
    if chance.random() < 0.004:
        body = b"".join(declared) + bomb(chance) + body
    content = MAGIC + record(1, text("ros2") + text("fuzz")) + body + record(15, struct.pack("<I", 0)) + MAGIC
    return mutated_bytes(chance, content) if chance.random() < 0.6 else content
