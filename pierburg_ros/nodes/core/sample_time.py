"""Which simulated time a sample was taken at, from the readings of a clock that may tick once a sample or slower."""

from __future__ import annotations

from collections import deque

WAITING_READINGS = 4096
"""Readings that may be waiting for their samples."""
MISSES = 2
"""Samples in a row without a reading of their own after which the clock counts as slower than they are."""
PAIRS = 20
"""Samples in a row with a reading of their own after which it counts as one a sample again."""


class SampleTime:
    """Pairs samples with clock readings by when their senders sent them, both in [ns].

    A clock that ticks for every sample gives its readings unchanged: the same reading again is the same sample sent
    again. Between two ticks of a slower clock the time goes on at the pace of the last two, by at most their
    distance: a clock that stops lets its time stand.
    """

    def __init__(self) -> None:
        self._waiting: deque[tuple[int, int]] = deque(maxlen=WAITING_READINGS)
        self._current: tuple[int, int] | None = None
        self._is_used = False
        self._pace = 1.0
        self._distance = 0
        self._misses = self._pairs = 0
        self._last: int | None = None
        self.paired = True

    def reading(self, sent: int, clock: int) -> None:
        """The clock said `clock` when it was read at `sent`."""
        self._waiting.append((sent, clock))

    def has_own(self, sent: int) -> bool:
        """Whether a reading that no sample has used lies before a sample sent at `sent`."""
        self._advance(sent)
        return self._current is not None and not self._is_used

    def at(self, sent: int) -> int | None:
        """Time of the sample sent at `sent`; None while the clock has not been read."""
        own = self.has_own(sent)
        self._count(own)
        if self._current is None:
            return None
        self._is_used = True
        time = self._current[1] if own or self.paired else self._between(sent, self._current)
        if self._last is not None and self._last - self._distance <= time < self._last and not self.paired:
            time = self._last  # the pace was a little too fast; a clock set back goes back further
        self._last = time
        return time

    def _advance(self, sent: int) -> None:
        while self._waiting and self._waiting[0][0] <= sent:
            reading = self._waiting.popleft()
            if self._current is not None:
                self._measure(self._current, reading)
            self._current, self._is_used = reading, False

    def _measure(self, before: tuple[int, int], after: tuple[int, int]) -> None:
        passed, ticked = after[0] - before[0], after[1] - before[1]
        if passed > 0 and 0 < ticked <= 10 * passed:
            self._pace, self._distance = ticked / passed, ticked

    def _between(self, sent: int, reading: tuple[int, int]) -> int:
        return reading[1] + min(round((sent - reading[0]) * self._pace), self._distance)

    def _count(self, own: bool) -> None:
        self._pairs, self._misses = (self._pairs + 1, 0) if own else (0, self._misses + 1)
        if self._misses >= MISSES:
            self.paired = False
        elif self._pairs >= PAIRS:
            self.paired = True


class StampTime:
    """Time by the senders' stamps, in [ns], that never runs back: a clock set back counts as standing still."""

    def __init__(self) -> None:
        self._offset = 0
        self._stamp: int | None = None
        self.steps_back = 0

    def at(self, stamp: int) -> int:
        """Time of the sample stamped `stamp`."""
        if self._stamp is not None and stamp < self._stamp:
            self._offset += self._stamp - stamp
            self.steps_back += 1
        self._stamp = stamp
        return stamp + self._offset
