"""Messages put back into the order in which they were sent, and simulated time looked up by it."""

from __future__ import annotations

import heapq
from bisect import bisect_right
from dataclasses import dataclass, field
from typing import Generic, TypeVar

Item = TypeVar("Item")
KEPT_READINGS = 10_000
"""Clock readings kept for looking up times: ten seconds at 1 kHz."""
LONGEST_HOLD = 20.0
"""Longest time [s] that anything is held back; older than that on arrival is the past of a latched topic."""
MEMORY = 2.0
"""Time [s] for which a late arrival keeps the others waiting; one round of repair takes well below a second."""
MARGIN = 1.5
"""What is held back beyond the latest arrival: the next one may be later still."""


@dataclass(order=True)
class _Waiting(Generic[Item]):
    sent: int
    arrival: int
    item: Item = field(compare=False)


class SourceOrder(Generic[Item]):
    """Holds items back for a moment and gives them out in the order of their sending.

    After a stall all that was sent meanwhile arrives late, one topic after another. The moment then becomes longer
    than the latest of them took, so that the topics are in order among each other too.
    """

    def __init__(self, horizon: float) -> None:
        """`horizon` [s]: how long an item is held back while none is late."""
        self._horizon = round(horizon * 1e9)
        self._waiting: list[_Waiting[Item]] = []
        self._arrivals = 0
        self._late = 0
        self._late_at = 0

    def put(self, sent: int, item: Item, taken: int | None = None) -> None:
        """Add an item sent at `sent` and taken at `taken` [ns]."""
        self._arrivals += 1
        age = (sent if taken is None else taken) - sent
        if self._horizon < age * MARGIN < LONGEST_HOLD * 1e9:
            now = sent + age
            self._late = max(age, self._late if now - self._late_at < MEMORY * 1e9 else 0)
            self._late_at = now
        heapq.heappush(self._waiting, _Waiting(sent, self._arrivals, item))

    def due(self, now: int) -> list[Item]:
        """Items sent before the horizon, `now` [ns] being the present."""
        late = self._late if now - self._late_at < MEMORY * 1e9 else 0
        return self.until(now - max(self._horizon, round(MARGIN * late)))

    def until(self, time: float) -> list[Item]:
        """Items sent up to `time` [ns]; all that are left up to infinity."""
        found = []
        while self._waiting and self._waiting[0].sent <= time:
            found.append(heapq.heappop(self._waiting).item)
        return found


class SimulatedTime:
    """Which simulated time was in force when something was sent."""

    def __init__(self) -> None:
        self._sent: list[int] = []
        self._clock: list[int] = []
        self._first: int | None = None

    def reading(self, sent: int, clock: int) -> None:
        """The clock said `clock` [ns] from `sent` [ns] on; readings come in the order of sending."""
        self._first = sent if self._first is None else self._first
        self._sent.append(sent)
        self._clock.append(clock)
        if len(self._sent) > 2 * KEPT_READINGS:
            del self._sent[:KEPT_READINGS], self._clock[:KEPT_READINGS]

    def at(self, sent: int) -> int | None:
        """The simulated time [ns] at `sent` [ns]; None before the first reading."""
        if self._first is None or sent < self._first:
            return None
        return self._clock[max(bisect_right(self._sent, sent) - 1, 0)]
