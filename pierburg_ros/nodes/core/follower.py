"""How far the source of simulated time may run ahead of a recorder. Knows no ROS."""

from __future__ import annotations

import time
from collections.abc import Callable

TICKS_AHEAD = 1000
"""Ticks that the source may be ahead: a tenth of what publishers and readers keep, so that nothing is pushed out,
and at 5000 ticks a second 20 turns of the recorder's reading, so that a run is hardly slowed down."""
RECORDER_PATIENCE = 15.0
"""Longest wait [s] for a recorder that does not move: half as long again as the 10 s for which any process may
be without a processor. One that was killed is told from a stopped one by nothing else."""


class Follower:
    """What a recorder says it has got, and whether the source must wait for it."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._until: int | None = None
        self._moved = 0.0
        self.given_up = False

    def progress(self, until: int) -> None:
        """A recorder has everything up to the simulated time `until` [ns]; it is followed from here on."""
        if self._until is None or until != self._until:
            self._moved = self._clock()
        self._until = until

    def must_wait(self, now: int, period: int) -> bool:
        """Whether the tick at `now` [ns] is too far ahead, ticks being `period` [ns] apart.

        A recorder that stays where it is is given up, until it has caught up.
        """
        if self._until is None:
            return False
        if now - self._until <= TICKS_AHEAD * period:
            self.given_up = False
            self._moved = self._clock()
            return False
        if self._clock() - self._moved > RECORDER_PATIENCE:
            self.given_up = True
        return not self.given_up
