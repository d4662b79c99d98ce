"""Excitation as a node: plays a duty or setpoint file to the graph, paced by the Hall samples."""

from __future__ import annotations

from typing import Any

from rclpy.clock import Clock, ClockType
from std_msgs.msg import Float64

from pierburg_ros.control import Schedule, read_duty_file, read_setpoint_file
from pierburg_ros.errors import InputError
from pierburg_ros.nodes.graph import messages
from pierburg_ros.nodes.graph.parameters import LiveNode
from pierburg_ros.nodes.graph.qos import COMMANDS, PUBLISHED
from pierburg_ros.nodes.graph.running import run
from pierburg_ros.nodes.graph.signals import Signal
from pierburg_ros.parameter import Parameter as Declaration

EXCITATION = (
    Declaration("duty_file", "", "CSV of time [s] and duty to play instead of a controller", fixed=True),
    Declaration("setpoint_file", "", "CSV of time [s] and setpoint [rad] for a controller", fixed=True),
    Declaration("patience", 60.0, "time without Hall samples after which it gives up", "s", 0.5, 600.0),
)


class ExcitationNode(LiveNode):
    """Answers each Hall sample with the duty in force, or sends setpoints when they change; once through."""

    def __init__(self) -> None:
        super().__init__("excitation")
        self.declare(EXCITATION)
        self.schedule = self._schedule(self.values)
        self._is_duty = bool(self.values["duty_file"])
        topic, quality = ("duty", PUBLISHED) if self._is_duty else ("setpoints", COMMANDS)
        self._publisher = self.create_publisher(Float64, topic, quality)
        self._first: int | None = None
        self._sent: float | None = None
        self._hall_voltage = Signal(self, Float64, "hall_voltage", self._on_hall_voltage)
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._watchdog = self.create_timer(self.values["patience"], self._on_silence, clock=steady)
        self.open_parameters()

    def _schedule(self, values: dict[str, Any]) -> Schedule:
        duty, setpoints = values["duty_file"], values["setpoint_file"]
        if bool(duty) == bool(setpoints):
            raise InputError("excitation found both files or none, expected duty_file or setpoint_file.")
        return read_duty_file(duty) if duty else read_setpoint_file(setpoints)

    def _on_hall_voltage(self, message: Float64, info: dict[str, int]) -> None:
        self._watchdog.reset()
        now = self._time(info)
        if self._first is None:
            if self._publisher.get_subscription_count() == 0:
                return
            self._first = now
        elapsed = (now - self._first) * 1e-9
        if elapsed >= self.schedule.time[-1]:
            self.finish()
        else:
            self._send(self.schedule.at(elapsed))

    def _time(self, info: dict[str, int]) -> int:
        """Time of a sample [ns]: in wall time its sender's stamp, which the way here does not delay."""
        if self.get_clock().ros_time_is_active:
            return int(self.get_clock().now().nanoseconds)
        return info["source_timestamp"]

    def _send(self, value: float) -> None:
        if self._is_duty or value != self._sent:
            self._publisher.publish(messages.number(value))
            self._sent = value

    def finish(self) -> None:
        """Leave the shaft to its spring, or the setpoint at the closed stop, and end."""
        if not self.stopping.is_set():
            self._publisher.publish(messages.number(0.0))
            self.stopping.set()

    def _on_silence(self) -> None:
        raise InputError(
            f"No Hall sample came for {self.values['patience']:g} s, expected a plant on the graph."
            " Start one with 'pierburg run plant'."
        )


def main() -> None:
    """Run the excitation."""
    run(ExcitationNode)
