"""A time by which work has to come to its end with what it has."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import TypeVar

Result = TypeVar("Result")


class OutOfTime(BaseException):
    """The time is over: like an interrupt from the keyboard it waits for nothing."""


class Deadline:
    """So many `seconds` from now; None: no limit but an interrupt.

    deadline = Deadline(30.0)
    found = deadline.attempt(lambda: long_work(deadline.check), otherwise=nothing)
    deadline.stopped  # whether the time was over, or Ctrl-C came, before the work was done
    """

    def __init__(self, seconds: float | None = None) -> None:
        self._end = math.inf if seconds is None else time.monotonic() + seconds
        self._parent: Deadline | None = None
        self.stopped = False

    @property
    def left(self) -> float:
        """Time that is left [s], not below 0; infinite where there is no limit."""
        return max(self._end - time.monotonic(), 0.0)

    def part(self, share: float) -> Deadline:
        """One that ends when this `share` of what is left of it is over; where that stops, it is noted here too."""
        part = Deadline(None if math.isinf(self._end) else share * self.left)
        part._parent = self
        return part

    def check(self) -> None:
        """OutOfTime once the time is over."""
        if self.left <= 0.0:
            raise OutOfTime

    def attempt(self, work: Callable[[], Result], otherwise: Result) -> Result:
        """What `work` gives, or `otherwise` where the time is over or Ctrl-C comes before it has ended.

        After Ctrl-C no time is left for anything else.
        """
        try:
            self.check()
            return work()
        except OutOfTime:
            self._stop()
        except KeyboardInterrupt:
            self._stop(interrupted=True)
        return otherwise

    def _stop(self, interrupted: bool = False) -> None:
        self.stopped = True
        if interrupted:
            self._end = -math.inf
        if self._parent is not None:
            self._parent._stop(interrupted)
