"""MCAP files that no recorder writes, each the smallest that once ended in a traceback, a hang or no memory."""

import resource
import struct
import zlib

import lz4.frame
import pytest
import zstandard
from fuzzing.mcap_input import FLOAT64, MAGIC, message, record, text

from pierburg_ros.errors import InputError
from pierburg_ros.recording import read_recording

SCHEMA = record(3, struct.pack("<H", 1) + text(FLOAT64) + text("ros2msg") + text("float64 data"))
END = record(15, struct.pack("<I", 0)) + MAGIC


def channel(number: int, topic: str, encoding: str = "cdr") -> bytes:
    return record(4, struct.pack("<HH", number, 1) + text(topic) + text(encoding) + struct.pack("<I", 0))


DECLARED = SCHEMA + channel(1, "/hall_voltage") + channel(2, "/duty")


def sample(number: int, k: int, value: float = 0.5, time: int | None = None) -> bytes:
    when = 2_000_000 * k if time is None else time
    return record(5, message(number, k, when, when, b"\0\1\0\0" + struct.pack("<d", value)))


SAMPLES = b"".join(sample(number, k) for k in range(1, 20) for number in (1, 2))


def chunk(packed: bytes, kind: str, size: int, checksum: int = 0) -> bytes:
    head = struct.pack("<QQQI", 0, 2**62, size, checksum) + text(kind) + struct.pack("<Q", len(packed))
    return record(6, head + packed)


def zstd(content: bytes) -> bytes:
    return zstandard.ZstdCompressor(level=1).compress(content)


NESTED = chunk(SAMPLES, "", len(SAMPLES))


@pytest.fixture
def refusal(tmp_path):
    def refused(body: bytes, end: bytes = END) -> str:
        path = tmp_path / "run.mcap"
        path.write_bytes(MAGIC + body + end)
        with pytest.raises(InputError) as refused:
            read_recording(path)
        return str(refused.value)

    return refused


@pytest.mark.parametrize("packed", [zstd, lz4.frame.compress, bytes])
def test_the_same_records_are_right_in_any_packing(tmp_path, packed):
    kind = {zstd: "zstd", lz4.frame.compress: "lz4", bytes: ""}[packed]
    path = tmp_path / "run.mcap"
    path.write_bytes(MAGIC + DECLARED + chunk(packed(SAMPLES), kind, len(SAMPLES), zlib.crc32(SAMPLES)) + END)
    assert read_recording(path).time.size == 19


@pytest.mark.parametrize(
    ("body", "reason"),
    [
        (record(3, b"\1\0" + struct.pack("<I", 2**32 - 1)), "a text of 4294967295 bytes"),
        (record(3, b"\1"), "is damaged after 0 messages"),
        (record(4, b"\1\0\1\0" + struct.pack("<I", 2) + b"\xff\xff" + text("cdr")), "is damaged after 0 messages"),
        (DECLARED + sample(9, 1), "channel 9, which is not declared"),
        (DECLARED + record(5, b"short"), "is damaged after 0 messages"),
        (DECLARED + SAMPLES + bytes(100), "zeros in place of a record"),
        (DECLARED + SAMPLES + record(5, b"", 2**64 - 1), "a record reaches beyond the end of a finished file"),
        (DECLARED + chunk(zstd(SAMPLES), "zstd", 2**63), "a chunk of"),
        (DECLARED + chunk(zstd(SAMPLES), "zstd", len(SAMPLES) - 1), "unpack to more than"),
        (DECLARED + chunk(zstd(SAMPLES), "zstd", len(SAMPLES) + 1), "size or checksum is another"),
        (DECLARED + chunk(zstd(SAMPLES), "zstd", len(SAMPLES), 7), "size or checksum is another"),
        (DECLARED + chunk(zstd(SAMPLES)[:-9], "zstd", len(SAMPLES)), "is damaged"),
        (DECLARED + chunk(b"not a frame of lz4", "lz4", 10), "is damaged after 0 messages (lz4"),
        (DECLARED + chunk(SAMPLES, "gzip", len(SAMPLES)), "the compression 'gzip' is unknown"),
        (DECLARED + chunk(NESTED, "", len(NESTED)), "a record of type 6"),
        (SCHEMA + channel(1, "/hall_voltage", "json") + sample(1, 1), "is encoded as 'json', expected 'cdr'"),
    ],
)
def test_damage_is_one_line(refusal, body, reason):
    assert reason in refusal(body)


@pytest.mark.parametrize("time", [2**63, 2**64 - 1])
def test_times_beyond_63_bits_are_refused(refusal, time):
    assert "expected a time before the year 2262" in refusal(DECLARED + SAMPLES + sample(1, 20, time=time))


@pytest.mark.parametrize("value", [1e300, -1e10])
def test_values_beyond_any_sensor_are_refused(refusal, value):
    assert "expected magnitudes up to 1e+09" in refusal(DECLARED + SAMPLES + sample(1, 20, value))


def test_a_span_of_centuries_is_refused(refusal):
    late = 10**17
    body = DECLARED + SAMPLES + sample(1, 20, time=late) + sample(2, 20, time=late)
    assert "spans 1e+08 s with 20 samples, expected at most 1,200 s" in refusal(body)


@pytest.mark.parametrize(("packed", "kind"), [(zstd, "zstd"), (lz4.frame.compress, "lz4")])
@pytest.mark.parametrize("declared", [0, 1 << 20, 200 << 20, 2**40])
def test_a_bomb_is_refused_before_it_fills_the_memory(refusal, packed, kind, declared):
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    bomb = packed(bytes(300 << 20))
    assert "run.mcap is damaged" in refusal(DECLARED + chunk(bomb, kind, declared) * 3)
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 900 << 10  # KiB; 300 MiB are the test's own


def test_more_records_than_a_file_can_hold_are_refused(refusal):
    tiny = record(0x80, b"") * 100_000
    assert "more records than" in refusal(DECLARED + chunk(zstd(tiny), "zstd", len(tiny)) * 3)


def test_the_densest_recording_reads(tmp_path):
    """Constant values at perfectly regular times, packed as small as they get."""
    records = b"".join(sample(number, k) for k in range(1, 100_000) for number in (1, 2))
    packed = zstandard.ZstdCompressor(level=19).compress(records)
    path = tmp_path / "run.mcap"
    path.write_bytes(MAGIC + DECLARED + chunk(packed, "zstd", len(records)) + END)
    assert read_recording(path).time.size == 99_999


def test_a_file_without_its_end_reads_as_far_as_it_goes(tmp_path):
    path = tmp_path / "run.mcap"
    path.write_bytes(MAGIC + DECLARED + SAMPLES + sample(1, 20)[:-3])
    assert read_recording(path).time.size == 19
