"""The PI-fuzzy logic controller as an object: settings and state, driven by samples."""

from __future__ import annotations

import math
from dataclasses import dataclass

from pierburg_ros.control import law
from pierburg_ros.control.settings import Settings


@dataclass(frozen=True)
class Internals:
    """What the controller worked with at its last sample."""

    error: float  # [V]
    pi_output: float  # [V]
    derivative: float  # of the error, filtered [V/s]
    saturated: bool


class Controller:
    """PIFLC of the paper's Fig. 6: one duty for each Hall sample."""

    def __init__(self, settings: Settings | None = None, enabled: bool = True) -> None:
        self._settings = settings or Settings()
        self._record = self._settings.record()
        self._state = law.new_state()
        self._enabled = enabled

    @property
    def settings(self) -> Settings:
        """The settings in force."""
        return self._settings

    @property
    def enabled(self) -> bool:
        """Whether samples are answered with a controlling duty; otherwise with 0."""
        return self._enabled

    @property
    def internals(self) -> Internals:
        """Error, PI output, derivative and saturation of the last sample."""
        state = self._state
        return Internals(float(state.error), float(state.pi_output), float(state.derivative), bool(state.saturated))

    def step(self, setpoint: float, hall_voltage: float, dt: float) -> float:
        """Duty [1] for a setpoint [rad] and a Hall sample [V] taken `dt` [s] after the previous one.

        A sample or setpoint that is not finite is passed over: the last duty stays. With `dt` below 1 us
        nothing integrates. The first sample after a start ignores `dt`.
        """
        if not self._enabled:
            return 0.0
        if not (math.isfinite(setpoint) and math.isfinite(hall_voltage) and math.isfinite(dt)):
            return float(self._state.duty)
        return float(law.step(self._record, self._state, float(setpoint), float(hall_voltage), float(dt)))

    def change(self, settings: Settings) -> None:
        """Put new settings in force without a jump of the duty."""
        self._settings = settings
        self._record = settings.record()
        if self._state.started:
            law.take_over(self._record, self._state)

    def enable(self, enabled: bool) -> None:
        """Switch the controller on, from duty 0 and without a past, or off."""
        if enabled != self._enabled:
            self._enabled = enabled
            self.restart()

    def restart(self, duty: float = 0.0) -> None:
        """Forget the past: the next sample counts as the first, and the duty leaves from `duty`."""
        self._state = law.new_state()
        self._state.duty = duty
