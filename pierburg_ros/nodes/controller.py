"""The PIFLC as a node: one duty for every Hall sample."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from rclpy.clock import Clock, ClockType
from std_msgs.msg import Bool, Float64
from std_srvs.srv import SetBool

from pierburg_ros.control import Controller, Setpoints, Settings, read_setpoint_file
from pierburg_ros.errors import InputError
from pierburg_ros.nodes import messages
from pierburg_ros.nodes.core.controller_parameters import CONTROLLER, LAW
from pierburg_ros.nodes.core.sampled_controller import SampledController
from pierburg_ros.nodes.diagnostics import ERROR
from pierburg_ros.nodes.parameters import LiveNode
from pierburg_ros.nodes.qos import COMMANDS, PUBLISHED
from pierburg_ros.nodes.running import run
from pierburg_ros.nodes.sample_clock import SampleClock
from pierburg_ros.nodes.signals import Signal

STATUS_PERIOD = 0.1
"""Time between two publications of an unchanged `active_setpoint` [s]."""


class ControllerNode(LiveNode):
    """Answers Hall samples with duties; a lost sensor is answered with duty 0."""

    def __init__(self) -> None:
        super().__init__("controller")
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._duty = self.create_publisher(Float64, "duty", PUBLISHED)
        self._active_setpoint = self.create_publisher(Float64, "active_setpoint", PUBLISHED)
        self._watchdog = self.create_timer(3600.0, self._on_silence, clock=steady)
        self.loop: SampledController | None = None
        self.samples = 0
        self.declare(LAW)
        settings = self._settings(self.values)
        self.loop = SampledController(
            Controller(settings), Setpoints(settings.angle_closed, settings.angle_open, settings.angle_closed)
        )
        self.loop.prepare()
        self.declare(CONTROLLER)
        if self.values["setpoint_file"]:
            self.loop.schedule = read_setpoint_file(self.values["setpoint_file"])
        self._internals = {
            name: self.create_publisher(kind, f"~/{name}", PUBLISHED) for name, kind in INTERNALS.items()
        }
        self._sample_clock = SampleClock(self)
        self._hall_voltage = Signal(self, Float64, "hall_voltage", self._on_hall_voltage)
        self.create_subscription(Float64, "setpoints", self._on_setpoint, COMMANDS)
        self.create_service(SetBool, "~/enable", self._on_enable)
        self.create_timer(STATUS_PERIOD, self._publish_setpoint, clock=steady)
        self.open_parameters()

    def accept(self, changes: Mapping[str, Any]) -> None:
        """Put settings in force without a jump of the duty; a setpoint counts like one from the topic."""
        settings = self._settings(changes)
        if self.loop is None:
            return
        if "setpoint" in changes:
            self.loop.setpoints.offer(changes["setpoint"])
            self._publish_setpoint()
        if settings != self.loop.controller.settings:
            self.loop.controller.change(settings)
            self.loop.setpoints.lower_stop = settings.angle_closed
            self.loop.setpoints.upper_stop = settings.angle_open
        if "hall_timeout" in changes:
            self._watch(changes["hall_timeout"])

    def close(self) -> None:
        """Leave the valve to its spring."""
        self._duty.publish(messages.number(0.0))

    def counters(self) -> Mapping[str, object]:
        """Samples answered so far."""
        return {"samples": self.samples, "enabled": self.loop is None or self.loop.controller.enabled}

    def _settings(self, changes: Mapping[str, Any]) -> Settings:
        """The settings of the law with some changed; InputError where they do not go together."""
        current = self.loop.controller.settings if self.loop else Settings()
        return current.with_values({each.name: changes[each.name] for each in LAW if each.name in changes})

    def _watch(self, timeout: float) -> None:
        if timeout > 0.0:
            self._watchdog.timer_period_ns = round(timeout * messages.SECOND)
            self._watchdog.reset()
        else:
            self._watchdog.cancel()

    def _on_hall_voltage(self, message: Float64, info: dict[str, int]) -> None:
        if not self._watchdog.is_canceled():
            self._watchdog.reset()
        self.diagnostics.end("hall_timeout")
        if math.isfinite(message.data):
            self.diagnostics.end("hall_voltage_not_finite")
        else:
            self.diagnostics.begin("hall_voltage_not_finite", ERROR, f"Hall voltage {message.data}: last duty kept")
        time = self._sample_clock.at(info, self.loop.last)
        if time is None:
            return
        self.samples += 1
        setpoint = self.loop.setpoints.active
        self._duty.publish(messages.number(self.loop.duty(message.data, time)))
        if self.loop.setpoints.active != setpoint:
            self._publish_setpoint()
        if self.values["publish_internals"]:
            self._publish_internals()

    def _on_silence(self) -> None:
        timeout = self.values["hall_timeout"]
        self.diagnostics.begin("hall_timeout", ERROR, f"no Hall sample for {timeout:g} s: duty 0")
        self.loop.interrupt()
        self._duty.publish(messages.number(0.0))

    def _on_setpoint(self, message: Float64) -> None:
        try:
            self.loop.setpoints.offer(message.data)
        except InputError as error:
            self.diagnostics.refuse(str(error))
        self._publish_setpoint()

    def _on_enable(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        self.loop.controller.enable(request.data)
        response.success, response.message = True, "enabled" if request.data else "disabled: duty 0"
        return response

    def _publish_setpoint(self) -> None:
        self._active_setpoint.publish(messages.number(self.loop.setpoints.active))

    def _publish_internals(self) -> None:
        internals = self.loop.controller.internals
        for name, publisher in self._internals.items():
            publisher.publish(INTERNALS[name](data=getattr(internals, name)))


INTERNALS = {"error": Float64, "pi_output": Float64, "derivative": Float64, "saturated": Bool}
"""What `publish_internals` publishes: the internals of the control law and their message types."""


def main() -> None:
    """Run the controller."""
    run(ControllerNode)
