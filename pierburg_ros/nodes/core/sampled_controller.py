"""One duty for one Hall sample, with the setpoint in force at its time. Knows no ROS."""

from __future__ import annotations

import math

from pierburg_ros.control import Controller, Schedule, Setpoints
from pierburg_ros.nodes.core.commanded_duty import CommandedDuty


class SampledController:
    """The control law, the setpoint in force, and a schedule of setpoints if there is one.

    Where duties are `forwarded`, the newest of them stands in the place of the law's.
    """

    def __init__(self, controller: Controller, setpoints: Setpoints, schedule: Schedule | None = None) -> None:
        self.longest_step = math.inf
        """Longer times between two samples [s] count as this for the control law."""
        self.bounded: float | None = None
        """The time before the last sample [s] where it was longer than that."""
        self.controller = controller
        self.setpoints = setpoints
        self.schedule = schedule
        self.forwarded: CommandedDuty | None = None
        self.command_timeout = 0.0
        """A forwarded duty holds so long [s]; 0: for ever."""
        self._scheduled: float | None = None
        self._first: int | None = None
        self.last: int | None = None
        self._duty = 0.0
        self._is_interrupted = False

    def prepare(self) -> None:
        """Have the control law compiled, or loaded from the cache, before the first sample comes."""
        self.controller.step(self.setpoints.active, 0.0, 0.0)
        self.controller.change(self.controller.settings)
        self.controller.restart()

    def duty(self, hall_voltage: float, time: int) -> float:
        """Duty [1] for a Hall sample [V] taken at `time` [ns]; the same time again repeats the same duty."""
        if time == self.last:
            return self._duty if self.controller.enabled else 0.0
        if self.last is not None and time < self.last:
            self.restart()
        if self._first is None:
            self._first = time
        elapsed = self._elapsed(time)
        self._follow_schedule((time - self._first) * 1e-9)
        if self.forwarded is not None:
            self._duty = self.forwarded.at(time, self.command_timeout)
        else:
            self._duty = self.controller.step(self.setpoints.active, hall_voltage, elapsed)
        self.last = time
        return self._duty

    @property
    def is_forsaken(self) -> bool:
        """Whether the sender of forwarded duties has been silent for too long."""
        return self.forwarded is not None and self.forwarded.lost(self.last or 0, self.command_timeout)

    def restart(self) -> None:
        """The next sample is the first of a new run."""
        self.controller.restart()
        self._first = self.last = self._scheduled = None

    def interrupt(self, duty: float = 0.0) -> None:
        """The next sample counts as the first for the law and leaves from `duty`; the schedule goes on."""
        self.controller.restart(duty)
        self._is_interrupted = True

    def _elapsed(self, time: int) -> float:
        """Time since the sample before [s], bounded; after an interruption the law ignores it."""
        elapsed = 0.0 if self.last is None else (time - self.last) * 1e-9
        self.bounded = elapsed if elapsed > self.longest_step and not self._is_interrupted else None
        self._is_interrupted = False
        return min(elapsed, self.longest_step)

    def _follow_schedule(self, time: float) -> None:
        if self.schedule is None:
            return
        scheduled = self.schedule.at(time)
        if scheduled != self._scheduled:
            self._scheduled = self.setpoints.offer(scheduled)
