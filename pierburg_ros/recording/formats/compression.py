"""Unpacks zstd and LZ4 up to a size that is known before, so that a few bytes cannot fill the memory."""

from __future__ import annotations

from typing import BinaryIO

import lz4.frame
import zstandard

from pierburg_ros.errors import InputError

MOST_UNPACKED = 256 << 20
"""Bytes of one chunk or message at most. Recorders write chunks of 1 to 10 MiB, and one message if it is larger."""
RATIO = 1000
"""Bytes unpacked per byte of file at most. Messages differ in time and sequence and shrink to a thirtieth; only large
constant ones, as black pictures, shrink further."""
ZSTD_WINDOW = 128 << 20
"""Bytes of history that zstd may ask for; its own tools refuse more unless told otherwise."""
READ_BLOCK = 1 << 20


class Damaged(ValueError):
    """Content that is not what its writer wrote."""


def unpacked(kind: str, data: bytes, most: int = MOST_UNPACKED) -> bytes:
    """`data` unpacked by the compression `kind`: zstd, lz4, or empty for none."""
    try:
        content = read_up_to(kind, data, most)
    except (zstandard.ZstdError, RuntimeError, EOFError) as error:
        raise Damaged(f"{kind}: {error}") from error
    if len(content) > most:
        raise Damaged(f"{len(data)} bytes unpack to more than {most}")
    return content


def read_up_to(kind: str, data: bytes, most: int) -> bytes:
    """At most one byte more than `most`."""
    if kind == "":
        return data
    if kind == "zstd":
        return bytes(zstandard.ZstdDecompressor(max_window_size=ZSTD_WINDOW).stream_reader(data).read(most + 1))
    if kind == "lz4":
        return bytes(lz4.frame.LZ4FrameDecompressor().decompress(data, max_length=most + 1))
    raise Damaged(f"the compression {kind!r} is unknown")


def most_unpacked(size: int) -> int:
    """Bytes that a file of `size` bytes may unpack to in all."""
    return RATIO * size + MOST_UNPACKED


def unpack_file(source: BinaryIO, target: BinaryIO, most: int, name: str) -> None:
    """Unpack the zstd file `source` into `target`, `most` bytes at most."""
    reader = zstandard.ZstdDecompressor(max_window_size=ZSTD_WINDOW).stream_reader(source, read_across_frames=True)
    try:
        while block := reader.read(READ_BLOCK):
            target.write(block)
            if target.tell() > most:
                raise InputError(
                    f"{name} unpacks to more than {most >> 20} MiB, expected a recording. Unpack it first."
                )
    except zstandard.ZstdError as error:
        raise InputError(f"{name} is damaged ({error}), expected a file packed with zstd. Record again.") from error
