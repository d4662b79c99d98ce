"""One duty for one Hall sample, with the setpoint in force at its time. Knows no ROS."""

from __future__ import annotations

from pierburg_ros.control import Controller, Schedule, Setpoints


class SampledController:
    """The control law, the setpoint in force, and a schedule of setpoints if there is one."""

    def __init__(self, controller: Controller, setpoints: Setpoints, schedule: Schedule | None = None) -> None:
        self.controller = controller
        self.setpoints = setpoints
        self.schedule = schedule
        self._scheduled: float | None = None
        self._first: int | None = None
        self.last: int | None = None
        self._duty = 0.0

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
        elapsed = 0.0 if self.last is None else (time - self.last) * 1e-9
        self._follow_schedule((time - self._first) * 1e-9)
        self._duty = self.controller.step(self.setpoints.active, hall_voltage, elapsed)
        self.last = time
        return self._duty

    def restart(self) -> None:
        """The next sample is the first of a new run."""
        self.controller.restart()
        self._first = self.last = self._scheduled = None

    def interrupt(self) -> None:
        """Samples stay away: the next one counts as the first for the law; the schedule goes on."""
        self.controller.restart()

    def _follow_schedule(self, time: float) -> None:
        if self.schedule is None:
            return
        scheduled = self.schedule.at(time)
        if scheduled != self._scheduled:
            self._scheduled = self.setpoints.offer(scheduled)
