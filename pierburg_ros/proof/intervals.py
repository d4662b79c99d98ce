"""How sure a share is that was counted on n trials."""

from __future__ import annotations

import math
from dataclasses import dataclass

NORMAL_95 = 1.959963984540054  # two-sided 95 % quantile of the normal distribution


@dataclass(frozen=True)
class Share:
    """`count` out of `total`, with its 95 % interval."""

    count: int
    total: int

    @property
    def value(self) -> float | None:
        """The share itself [1]; None where nothing was counted."""
        return self.count / self.total if self.total else None

    @property
    def interval(self) -> tuple[float, float]:
        """Wilson's score interval [1], E. B. Wilson, J. Am. Statistical Association 22 (1927) 209-212."""
        if self.total == 0:
            return 0.0, 1.0
        share, square = self.count / self.total, NORMAL_95**2 / self.total
        centre = (share + square / 2) / (1 + square)
        reach = math.sqrt(share * (1 - share) * square + square**2 / 4) / (1 + square)
        # rounding may not put the share outside
        return min(max(centre - reach, 0.0), share), max(min(centre + reach, 1.0), share)

    def __str__(self) -> str:
        if self.total == 0:
            return "n = 0"
        low, high = self.interval
        return f"{self.count}/{self.total} ({100 * low:.0f} to {100 * high:.0f} %)"
