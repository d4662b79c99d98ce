"""Ticks on a steady clock that are late rather than lost, and counted when they are.

`rclpy` timers drop the ticks they miss without a word. Of the ways compared in `benchmarks/pacing.py`, a
thread that sleeps until the next deadline kept the grid best on a loaded machine.
"""

from __future__ import annotations

import time
from collections.abc import Callable


class Pacer:
    """Deadlines `period` [s] apart; 0 runs free. The period may be changed between two ticks."""

    def __init__(
        self,
        period: float,
        clock: Callable[[], float] = time.monotonic,
        sleep: Callable[[float], None] = time.sleep,
    ) -> None:
        self.period = period
        self.skipped = 0
        self._clock = clock
        self._sleep = sleep
        self._deadline = clock()

    def wait(self) -> None:
        """Sleep until the next deadline; deadlines that passed meanwhile are skipped and counted."""
        if self.period <= 0.0:
            return
        self._deadline += self.period
        left = self._deadline - self._clock()
        if left > 0.0:
            self._sleep(left)
            return
        missed = int(-left / self.period)
        self.skipped += missed
        self._deadline += missed * self.period

    def restart(self) -> None:
        """Count deadlines from now, after a wait that was not a delay."""
        self._deadline = self._clock()
