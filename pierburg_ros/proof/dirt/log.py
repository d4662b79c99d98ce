"""What a bench logs: messages of the Hall voltage and of the duty, each with its time and number."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pierburg_ros.arrays import Flags, Signal

Random = np.random.Generator


@dataclass(frozen=True)
class Messages:
    """Messages of one topic: times [s], values and the sender's numbers, all of shape (messages,)."""

    time: Signal
    values: Signal
    number: NDArray[np.int64]

    @staticmethod
    def of(time: Signal, values: Signal) -> Messages:
        """Messages that are all there."""
        return Messages(time, values, np.arange(time.size))

    def kept(self, which: Flags) -> Messages:
        """Those of `which`, shape (messages,); their numbers tell that others are missing."""
        return Messages(self.time[which], self.values[which], self.number[which])

    def unnumbered(self) -> Messages:
        """The same without numbers, as many writers leave them."""
        return replace(self, number=np.zeros(self.time.size, dtype=np.int64))


@dataclass(frozen=True)
class Log:
    """The Hall voltage [V] and the duty [1] as logged."""

    hall: Messages
    duty: Messages
