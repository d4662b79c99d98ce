"""A device at the end of a serial line, with the simulated valve behind it: what a firmware would do."""

from __future__ import annotations

import contextlib
import os
import threading
import time
from collections.abc import Callable

from pierburg_ros.actuators import read_actuator
from pierburg_ros.plant import Model, Plant
from pierburg_ros.serial_line.framing import Frames, encoded
from pierburg_ros.serial_line.messages import State, command


class SimulatedDevice:
    """Samples every `period` [s] of its own clock; a duty without successor ends after the time-out it came with."""

    def __init__(self, period: float = 0.002, ticks: int = 0, number: int = 0) -> None:
        self.period = period
        self.boots = 1
        self.ticks = ticks
        self.enabled = True
        self.supply_voltage = 13.5
        self._plant = Plant(Model.nominal(read_actuator("pierburg")), 0.003)
        self._start()
        self._number = number

    def _start(self) -> None:
        self._frames = Frames()
        self._number = self._answered = 0
        self._duty = 0.0
        self._until: float | None = None
        self.timed_out = False

    def reset(self) -> None:
        """Start anew, as after a brown-out: numbers, clock and duty from the beginning, the shaft where it is."""
        self.boots += 1
        self.ticks = 0
        self._start()

    def take(self, data: bytes) -> None:
        """Obey the commands in bytes from the line."""
        for payload in self._frames.take(data):
            given = command(payload)
            if given is not None:
                self._answered, self._duty, self.timed_out = given.number, given.duty, False
                self._until = self.ticks + given.timeout * 1000 if given.timeout else None

    def tick(self) -> bytes:
        """The bytes of the next sample."""
        if self._until is not None and self.ticks > self._until:
            self._duty, self._until, self.timed_out = 0.0, None, True
        state = State(
            self._number,
            self.ticks,
            self.boots,
            self.enabled,
            self.timed_out,
            self._answered,
            self._plant.measure(),
            self._duty,
            self.supply_voltage,
        )
        self._plant.advance(self._duty, self.period, enabled=self.enabled)
        self._number += 1
        self.ticks += round(self.period * 1e6)
        return encoded(state.packed())


class DeviceOnPty:
    """The device on a pseudo-terminal in a thread; `spoil` may change the bytes it sends."""

    def __init__(self, device: SimulatedDevice) -> None:
        self.device = device
        self.spoil: Callable[[bytes], bytes] = lambda data: data
        self.silent = False
        self._master, slave = os.openpty()
        self.path = os.ttyname(slave)
        self._slave = slave
        os.set_blocking(self._master, False)
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def unplug(self) -> None:
        """Take the line away: the other end gets an error."""
        self._ending.set()
        self._thread.join()
        os.close(self._slave)
        os.close(self._master)

    def _run(self) -> None:
        due = time.monotonic()
        while not self._ending.is_set():
            with contextlib.suppress(BlockingIOError):
                self.device.take(os.read(self._master, 4096))
            if not self.silent:
                with contextlib.suppress(BlockingIOError):
                    os.write(self._master, self.spoil(self.device.tick()))
            due = max(due + self.device.period, time.monotonic() - 0.1)
            time.sleep(max(due - time.monotonic(), 0.0))
