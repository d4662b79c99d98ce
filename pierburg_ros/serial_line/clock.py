"""The device's clock seen from the host: offset and rate from the arrivals that were delayed least."""

from __future__ import annotations

from collections import deque

import numpy as np

SECOND = 1_000_000_000
"""Nanoseconds in a second."""
SPAN = SECOND
"""Time of the device [ns] in which the least delayed arrival is kept: at 500 Hz one of 500."""
KEPT_ARRIVALS = 60
"""Such arrivals the rate is estimated from: a minute, in which the temperature of a crystal changes little."""
LARGEST_RATE_ERROR = 5e-4
"""Largest deviation of the rates that is believed: ten times that of a poor crystal; a ceramic resonator reaches it."""
FEWEST_ARRIVALS = 10
"""Arrivals from which on a rate is estimated: with 1 ms of spread over 10 s it is known to 1e-4."""


class DeviceClock:
    """Maps the device's time to the host's.

    A message never arrives before it was sent, so that the least delayed ones lie on a line; the shortest delay itself
    (of the line and the converter) stays in the offset. Mapped times never run backwards.
    """

    def __init__(self) -> None:
        self.rate = 0.0
        self._least: deque[tuple[int, int]] = deque(maxlen=KEPT_ARRIVALS)
        self._current: tuple[int, int] | None = None
        self._begun = 0
        self._last = 0

    def host(self, device: int, arrival: int) -> int:
        """Host time [ns] of the device's time [ns], of a message that arrived at host time `arrival` [ns]."""
        offset = arrival - device
        if self._current is None or device - self._begun >= SPAN:
            if self._current is not None:
                self._least.append(self._current)
                self._estimate()
            self._begun, self._current = device, (device, offset)
        elif offset - self._drifted(device - self._current[0]) < self._current[1]:
            self._current = (device, offset)
        points = [*self._least, self._current]
        best = min(known + self._drifted(device - at) for at, known in points)
        self._last = max(self._last + 1, min(device + best, arrival))
        return self._last

    def _drifted(self, passed: int) -> int:
        return round(self.rate * passed)

    def _estimate(self) -> None:
        """The rate of the host's clock over the device's, minus one: slope of the least delayed arrivals."""
        if len(self._least) < FEWEST_ARRIVALS:
            return
        at, offset = (np.array(column, dtype=float) for column in zip(*self._least, strict=True))
        at, offset = at - at[0], offset - offset[0]
        first, last = np.array_split(np.arange(at.size), 2)
        low, high = (part[np.argmin(offset[part] - self.rate * at[part])] for part in (first, last))
        self.rate = float(
            np.clip((offset[high] - offset[low]) / (at[high] - at[low]), -LARGEST_RATE_ERROR, LARGEST_RATE_ERROR)
        )
