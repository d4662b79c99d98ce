"""The PIFLC as a node: one duty for every Hall sample."""

from __future__ import annotations

import time
from collections.abc import Mapping
from typing import Any

from rclpy.clock import Clock, ClockType
from std_msgs.msg import Float64
from std_srvs.srv import SetBool

from pierburg_ros.actuators import read_actuator
from pierburg_ros.control import Controller, Setpoints, Settings, read_setpoint_file
from pierburg_ros.errors import InputError
from pierburg_ros.nodes.controller_commands import JointCommands
from pierburg_ros.nodes.controller_outputs import TOPICS, Outputs
from pierburg_ros.nodes.controller_place import Place
from pierburg_ros.nodes.core.commanded_duty import CommandedDuty
from pierburg_ros.nodes.core.controller_parameters import CONTROLLER, LAW, PROTECTION, WINDING
from pierburg_ros.nodes.core.guarded_controller import GuardedController
from pierburg_ros.nodes.core.sampled_controller import SampledController
from pierburg_ros.nodes.graph import messages
from pierburg_ros.nodes.graph.lifecycle import ManagedNode
from pierburg_ros.nodes.graph.qos import COMMANDS
from pierburg_ros.nodes.graph.running import run
from pierburg_ros.nodes.graph.sample_clock import SampleClock
from pierburg_ros.nodes.graph.signals import Signal
from pierburg_ros.nodes.reports.controller import ControllerReports

STATUS_PERIOD = 0.1
"""Time between two publications of an unchanged `active_setpoint` [s]."""
FAULT_PERIOD = 0.01
"""Time between two duties [s] that answer a silent sensor by `hold` or `close`: well within a plant's time-out."""


