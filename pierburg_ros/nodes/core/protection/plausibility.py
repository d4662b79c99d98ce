"""Which Hall samples can be true: finite, inside the sensor's band, and no faster than the shaft can turn."""

from __future__ import annotations

import math
from dataclasses import dataclass

CONFIRMATIONS = 3
"""Samples in a row that agree with each other but not with the last good one, after which they are believed.

A spike does not agree with the sample after it. A shaft that moved on while a busy machine held samples back
does, and would otherwise be refused until the clock has caught up."""


@dataclass(frozen=True)
class Band:
    """What a healthy sensor can say: from `lowest` to `highest` [V], changing by `rate` [V/s] and `noise` [V]."""

    lowest: float
    highest: float
    rate: float
    noise: float


@dataclass(frozen=True)
class Objection:
    """Why a sample counts as none: the fault's name, and a text for people."""

    name: str
    text: str


def band(closed: float, opened: float, margin: float, speed: float, travel: float) -> Band:
    """The band of a sensor from `closed` to `opened` [V] over `travel` [rad] of a shaft with a top `speed` [rad/s].

    `margin` is a share of the span: so far may the ends be off, and two samples of a shaft at rest differ. 5 % is
    half of what lies between the valve's ends and the rails of its supply at 0 V and 5 V, and 68 times its noise.
    """
    span = opened - closed
    return Band(closed - margin * span, opened + margin * span, speed * span / travel, margin * span)


class Plausibility:
    """Judges samples one by one; remembers the last good one and the samples that object to it.

    A sample has the time of its sending, and a busy machine may send it late: it was taken some time after the one
    before it. So the shaft has had the time since then.
    """

    def __init__(self, limits: Band) -> None:
        self.limits = limits
        self.forget()

    def forget(self) -> None:
        """The next sample has no past: only its place in the band counts."""
        self._good: tuple[float, int] | None = None
        self._candidate: tuple[float, int] | None = None
        self._before: int | None = None
        self._agreeing = 0

    def objection(self, voltage: float, time: int) -> Objection | None:
        """What speaks against a sample [V] sent at `time` [ns]; None where it is good."""
        earliest, self._before = time if self._before is None else self._before, time
        found = self._outside(voltage)
        if found is not None:
            self._candidate, self._agreeing = None, 0
            return found
        if self._good is not None and not self._reachable(self._good, voltage, time):
            found = self._jumped(voltage, time, earliest)
        if found is None:
            self._good, self._candidate, self._agreeing = (voltage, earliest), None, 0
        return found

    def _outside(self, voltage: float) -> Objection | None:
        if not math.isfinite(voltage):
            return Objection("hall_voltage_not_finite", f"Hall voltage {voltage} is not finite")
        lowest, highest = self.limits.lowest, self.limits.highest
        if lowest <= voltage <= highest:
            return None
        text = f"Hall voltage {voltage:.4g} V is outside the sensor's band of {lowest:.3g} to {highest:.3g} V"
        return Objection("hall_voltage_implausible", text)

    def _reachable(self, start: tuple[float, int], voltage: float, time: int) -> bool:
        elapsed = max(time - start[1], 0) * 1e-9
        return abs(voltage - start[0]) <= self.limits.rate * elapsed + self.limits.noise

    def _jumped(self, voltage: float, time: int, earliest: int) -> Objection | None:
        agrees = self._candidate is not None and self._reachable(self._candidate, voltage, time)
        self._agreeing = self._agreeing + 1 if agrees else 1
        self._candidate = (voltage, earliest)
        if self._agreeing >= CONFIRMATIONS:
            return None
        text = f"Hall voltage {voltage:.4g} V came faster than the shaft turns ({self.limits.rate:.3g} V/s)"
        return Objection("hall_voltage_too_fast", text)
