"""The duty the plant obeys: the newest one that is usable, for as long as its sender keeps sending."""

from __future__ import annotations

import math

from pierburg_ros.errors import InputError


class CommandedDuty:
    """Takes duties as they come and says which is in force at a tick."""

    def __init__(self) -> None:
        self.received = 0
        self._value = 0.0
        self._fresh = False
        self._since: int | None = None

    def offer(self, duty: float) -> bool:
        """Take a duty; InputError where it is not finite, False where it had to be clipped to [-1, 1]."""
        self.received += 1
        if not math.isfinite(duty):
            raise InputError(f"Duty {duty} is not finite; the previous one stays in force.")
        self._value = min(max(duty, -1.0), 1.0)
        self._fresh = True
        return self._value == duty

    def at(self, time: int, timeout: float) -> float:
        """The duty at a tick, `time` [ns]; 0 when none came for `timeout` [s], where 0 means never."""
        if self._fresh:
            self._fresh, self._since = False, time
        return 0.0 if self.lost(time, timeout) or self._since is None else self._value

    def lost(self, time: int, timeout: float) -> bool:
        """Whether a duty was in force and its sender has been silent for longer than `timeout` [s]."""
        return timeout > 0.0 and self._since is not None and time - self._since > timeout * 1e9
