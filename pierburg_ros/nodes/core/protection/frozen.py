"""Finds a Hall voltage that stands still while the duty says move.

Evidence: the duty lies beyond what holds the shaft anywhere in its travel (`Limits.opens_above`, `closes_below`: the
strongest spring torque and three times the nominal friction), the sample is not at the stop that the duty drives
against, and the voltage stays within `FROZEN_SHARE` of one value. Then, with Table I, the shaft would turn at 2.5 rad/s
or more, from the first millisecond (its mechanical time constant is below 0.1 ms), and pass 0.07 rad or 5 % of the
span in `FROZEN_AFTER`; a sensor that lives shows that 90 times over, and its noise (3 mV and more at this converter)
alone leaves the band within a few samples. A frozen value therefore is a broken sensor, a shaft blocked under a sensor
without noise, or a drive that is dead: none of them is controlled by more duty.
"""

from __future__ import annotations

from dataclasses import dataclass

from pierburg_ros.nodes.core.protection.limits import Limits

FROZEN_SHARE = 0.0005
"""Share of the span within which a value counts as unchanged: 2 mV, below two steps of a 12-bit converter over 5 V."""
FROZEN_AFTER = 0.03
"""Time [s] without change after which the sensor is called frozen: duty 0 is then out within 50 ms."""
FROZEN_SAMPLES = 5
"""Unchanged samples there must be at least, at rates so low that `FROZEN_AFTER` holds fewer."""
LONGEST_PAUSE = 64.0
"""Longest time between two tries [s]."""


@dataclass(frozen=True)
class Ends:
    """Hall voltages [V] at the stops, and how near to one [V] the shaft counts as being there."""

    closed: float
    opened: float
    margin: float


class Frozen:
    """Watches samples beside the duty in force."""

    def __init__(self, limits: Limits, ends: Ends) -> None:
        self.limits = limits
        self.ends = ends
        self._failures = 0
        self.forget()

    def forget(self) -> None:
        """Begin anew to look for a voltage that stands still."""
        self._value: float | None = None
        self._since = 0
        self._unchanged = 0

    def take(self, voltage: float, duty: float, time: int) -> bool:
        """Whether the sensor is frozen, with a good sample [V] at `time` [ns] and the `duty` before it."""
        if self._value is not None and abs(voltage - self._value) > self._still:
            self._failures = 0
        if not self._says_move(voltage, duty):
            self.forget()
            return False
        if self._value is None or abs(voltage - self._value) > self._still:
            self._value, self._since, self._unchanged = voltage, time, 0
            return False
        self._unchanged += 1
        found = self._unchanged >= FROZEN_SAMPLES and time - self._since >= FROZEN_AFTER * 1e9
        self._failures += found
        return found

    def moved(self, voltage: float) -> bool:
        """Whether a voltage [V] differs from the frozen one."""
        return self._value is None or abs(voltage - self._value) > self._still

    def pause(self, first: float) -> float:
        """Time until the next try [s]: `first`, twice as long after every try that failed, at most a minute."""
        return min(first * 2.0 ** (self._failures - 1), max(first, LONGEST_PAUSE))

    @property
    def _still(self) -> float:
        return FROZEN_SHARE * (self.ends.opened - self.ends.closed)

    def _says_move(self, voltage: float, duty: float) -> bool:
        opens = duty > self.limits.opens_above and voltage < self.ends.opened - self.ends.margin
        closes = duty < self.limits.closes_below and voltage > self.ends.closed + self.ends.margin
        return opens or closes
