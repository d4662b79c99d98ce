"""What the controller says on `/diagnostics` about its sensor and its time."""

from __future__ import annotations

import time
from collections.abc import Mapping

from pierburg_ros.nodes.core.guarded_controller import GuardedController
from pierburg_ros.nodes.core.protection.fallback import Fallback
from pierburg_ros.nodes.core.rate import Rate
from pierburg_ros.nodes.graph.diagnostics import ERROR, OK, WARN, Diagnostics
from pierburg_ros.nodes.reports.heat import HeatReport

SENSOR = "angle sensor"
START_GRACE = 30.0
"""Time [s] after the start up to which waiting for others is no fault; a busy machine needs that long to start them."""
NO_CLOCK = 2.0
"""Time [s] for which Hall samples may come without a `/clock` before that is worth a warning."""


class ControllerReports:
    """Turns the state of a guarded controller into conditions; told after every sample, and now and then."""

    def __init__(self, diagnostics: Diagnostics, guarded: GuardedController) -> None:
        self._diagnostics = diagnostics
        self._guarded = guarded
        self._started = time.monotonic()
        self._fault = ""
        self._first_without_clock: float | None = None
        self.samples = Rate()
        self.good_samples = Rate()
        diagnostics.task(SENSOR, "the angle is known", self._sensor)
        self._heat = HeatReport(diagnostics, guarded.winding)

    def sample(self, is_new: bool) -> None:
        """After a sample was answered; `is_new`: it was not a repetition."""
        guarded, diagnostics = self._guarded, self._diagnostics
        self._first_without_clock = None
        diagnostics.end("clock")
        if guarded.objection is not None and guarded.lost is None:
            text = f"{guarded.objection.text}: last duty kept"
            diagnostics.begin("sample_passed_over", WARN, text, SENSOR)
        else:
            diagnostics.end("sample_passed_over")
        if is_new and guarded.objection is None:
            self.good_samples.event(time.monotonic())
            diagnostics.end("waiting")
            self._step()
        self.fault()
        self._contradicted()
        self._heat.tell()

    def fault(self) -> None:
        """Name the fault that has taken the angle away, or its end."""
        lost = self._guarded.lost
        if self._fault and (lost is None or lost.name != self._fault):
            self._diagnostics.end(self._fault)
        self._fault = lost.name if lost else ""
        if lost is not None:
            text = f"{lost.text}: {answer(self._guarded.fallback)}"
            self._diagnostics.begin(lost.name, ERROR, text, SENSOR)

    def forwarded(self, duty: float, is_within: bool) -> None:
        """A duty [1] was taken from `joint_commands`, clipped where it was not within its range."""
        if is_within:
            self._diagnostics.end("duty_clipped")
        else:
            self._diagnostics.begin("duty_clipped", WARN, f"duty {duty:g} is beyond +-1 and was clipped")

    def _contradicted(self) -> None:
        """Name an angle that does not go where the duty drives it."""
        found = self._guarded.contradiction.found
        if found is None:
            self._diagnostics.end("contradiction")
        else:
            self._diagnostics.begin("contradiction", WARN, found.text, SENSOR)

    def no_clock(self) -> None:
        """A sample came while no simulated time is known."""
        now = time.monotonic()
        if self._first_without_clock is None:
            self._first_without_clock = now
        level = OK if now - self._first_without_clock < NO_CLOCK else WARN
        text = "waiting for /clock, since use_sim_time is set: no duty"
        self._diagnostics.begin("clock", level, text, SENSOR)

    def look(self, is_sending: bool) -> None:
        """Now and then: whether what is waited for is late."""
        if self.good_samples.count or not is_sending:
            return
        level = OK if time.monotonic() - self._started < START_GRACE else ERROR
        self._diagnostics.begin("waiting", level, "waiting for hall_voltage", SENSOR)

    def _step(self) -> None:
        loop = self._guarded.loop
        bounded, longest = loop.bounded, loop.longest_step
        if bounded is None:
            self._diagnostics.end("time_step")
        else:
            text = f"{bounded:.3g} s lay between two Hall samples: counted as {longest:g} s"
            self._diagnostics.begin("time_step", WARN, text, SENSOR)
        if loop.is_forsaken:
            text = f"no joint_commands for {loop.command_timeout:g} s: duty 0"
            self._diagnostics.begin("command_timeout", WARN, text)
        else:
            self._diagnostics.end("command_timeout")

    def _sensor(self) -> Mapping[str, object]:
        now, counts = time.monotonic(), self._guarded.counts
        return {
            **self.samples.values(now, "sample"),
            **self.good_samples.values(now, "good_sample"),
            "passed_over_count": counts.passed_over,
            "lost_count": counts.losses,
            "bounded_step_count": counts.bounded_steps,
        }


def answer(fallback: Fallback) -> str:
    """What a lost angle is answered with, in words."""
    if fallback.on_fault == "hold":
        return f"last duty kept for {fallback.hold_time:g} s, then duty 0"
    return f"duty {-fallback.close_duty:g} to close" if fallback.on_fault == "close" else "duty 0"
