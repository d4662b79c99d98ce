"""How often something comes and how long ago it last did."""

from __future__ import annotations

from collections import deque

COUNTED_TIME = 1.0
"""Time over which a rate is counted [s]."""


class Rate:
    """Counts events by a steady clock [s]."""

    def __init__(self) -> None:
        self.count = 0
        self._times: deque[float] = deque()

    def event(self, now: float) -> None:
        """One happened at `now`."""
        self.count += 1
        self._times.append(now)
        while now - self._times[0] > COUNTED_TIME:
            self._times.popleft()

    def age(self, now: float) -> float | None:
        """Time since the last one [s]; None before the first."""
        return now - self._times[-1] if self._times else None

    def rate(self, now: float) -> float:
        """Events per second over the last `COUNTED_TIME`."""
        return sum(now - time <= COUNTED_TIME for time in self._times) / COUNTED_TIME

    def values(self, now: float, name: str) -> dict[str, object]:
        """Count, rate and age as a diagnostic tells them."""
        age = self.age(now)
        return {
            f"{name}_count": self.count,
            f"{name}_rate_hz": round(self.rate(now), 1),
            f"{name}_age_s": "" if age is None else round(age, 3),
        }
