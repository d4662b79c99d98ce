"""Finds an angle that does not go where the duty drives it: against it, or at rest where no stop is.

A duty beyond what holds the shaft anywhere in its travel (`Limits.opens_above`, `closes_below`) turns it at 2.5 rad/s
or more with Table I. So within `JUDGED_TIME` it is at the stop that the duty drives against, or well on its way there.
Noise does not hide this, as it hides a frozen sensor: the ends of a window are means over a quarter of it. What is
found is said; nothing is done about it, for the angle may be right and the shaft blocked.
"""

from __future__ import annotations

from pierburg_ros.nodes.core.protection.frozen import Ends
from pierburg_ros.nodes.core.protection.limits import Limits
from pierburg_ros.nodes.core.protection.plausibility import Objection

JUDGED_TIME = 200_000_000
"""Time [ns] of one judgement: 0.5 rad at the least speed, a third of the travel."""
REVERSED = "polarity of motor or sensor reversed"
LONGEST_GAP = 50_000_000
"""Time [ns] between two samples from which on it is not known what acted meanwhile."""


class Contradiction:
    """Watches samples beside the duty that acted before each."""

    def __init__(self, limits: Limits, ends: Ends) -> None:
        self.limits = limits
        self.ends = ends
        self.found: Objection | None = None
        self.forget()

    def forget(self) -> None:
        """Begin anew; what was found stays until a window shows that it is over."""
        self._samples: list[tuple[int, float]] = []
        self._duty = 0.0

    def take(self, voltage: float, duty: float, time: int) -> None:
        """Take a good sample [V] at `time` [ns] and the duty [1] since the one before."""
        sure = duty > self.limits.opens_above or duty < self.limits.closes_below
        late = bool(self._samples) and time - self._samples[-1][0] > LONGEST_GAP
        if not sure or late or duty * self._duty < 0.0:
            self.forget()
        if sure:
            self._duty = duty
            self._samples.append((time, voltage))
        if self._samples and time - self._samples[0][0] >= JUDGED_TIME:
            self.found = self._judged([each for _, each in self._samples])
            self.forget()

    def _judged(self, voltages: list[float]) -> Objection | None:
        quarter = max(len(voltages) // 4, 1)
        before, after = (sum(part) / quarter for part in (voltages[:quarter], voltages[-quarter:]))
        sign = 1.0 if self._duty * (self.ends.opened - self.ends.closed) > 0.0 else -1.0
        stop = self.ends.opened if self._duty > 0.0 else self.ends.closed
        way, left = sign * (after - before), sign * (stop - after)
        margin = abs(self.ends.margin)
        driven = f"under a duty of {self._duty:.2g} that {'opens' if self._duty > 0.0 else 'closes'}"
        if way < -margin:
            return Objection("motion_against_duty", f"the angle moves the other way {driven}: {REVERSED}")
        if left > margin and way < margin:
            text = (
                f"the angle rests at {after:.3g} V {driven} (stop at {stop:.3g} V): sensor off by the difference,"
                f" shaft blocked, drive dead, or {REVERSED}"
            )
            return Objection("rest_under_duty", text)
        return None
