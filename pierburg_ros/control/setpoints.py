"""Which setpoint is in force: the rules of section 2 of docs/contract.md."""

from __future__ import annotations

import math

from pierburg_ros.errors import InputError

STOP_TOLERANCE = 0.002  # beyond a stop by up to this [rad] a setpoint is clamped, further it is refused


class Setpoints:
    """The last setpoint [rad] that was acceptable, whoever wrote it."""

    def __init__(self, lower_stop: float = 0.0, upper_stop: float = math.pi / 2, initial: float = 0.0) -> None:
        self.lower_stop = lower_stop
        self.upper_stop = upper_stop
        self.active = self.accepted(initial)

    def offer(self, setpoint: float) -> float:
        """Take a new setpoint [rad] and give the one in force; a refused one changes nothing."""
        self.active = self.accepted(setpoint)
        return self.active

    def accepted(self, setpoint: float) -> float:
        """The setpoint [rad] between the stops that `setpoint` stands for; InputError if there is none."""
        if not math.isfinite(setpoint):
            raise InputError(f"Setpoint {setpoint} is not finite; give an angle in rad.")
        if not self.lower_stop - STOP_TOLERANCE <= setpoint <= self.upper_stop + STOP_TOLERANCE:
            raise InputError(
                f"Setpoint {setpoint:g} rad is beyond the stops; "
                f"give an angle from {self.lower_stop:g} to {self.upper_stop:.4f} rad."
            )
        return min(max(setpoint, self.lower_stop), self.upper_stop)
