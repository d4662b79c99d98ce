"""The duty while the angle is unknown: none, the last good one for a while, or a little towards closed."""

from __future__ import annotations

from dataclasses import dataclass

CHOICES = ("release", "hold", "close")


@dataclass(frozen=True)
class Fallback:
    """What is done when the angle is lost."""

    on_fault: str = "release"
    hold_time: float = 1.0  # longest time for which `hold` keeps the duty [s]
    close_duty: float = 0.2  # size of the negative duty of `close` [1]

    def duty(self, last: float, elapsed: float) -> float:
        """Duty [1] `elapsed` [s] after the angle was lost at the duty `last`."""
        if self.on_fault == "hold" and elapsed < self.hold_time:
            return last
        return -self.close_duty if self.on_fault == "close" else 0.0
