"""Messages put back into the order in which they were sent, and simulated time looked up by it."""

from __future__ import annotations

import heapq
from bisect import bisect_right
from dataclasses import dataclass, field
from typing import Generic, TypeVar

Item = TypeVar("Item")
KEPT = 10_000
"""Clock readings kept for looking up times: ten seconds at 1 kHz."""


@dataclass(order=True)
class _Waiting(Generic[Item]):
    sent: int
    arrival: int
    item: Item = field(compare=False)


class SourceOrder(Generic[Item]):
    """Holds items back for a moment and gives them out in the order of their sending."""

    def __init__(self, horizon: float) -> None:
        """`horizon` [s]: how long an item is held back."""
        self._horizon = round(horizon * 1e9)
        self._waiting: list[_Waiting[Item]] = []
        self._arrivals = 0

    def put(self, sent: int, item: Item) -> None:
        """Add an item sent at `sent` [ns]."""
        self._arrivals += 1
        heapq.heappush(self._waiting, _Waiting(sent, self._arrivals, item))

    def due(self, now: int) -> list[Item]:
        """Items sent before the horizon, `now` [ns] being the present."""
        found = []
        while self._waiting and self._waiting[0].sent <= now - self._horizon:
            found.append(heapq.heappop(self._waiting).item)
        return found

    def rest(self) -> list[Item]:
        """All items that are left."""
        return [heapq.heappop(self._waiting).item for _ in range(len(self._waiting))]


class SimulatedTime:
    """Which simulated time was in force when something was sent."""

    def __init__(self) -> None:
        self._sent: list[int] = []
        self._clock: list[int] = []

    def reading(self, sent: int, clock: int) -> None:
        """The clock said `clock` [ns] from `sent` [ns] on; readings come in the order of sending."""
        self._sent.append(sent)
        self._clock.append(clock)
        if len(self._sent) > 2 * KEPT:
            del self._sent[:KEPT], self._clock[:KEPT]

    def at(self, sent: int) -> int:
        """The simulated time [ns] at `sent` [ns]; before the first reading, that one."""
        if not self._clock:
            return 0
        return self._clock[max(bisect_right(self._sent, sent) - 1, 0)]
