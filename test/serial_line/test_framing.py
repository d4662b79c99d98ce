"""Frames against the definitions of COBS and of the CRC, and against what a line does to bytes."""

import random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pierburg_ros.serial_line.framing import Frames, checksum, encoded, stuffed, unstuffed


def test_the_crc_is_that_of_its_catalogue():
    assert checksum(b"123456789") == 0x29B1


@pytest.mark.parametrize(
    "data, sent",
    [
        (b"", "01"),
        (b"\x00", "0101"),
        (b"\x00\x00", "010101"),
        (b"\x11\x22\x00\x33", "0311220233"),
        (b"\x11\x00\x00\x00", "0211010101"),
        (bytes(range(1, 255)), "ff" + bytes(range(1, 255)).hex()),
        (bytes(range(1, 256)), "ff" + bytes(range(1, 255)).hex() + "02ff"),
        (b"\x00" + bytes(range(1, 255)), "01ff" + bytes(range(1, 255)).hex()),
    ],
)
def test_stuffing_gives_the_published_examples(data, sent):
    assert stuffed(data).hex() == sent


@given(st.binary(max_size=600))
def test_stuffing_leaves_no_zero_and_is_undone(data):
    assert b"\x00" not in stuffed(data)
    assert unstuffed(stuffed(data)) == data


@given(st.binary(max_size=600))
def test_any_bytes_are_refused_or_undone_without_an_error(data):
    result = unstuffed(data)
    assert result is None or stuffed(result) == data or b"\x00" in data or len(data) == 0


@given(st.lists(st.binary(min_size=1, max_size=40), max_size=8), st.integers(1, 7))
def test_frames_survive_any_cut_of_the_stream(payloads, size):
    stream = b"".join(map(encoded, payloads))
    frames = Frames()
    taken = [p for first in range(0, len(stream), size) for p in frames.take(stream[first : first + size])]
    assert taken == payloads
    assert frames.damaged == 0


@pytest.mark.parametrize("fault", ["dropped", "changed", "repeated"])
def test_a_byte_lost_changed_or_repeated_costs_two_frames_at_most(fault):
    generator = random.Random(5)
    for _ in range(500):
        payloads = [generator.randbytes(20) for _ in range(5)]
        stream = bytearray(b"".join(map(encoded, payloads)))
        at = generator.randrange(len(stream))
        if fault == "dropped":
            del stream[at]
        elif fault == "changed":
            stream[at] ^= 1 << generator.randrange(8)
        else:
            stream.insert(at, stream[at])
        taken = Frames().take(bytes(stream))
        assert all(payload in payloads for payload in taken)
        assert len(taken) >= 3


def test_noise_without_end_is_dropped_and_the_next_frame_is_read():
    frames = Frames()
    assert frames.take(b"\x55" * 10_000) == []
    assert frames.take(encoded(b"good")) == [b"good"]
    assert frames.damaged >= 1