class ControllerNode(ManagedNode):
    """Answers Hall samples with duties; a lost angle is answered with duty 0, or as `on_fault` says."""

    later = TOPICS

    def __init__(self) -> None:
        super().__init__("controller")
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self.outputs: Outputs | None = None
        self.guarded: GuardedController | None = None
        self._place = Place(self, time.monotonic())
        self._watchdog = self.create_timer(3600.0, self._on_silence, clock=steady)
        self._watchdog.cancel()
        self.declare((*LAW, *CONTROLLER, *PROTECTION, *WINDING))
        self.guarded = self._prepared()
        self._reports = ControllerReports(self.diagnostics, self.guarded)
        self._sample_clock = SampleClock(self)
        self._hall_voltage = Signal(self, Float64, "hall_voltage", self._on_hall_voltage)
        self._applied_duty = Signal(self, Float64, "applied_duty", lambda message: self.guarded.applied(message.data))
        self._silent_since: float | None = None
        if self.guarded.loop.forwarded is None:
            self.create_subscription(Float64, "setpoints", self._on_setpoint, COMMANDS)
            self._joint_commands = JointCommands(self, "position", self._take_setpoint)
        else:
            self._joint_commands = JointCommands(self, "duty", self._take_duty)
        self.create_service(SetBool, "~/enable", self._on_enable)
        self.create_timer(STATUS_PERIOD, self._look, clock=steady)
        self.open_parameters()

    def accept(self, changes: Mapping[str, Any]) -> None:
        """Put settings in force without a jump of the duty; a setpoint counts like one from the topic."""
        settings = self._settings({**self.values, **changes})
        if self.guarded is None:
            Setpoints(settings.angle_closed, settings.angle_open, settings.angle_closed).accepted(changes["setpoint"])
            return
        loop = self.guarded.loop
        if "setpoint" in changes:
            self._take_setpoint(changes["setpoint"])
        if settings != loop.controller.settings:
            loop.controller.change(settings)
            loop.setpoints.lower_stop = settings.angle_closed
            loop.setpoints.upper_stop = settings.angle_open
        self.guarded.configure({**self.values, **changes})
        if "hall_timeout" in changes and self._reports.good_samples.count:
            self._watch(changes["hall_timeout"])

    def activate(self) -> None:
        """Look for a place among the controllers of the graph; duties begin when it is found."""
        self._place.ask_anew()

    def deactivate(self) -> None:
        """Leave the valve to its spring, and the graph to others."""
        self._stop_sending()
        self._place.leave()

    def close(self) -> None:
        """Leave the valve to its spring."""
        self._stop_sending()

    def counters(self) -> Mapping[str, object]:
        """Samples answered so far, and whether they are."""
        if self.guarded is None:
            return {}
        return {
            "samples": self.guarded.counts.samples,
            "enabled": self.guarded.loop.controller.enabled,
            "active": self.is_active,
            "sending": self.outputs is not None,
        }

    def _prepared(self) -> GuardedController:
        """The loop compiled and behind its protections, the setpoint where it was told to be."""
        actuator = read_actuator(self.values["actuator"])
        self.diagnostics.hardware_id = self.values["hardware_id"] or actuator.name
        settings = self._settings(self.values)
        closed, opened = settings.angle_closed, settings.angle_open
        loop = SampledController(Controller(settings), Setpoints(closed, opened, closed))
        loop.prepare()
        loop.setpoints.offer(self.values["setpoint"])
        if self.values["setpoint_file"]:
            loop.schedule = read_setpoint_file(self.values["setpoint_file"])
        if self.values["command"] == "duty":
            loop.forwarded = CommandedDuty()
        return GuardedController(loop, actuator, self.values)

    def _settings(self, changes: Mapping[str, Any]) -> Settings:
        """The settings of the law with some changed; InputError where they do not go together."""
        current = self.guarded.loop.controller.settings if self.guarded else Settings()
        return current.with_values({each.name: changes[each.name] for each in LAW if each.name in changes})

    def _watch(self, timeout: float) -> None:
        """Expect the next sample within `timeout` [s]; 0: never mind."""
        if timeout > 0.0:
            self._watchdog.timer_period_ns = round(timeout * messages.SECOND)
            self._watchdog.reset()
        else:
            self._watchdog.cancel()

    def _on_hall_voltage(self, message: Float64, info: dict[str, int]) -> None:
        self._reports.samples.event(time.monotonic())
        sampled = self._sample_clock.at(info)
        if self.outputs is None:
            return
        if sampled is None:
            self._reports.no_clock()
            return
        before, setpoint = self.guarded.counts.samples, self.guarded.loop.setpoints.active
        self.outputs.duty(self.guarded.duty(message.data, sampled))
        is_new = self.guarded.counts.samples != before
        if is_new and self.guarded.objection is None:
            self._silent_since = None
            self._watch(self.values["hall_timeout"])
        self._reports.sample(is_new)
        if self.guarded.loop.setpoints.active != setpoint:
            self._publish_setpoint()
        if self.values["publish_internals"]:
            self.outputs.internals(self.guarded.loop.controller.internals)

    def _on_silence(self) -> None:
        now = time.monotonic()
        if self._silent_since is None:
            self._silent_since = now
            self._watch(self.values["hall_timeout"] if self.values["on_fault"] == "release" else FAULT_PERIOD)
        duty = self.guarded.silence(self._silence(now), now - self._silent_since)
        self._reports.fault()
        if self.outputs is not None:
            self.outputs.duty(duty)

    def _silence(self, now: float) -> str:
        """What kind of silence it is."""
        timeout = self.values["hall_timeout"]
        age = self._reports.samples.age(now)
        if age is None or age >= 0.5 * timeout:
            return f"no Hall sample for {timeout:g} s"
        if self._sample_clock.is_simulated:
            return f"/clock stands still: no new Hall sample for {timeout:g} s"
        return f"no Hall sample that can be true for {timeout:g} s"

    def _on_setpoint(self, message: Float64) -> None:
        try:
            self._take_setpoint(message.data)
        except InputError as error:
            self.diagnostics.refuse(str(error))
            self._publish_setpoint()

    def _take_setpoint(self, setpoint: float) -> None:
        """Put a setpoint [rad] in force; InputError where there can be none."""
        if self.guarded.loop.forwarded is not None:
            raise InputError("The controller has command duty: it forwards the effort of joint_commands.")
        self.guarded.loop.setpoints.offer(setpoint)
        self._publish_setpoint()

    def _take_duty(self, duty: float) -> None:
        """Forward a duty [1] with the next sample; InputError where it is not finite."""
        self._reports.forwarded(duty, self.guarded.loop.forwarded.offer(duty))

    def _on_enable(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        self.guarded.loop.controller.enable(request.data)
        response.success, response.message = True, "enabled" if request.data else "disabled: duty 0"
        return response

    def _look(self) -> None:
        """Now and then: who sends, what is in force, what is late."""
        if self.is_active:
            may = self._place.may_send(self.outputs, self._reports.samples, self.values["exclusive"])
            if may and self.outputs is None:
                self.guarded.restart()
                self.outputs = Outputs(self)
            elif not may and self.outputs is not None:
                self._stop_sending()
        self._publish_setpoint()
        self._reports.look(self.outputs is not None)

    def _stop_sending(self) -> None:
        self._watchdog.cancel()
        if self.outputs is not None:
            self.outputs.close()
            self.outputs = None

    def _publish_setpoint(self) -> None:
        if self.outputs is not None and self.guarded.loop.forwarded is None:
            self.outputs.setpoint(self.guarded.loop.setpoints.active)


def main() -> None:
    """Run the controller."""
    run(ControllerNode)
