"""A time by which work has to come to its end with what it has."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import TypeVar

Result = TypeVar("Result")

USUAL_BUDGET = 120.0
"""Time [s] after which the best verdict yet of a diagnosis is given unless told otherwise."""
SLOWEST_MACHINE = 5.0
"""How many times longer than on an idle machine a deadline may be put off. Chosen: eight busy processes beside the two
threads of a diagnosis leave them two fifths of a core, 2.5 times as long for as much work; not varied."""


class OutOfTime(BaseException):
    """The time is over: like an interrupt from the keyboard it waits for nothing."""


class Deadline:
    """So many `seconds` of an idle machine from now; None: no limit but an interrupt.

    Time in which others take the processor counts less, so that a busy machine does not change a verdict: the end has
    come when the process has worked for as much processor time as it takes in so many seconds of an idle machine, or
    `SLOWEST_MACHINE` times as many have gone by. `pace` is the processor time that it takes in a second there.

    deadline = Deadline(30.0)
    found = deadline.attempt(lambda: long_work(deadline.check), otherwise=nothing)
    deadline.stopped  # whether the time was over, or Ctrl-C came, before the work was done
    """

    def __init__(self, seconds: float | None = None, pace: float = 1.0) -> None:
        self._seconds = math.inf if seconds is None else seconds
        self._pace = pace
        self._begun, self._worked = time.monotonic(), time.process_time()
        self._parent: Deadline | None = None
        self._told = True
        self.stopped = False

    @property
    def left(self) -> float:
        """Time that is left at least [s], not below 0; infinite where there is no limit."""
        return max(self._seconds - self.spent, 0.0)

    @property
    def spent(self) -> float:
        """Time that has gone by [s]."""
        gone, worked = time.monotonic() - self._begun, time.process_time() - self._worked
        return max(min(gone, worked / self._pace), gone / SLOWEST_MACHINE)

    def part(self, share: float) -> Deadline:
        """One that ends when this `share` of what is left of it is over; where that stops, it is noted here too."""
        return self._within(share * self.left, told=True)

    def at_most(self, seconds: float) -> Deadline:
        """One that ends after so many `seconds`, or with this one; without end where this one has none.

        For what can be left undone: that its time was over is not noted here, but an interrupt is.
        """
        return self._within(min(seconds, self.left), told=seconds >= self.left)

    def _within(self, seconds: float, told: bool) -> Deadline:
        """One of so many `seconds`, without end where this one has none; it may be `told` that their time is over."""
        part = Deadline(None if math.isinf(self._seconds) else seconds, self._pace)
        part._parent, part._told = self, told
        return part

    def check(self) -> None:
        """Raise OutOfTime once the time is over."""
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
            self._seconds = -math.inf
        if self._parent is not None and (interrupted or self._told):
            self._parent._stop(interrupted)
