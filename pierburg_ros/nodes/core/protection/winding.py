"""Heat of the winding by I^2 t, and the duty that it still bears.

The heat u is the winding's rise of temperature as a share of that which the rated current brings about for ever:
time_constant du/dt = (current / rated)^2 - u, solved exactly over a step of constant current. Below 1 nothing is
limited. At 1 the current is limited to the rated one; a stall that lasts on for `LIMITED_FOR` ends in duty 0 until
the heat has fallen to `COOLED`. Current by equation (5) of the paper without inductance: (duty supply - constant
speed) / resistance. Not validated: no thermal data of the motor is known; see `Limits.rated_current`.
"""

from __future__ import annotations

import math

from pierburg_ros.nodes.core.protection.limits import Limits

LIMITED_FOR = 10.0
"""Longest time [s] at the rated current before the duty goes to 0: by then a valve that could move has moved."""
COOLED = 0.5
"""Heat at which a winding that was switched off may be used again."""
RELEASED = 0.95
"""Heat below which a limit ends. At the rated current it stays near 1; a winding that cools got less."""


class Winding:
    """Heat of one winding over time."""

    def __init__(self, limits: Limits, rated_current: float, time_constant: float) -> None:
        """`rated_current` [A]; `time_constant` [s] of winding against housing, 0: never limited."""
        self.limits = limits
        self.rated_current = rated_current
        self.time_constant = time_constant
        self.heat = 0.0
        self.limited = False
        self.off = False
        self._limited_for = 0.0

    def current(self, duty: float, speed: float) -> float:
        """Current [A] at a duty and a shaft speed [rad/s], at most the stall current.

        A reversal draws more, but for milliseconds; an estimated speed may be off for as long.
        """
        amperes = (duty * self.limits.supply_voltage - self.limits.torque_constant * speed) / self.limits.resistance
        return min(max(amperes, -self.limits.stall_current), self.limits.stall_current)

    def warm(self, current: float, elapsed: float) -> None:
        """Let a current [A] flow for `elapsed` [s]."""
        if self.time_constant <= 0.0 or self.rated_current <= 0.0:
            self.heat, self.limited, self.off = 0.0, False, False
            return
        final = (current / self.rated_current) ** 2
        self.heat = final + (self.heat - final) * math.exp(-elapsed / self.time_constant)
        self._switch(elapsed)

    def borne(self, duty: float, speed: float) -> float:
        """The duty that the winding bears at a shaft speed [rad/s]; `duty` itself where nothing is limited."""
        if self.off:
            return 0.0
        if not self.limited or self.limits.supply_voltage <= 0.0:
            return duty
        induced = self.limits.torque_constant * speed / self.limits.supply_voltage
        reach = self.rated_current * self.limits.resistance / self.limits.supply_voltage
        lowest, highest = min(induced - reach, 0.0), max(induced + reach, 0.0)
        return min(max(duty, lowest), highest)

    def _switch(self, elapsed: float) -> None:
        """Limit from heat 1 on, until it has fallen a little; switch off after `LIMITED_FOR`."""
        self.off = self.off and self.heat > COOLED
        if self.off:
            return
        self.limited = self.heat >= 1.0 or (self.limited and self.heat > RELEASED)
        self._limited_for = self._limited_for + elapsed if self.limited else 0.0
        if self._limited_for >= LIMITED_FOR:
            self.off, self.limited, self._limited_for = True, False, 0.0
