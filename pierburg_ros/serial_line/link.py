"""The conversation with a device: states in their order with times of the host, and what was lost on the way."""

from __future__ import annotations

import math
from dataclasses import dataclass

from pierburg_ros.serial_line.clock import DeviceClock
from pierburg_ros.serial_line.framing import Frames, encoded
from pierburg_ros.serial_line.messages import NUMBERS, TICKS, Command, State, state

MICROSECOND = 1000
"""Nanoseconds in a tick of the device's clock."""


@dataclass(frozen=True)
class Received:
    """A state, the host's time at which it was sampled [ns], and whether the device started anew before it."""

    state: State
    time: int
    restarted: bool


class Link:
    """Takes bytes from the line and gives states; makes the bytes of commands."""

    def __init__(self) -> None:
        self.lost = 0
        self.repeated = 0
        self.restarts = 0
        self.foreign = 0
        self._frames = Frames()
        self._clock = DeviceClock()
        self._before: State | None = None
        self._ticks = 0
        self._commands = 0

    @property
    def damaged(self) -> int:
        """Frames that came damaged."""
        return self._frames.damaged

    @property
    def rate(self) -> float:
        """Rate of the host's clock over the device's, minus one."""
        return self._clock.rate

    def command(self, duty: float, timeout: float) -> bytes:
        """The bytes that ask for a duty [1] that holds for `timeout` [s] at most."""
        self._commands = (self._commands + 1) % NUMBERS
        milliseconds = math.ceil(timeout * 1000.0)
        return encoded(Command(self._commands, milliseconds, duty).packed())

    def take(self, data: bytes, arrival: int) -> list[Received]:
        """States in `data`, which arrived at `arrival` [ns] of the host's clock."""
        states = (self._state(payload) for payload in self._frames.take(data))
        received = (self._received(each, arrival) for each in states if each is not None)
        return [each for each in received if each is not None]

    def _state(self, payload: bytes) -> State | None:
        found = state(payload)
        self.foreign += found is None
        return found

    def _received(self, now: State, arrival: int) -> Received | None:
        before, restarted = self._before, False
        if before is not None and now.boots != before.boots:
            restarted = True
            self.restarts += 1
            self._clock, self._ticks, before = DeviceClock(), now.ticks, None
        if before is None:
            self._ticks = now.ticks
        else:
            step = (now.number - before.number) % NUMBERS
            if step == 0 or step > NUMBERS // 2:
                self.repeated += 1
                return None
            self.lost += step - 1
            self._ticks += (now.ticks - before.ticks) % TICKS
        self._before = now
        return Received(now, self._clock.host(self._ticks * MICROSECOND, arrival), restarted)
