"""Brings samples and duties together that come on topics of their own."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

import numpy as np

from pierburg_ros.monitoring.movements import Samples

SECOND = 1_000_000_000
"""Nanoseconds in a second."""
LATE_DUTY = SECOND // 2
"""Time [ns] after which a sample no longer waits for its duty: ten times the usual time-out of a command."""
PAIRING_GAP = 10.0
"""Distance of two samples, in usual ones, from which on what happened between them is not known.

A plant that is late skips ticks and holds its duty meanwhile, which loses nothing; over ten ticks it may time out.
"""
STALE = 5 * SECOND
"""Age [ns] from which on a measured supply no longer counts."""
USUAL_DISTANCES = 51
"""Distances that the usual one is the median of."""


@dataclass(frozen=True)
class Angle:
    """One sample: `time` [ns] as taken, `sent` [ns] by the clock that stamps messages, its publisher's `number`."""

    time: int
    sent: int
    number: int
    angle: float  # [rad]


class Pairing:
    """Takes samples, duties and supplies in the order each was sent; gives samples whose duty is known.

    Their times [s] count from `origin` [ns], that of the first.

    A duty is in force from the sample that was sent no earlier than it, until the next one. Where the duty is published
    behind the sample of its own tick, as `applied_duty` is behind `hall_voltage`, `follows` is True: it belongs to the
    sample before it.
    """

    def __init__(self, follows: bool, every_tick: bool) -> None:
        """`every_tick`: each sample has a duty of its own, and one without is not whole."""
        self._follows = follows
        self._every_tick = every_tick
        self._angles: deque[Angle] = deque()
        self._duties: deque[tuple[int, int, float]] = deque()
        self._number: int | None = None
        self._duty_number: int | None = None
        self._supply = (-STALE, np.nan)
        self._duty: float | None = None
        self._last: int | None = None
        self._distances: deque[int] = deque(maxlen=USUAL_DISTANCES)
        self._usual = np.inf
        self.origin: int | None = None
        self.lost = 0

    def angle(self, angle: Angle) -> None:
        """Take a sample; one that is not finite counts as missing."""
        if np.isfinite(angle.angle):
            self._angles.append(angle)

    def duty(self, sent: int, number: int, duty: float) -> None:
        """Take a duty sent at `sent` [ns] as its publisher's `number`."""
        if np.isfinite(duty):
            self._duties.append((sent, number, min(max(duty, -1.0), 1.0)))

    def supply(self, sent: int, voltage: float) -> None:
        """Take a measured supply [V] sent at `sent` [ns]."""
        if np.isfinite(voltage):
            self._supply = (sent, voltage)

    def paired(self, now: int) -> Samples:
        """The samples whose duty is known by `now` [ns]; the last ones may wait for theirs."""
        rows = []
        if self._distances:
            self._usual = float(np.median(self._distances))
        while len(self._angles) > 1:
            reference = self._angles[1].sent if self._follows else self._angles[0].sent
            newest = self._duties[-1][0] if self._duties else None
            if (newest is None or newest < reference) and now - self._angles[0].sent < LATE_DUTY:
                break
            rows.append(self._row(self._angles.popleft(), reference))
        columns = np.array([row for row in rows if row is not None], dtype=float).reshape(-1, 5).T
        return Samples(columns[0], columns[1], columns[2], columns[3], columns[4].astype(bool))

    def _row(self, angle: Angle, reference: int) -> tuple[float, ...] | None:
        known = self._duty_in_force(reference)
        follows, self._number = self._number in (None, angle.number - 1), angle.number
        self.lost += not follows
        if self._last is not None and angle.time <= self._last:
            if self._last - angle.time > SECOND:
                self._last = None
            return None
        if self.origin is None:
            self.origin = angle.time
        whole = not self._behind_a_gap(angle.time) and known and follows
        supply = self._supply[1] if abs(angle.sent - self._supply[0]) < STALE else np.nan
        return (angle.time - self.origin) * 1e-9, angle.angle, self._duty or 0.0, supply, whole

    def _duty_in_force(self, reference: int) -> bool:
        """Put the duty of a sample in force; whether it is known: none was lost, and it has one of its own."""
        fresh, whole = False, True
        while self._duties and self._duties[0][0] <= reference:
            _, number, self._duty = self._duties.popleft()
            whole = whole and self._duty_number in (None, number - 1)
            self.lost += self._duty_number not in (None, number - 1)
            self._duty_number, fresh = number, True
        return self._duty is not None and whole and (fresh or not self._every_tick)

    def _behind_a_gap(self, time: int) -> bool:
        """Whether it is unknown what happened before this sample."""
        before, self._last = self._last, time
        if before is None:
            return True
        self._distances.append(time - before)
        return time - before > PAIRING_GAP * self._usual
