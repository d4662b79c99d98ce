"""Frames on a stream of bytes: COBS between zeros, closed by a CRC-16, so that any byte lost costs one frame."""

from __future__ import annotations

import binascii
import struct

END = b"\x00"
"""Ends a frame, and occurs nowhere in it."""
LONGEST_FRAME = 256
"""Most bytes of a frame as sent; more without an end is noise, and is dropped."""
RUN = 254
"""Most bytes between two codes of COBS."""


def encoded(payload: bytes) -> bytes:
    """The frame of a payload as it goes over the line: payload and CRC, stuffed (COBS), between zeros.

    The zero in front ends what a lost byte may have left open.
    """
    return END + stuffed(payload + struct.pack("<H", checksum(payload))) + END


def checksum(payload: bytes) -> int:
    """CRC-16 with polynomial 0x1021, begun with 0xFFFF (CRC-16/IBM-3740, known as CCITT-FALSE)."""
    return binascii.crc_hqx(payload, 0xFFFF)


def stuffed(data: bytes) -> bytes:
    """`data` without zeros: each run up to a zero is preceded by its length and one (COBS, Cheshire and Baker 1999)."""
    out = bytearray()
    runs = data.split(END)
    for index, run in enumerate(runs):
        while len(run) >= RUN:
            out += bytes([RUN + 1]) + run[:RUN]
            run = run[RUN:]
            if not run and index == len(runs) - 1:
                return bytes(out)
        out += bytes([len(run) + 1]) + run
    return bytes(out)


def unstuffed(data: bytes) -> bytes | None:
    """What `stuffed` was given; None where this is not its result."""
    out = bytearray()
    at = 0
    while at < len(data):
        code = data[at]
        run = data[at + 1 : at + code]
        if code == 0 or len(run) != code - 1 or END in run:
            return None
        out += run
        at += code
        if code <= RUN and at < len(data):
            out += END
    return bytes(out)


class Frames:
    """Takes bytes as they come and gives the payloads of whole frames; what is damaged is counted."""

    def __init__(self) -> None:
        self.damaged = 0
        self._waiting = bytearray()

    def take(self, data: bytes) -> list[bytes]:
        """Payloads of the frames that end in `data`."""
        self._waiting += data
        *frames, rest = self._waiting.split(END)
        if len(rest) > LONGEST_FRAME:
            self.damaged += 1
            rest = bytearray()
        self._waiting = bytearray(rest)
        payloads = [self._payload(bytes(frame)) for frame in frames if frame]
        return [payload for payload in payloads if payload is not None]

    def _payload(self, frame: bytes) -> bytes | None:
        data = unstuffed(frame) if len(frame) <= LONGEST_FRAME else None
        if data is None or len(data) < 3 or checksum(data[:-2]) != struct.unpack("<H", data[-2:])[0]:
            self.damaged += 1
            return None
        return data[:-2]
