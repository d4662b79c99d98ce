"""The sampled controller behind its protections: what a bad sample, a lost angle or a hot winding is answered with."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from pierburg_ros.actuators import Actuator
from pierburg_ros.nodes.core.protection.contradiction import Contradiction
from pierburg_ros.nodes.core.protection.fallback import Fallback
from pierburg_ros.nodes.core.protection.frozen import Ends, Frozen
from pierburg_ros.nodes.core.protection.limits import limits_of
from pierburg_ros.nodes.core.protection.plausibility import Objection, Plausibility, band
from pierburg_ros.nodes.core.protection.winding import Winding
from pierburg_ros.nodes.core.sampled_controller import SampledController
from pierburg_ros.nodes.core.shaft_sensor import ShaftSensor

RETURN = 5
"""Good samples in a row after which an angle that bad ones had taken away counts as known again."""
TOLD = 10
"""Samples for which the last word of the actuator on its duty holds: as many as wait for a reader."""
SPEED_FILTER = 0.01
"""Time constant [s] of the speed from which the current is estimated, as in the plant's `joint_states`."""


@dataclass
class Counts:
    """How many samples there were, and what became of them."""

    samples: int = 0
    passed_over: int = 0
    losses: int = 0
    bounded_steps: int = 0


class GuardedController:
    """One duty for every Hall sample, good or not; a healthy sensor gets exactly that of the loop within.

    A sample that cannot be true is passed over: the last duty stays. Without a good one for `angle_timeout` the
    angle is lost, and the fallback answers until good samples are back.
    """

    def __init__(self, loop: SampledController, actuator: Actuator, values: Mapping[str, Any]) -> None:
        self.loop = loop
        self.counts = Counts()
        self.lost: Objection | None = None
        self.objection: Objection | None = None
        self.last_good: int | None = None
        self._limits = limits_of(actuator)
        self._shaft = ShaftSensor(actuator, SPEED_FILTER)
        self.winding = Winding(self._limits, self._limits.rated_current, 0.0)
        self._plausibility = Plausibility(band(0.0, 1.0, 0.0, 1.0, 1.0))
        self._frozen = Frozen(self._limits, Ends(0.0, 1.0, 0.0))
        self.contradiction = Contradiction(self._limits, self._frozen.ends)
        self.configure(values)
        self._time: int | None = None
        self._duty = self._duty_at_loss = 0.0
        self._applied: tuple[float, int] | None = None
        self._lost_at = 0
        self._bad_since: int | None = None
        self._good_samples = 0

    def configure(self, values: Mapping[str, Any]) -> None:
        """Take the parameters of the protections, and the ends of the sensor from the law's settings."""
        law = self.loop.controller.settings
        closed, opened = law.hall_voltage_closed, law.hall_voltage_open
        margin = values["hall_margin"]
        speed = values["top_speed"] or self._limits.top_speed
        self._plausibility.limits = band(closed, opened, margin, speed, law.angle_open - law.angle_closed)
        self._frozen.ends = self.contradiction.ends = Ends(closed, opened, margin * (opened - closed))
        self.winding.rated_current = values["rated_current"] or self._limits.rated_current
        self.winding.time_constant = values["thermal_time_constant"]
        self.fallback = Fallback(values["on_fault"], values["hold_time"], values["close_duty"])
        self.loop.longest_step = values["longest_step"]
        self.loop.command_timeout = values["command_timeout"]
        self._timeout = round(values["angle_timeout"] * 1e9)
        self._retry = values["frozen_retry"]
        self._longest_heating = min(values["longest_step"], values["hall_timeout"] or math.inf)

    def duty(self, voltage: float, time: int) -> float:
        """Duty [1] for a sample [V] taken at `time` [ns]; the same time again repeats the same duty."""
        if time == self._time:
            return self._given(self._duty)
        if self._time is not None and time < self._time:
            self.restart()
        self.counts.samples += 1
        elapsed = 0.0 if self._time is None else (time - self._time) * 1e-9
        self._time = time
        self.objection = self._plausibility.objection(voltage, time)
        if self.objection is None:
            wanted = self._of_good_sample(voltage, time)
        else:
            wanted = self._of_bad_sample(self.objection, time)
        self._duty = self._borne(wanted, min(elapsed, self._longest_heating))
        return self._given(self._duty)

    def applied(self, duty: float) -> None:
        """The actuator says which duty [1] it obeys; it may have dropped what was sent, or never got it."""
        if math.isfinite(duty):
            self._applied = duty, self.counts.samples

    def silence(self, text: str, elapsed: float) -> float:
        """Duty [1] `elapsed` [s] after the caller's clock found that no new good sample comes any more."""
        if self.lost is None:
            self._lose(Objection("hall_timeout", text), self._time or 0)
            self._plausibility.forget()
        self._duty = self.winding.borne(self.fallback.duty(self._duty_at_loss, elapsed), 0.0)
        return self._given(self._duty)

    def restart(self) -> None:
        """The next sample is the first of a new run; the winding stays as warm as it is."""
        self.loop.restart()
        self._plausibility.forget()
        self._frozen.forget()
        self.contradiction.forget()
        self._shaft.reset()
        self.lost = self.objection = self.last_good = self._time = self._bad_since = None
        self._duty = 0.0

    def _given(self, duty: float) -> float:
        return duty if self.loop.controller.enabled else 0.0

    def _of_good_sample(self, voltage: float, time: int) -> float:
        before, self.last_good = self.last_good, time
        self._bad_since = None
        self._shaft.take(voltage, 0.0 if before is None else (time - before) * 1e-9)
        self.contradiction.take(voltage, self._acted(), time)
        if self.lost is not None:
            self._good_samples += 1
            if not self._is_back(voltage, time):
                return self._fallback_duty(time)
            self._return(time)
        if self._frozen.take(voltage, self._given(self._duty), time):
            self._lose(self._frozen_at(voltage), time)
            return self._fallback_duty(time)
        duty = self.loop.duty(voltage, time)
        self.counts.bounded_steps += self.loop.bounded is not None
        return duty

    def _of_bad_sample(self, objection: Objection, time: int) -> float:
        self.counts.passed_over += 1
        self._good_samples = 0
        if self._bad_since is None:
            self._bad_since = time
        if self.lost is None and time - self._bad_since >= self._timeout:
            self._lose(objection, time)
            self._plausibility.forget()
        elif self.lost is not None:
            self.lost = objection
        return self._duty if self.lost is None else self._fallback_duty(time)

    def _lose(self, fault: Objection, time: int) -> None:
        self.counts.losses += 1
        self.lost, self._lost_at, self._duty_at_loss = fault, time, self._duty
        self._good_samples = 0

    def _is_back(self, voltage: float, time: int) -> bool:
        if self.lost is None or self.lost.name == "hall_timeout":
            return True
        if self.lost.name != "hall_voltage_frozen":
            return self._good_samples >= RETURN
        waited = (time - self._lost_at) * 1e-9
        again = self._retry > 0.0 and waited >= self._frozen.pause(self._retry)
        return again or self._frozen.moved(voltage)

    def _return(self, time: int) -> None:
        """Go on from the duty that is out, as if this sample were the first."""
        self.loop.interrupt(self._fallback_duty(time))
        self._frozen.forget()
        self.lost = None

    def _fallback_duty(self, time: int) -> float:
        return self.fallback.duty(self._duty_at_loss, (time - self._lost_at) * 1e-9)

    def _frozen_at(self, voltage: float) -> Objection:
        text = (
            f"Hall voltage stays at {voltage:.4g} V while duty {self._duty:+.2f} should move the shaft: "
            "sensor frozen, shaft blocked or drive dead"
        )
        return Objection("hall_voltage_frozen", text)

    def _acted(self) -> float:
        """The duty since the last sample: what the actuator obeyed where it says so, else what was sent."""
        if self._applied is not None and self.counts.samples - self._applied[1] <= TOLD:
            return self._applied[0]
        return self._given(self._duty)

    def _borne(self, wanted: float, elapsed: float) -> float:
        """The part of the wanted duty that the winding bears, after it was warmed by the one before."""
        speed = self._shaft.velocity if self.lost is None else 0.0
        was_off = self.winding.off
        self.winding.warm(self.winding.current(self._acted(), speed), elapsed)
        if was_off and not self.winding.off:
            self.loop.interrupt()
            return 0.0
        return self.winding.borne(wanted, speed)
