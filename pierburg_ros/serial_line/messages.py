"""What the frames say: commands to the device, states from it. Little endian, version in the first byte."""

from __future__ import annotations

import struct
from dataclasses import dataclass

COMMAND = 0x11
"""First byte of a command: kind 1 of version 1."""
STATE_KIND = 0x21
"""First byte of a state: kind 2 of version 1."""
NUMBERS = 0x10000
"""Sequence numbers wrap at this."""
TICKS = 1 << 32
"""The device's microseconds wrap at this, after 71.6 minutes."""
_COMMAND = struct.Struct("<BHHf")
_STATE = struct.Struct("<BHIBBHfff")
_ENABLED, _TIMED_OUT = 0x01, 0x02


@dataclass(frozen=True)
class Command:
    """`duty` in [-1, 1] that holds for `timeout` [ms] at most, 0 for ever; `number` counts commands."""

    number: int
    timeout: int
    duty: float

    def packed(self) -> bytes:
        """The payload."""
        return _COMMAND.pack(COMMAND, self.number % NUMBERS, min(self.timeout, NUMBERS - 1), self.duty)


@dataclass(frozen=True)
class State:
    """One sample of the device, taken at `ticks` [us] of its clock.

    `duty` acts from this sample to the next; `supply_voltage` is NaN where none is measured; `boots` changes with
    every start of the device; `answered` is the number of the last command taken.
    """

    number: int
    ticks: int
    boots: int
    enabled: bool
    timed_out: bool
    answered: int
    hall_voltage: float  # [V]
    duty: float  # [1]
    supply_voltage: float  # [V]

    def packed(self) -> bytes:
        """The payload."""
        flags = _ENABLED * self.enabled | _TIMED_OUT * self.timed_out
        whole = (self.number % NUMBERS, self.ticks % TICKS, self.boots % 256, flags, self.answered % NUMBERS)
        return _STATE.pack(STATE_KIND, *whole, self.hall_voltage, self.duty, self.supply_voltage)


def command(payload: bytes) -> Command | None:
    """The command in a payload; None where it holds none."""
    if len(payload) != _COMMAND.size or payload[0] != COMMAND:
        return None
    _, number, timeout, duty = _COMMAND.unpack(payload)
    return Command(number, timeout, duty)


def state(payload: bytes) -> State | None:
    """The state in a payload; None where it holds none."""
    if len(payload) != _STATE.size or payload[0] != STATE_KIND:
        return None
    _, number, ticks, boots, flags, answered, hall_voltage, duty, supply = _STATE.unpack(payload)
    enabled, timed_out = bool(flags & _ENABLED), bool(flags & _TIMED_OUT)
    return State(number, ticks, boots, enabled, timed_out, answered, hall_voltage, duty, supply)
