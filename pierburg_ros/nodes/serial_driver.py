"""A real actuator as a node: the topics of the plant, spoken with a device at the end of a serial line."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from typing import Any

from sensor_msgs.msg import JointState
from std_msgs.msg import Bool, Float64

from pierburg_ros.actuators import read_actuator
from pierburg_ros.nodes.core.joint import joint_name
from pierburg_ros.nodes.core.serial_driver_parameters import SERIAL_DRIVER
from pierburg_ros.nodes.core.shaft_sensor import ShaftSensor
from pierburg_ros.nodes.graph import messages
from pierburg_ros.nodes.graph.diagnostics import ERROR, WARN
from pierburg_ros.nodes.graph.parameters import LiveNode
from pierburg_ros.nodes.graph.qos import PUBLISHED, SIGNALS, STATE
from pierburg_ros.nodes.graph.running import run
from pierburg_ros.serial_line.link import Link, Received
from pierburg_ros.serial_line.port import Port, Unplugged

READ_PATIENCE = 0.1
"""Longest wait for bytes [s], after which silence and the end of the node are looked at."""
RETRY = 0.5
"""Time between two tries to open a line that is not there [s]: a device over USB takes as long to appear."""


class SerialDriverNode(LiveNode):
    """Sends `duty` to the device and publishes what it samples; a device that is lost is looked for again."""

    def __init__(self) -> None:
        super().__init__("serial_driver")
        self.link = Link()
        self._port: Port | None = None
        self._last: Received | None = None
        self._heard = time.monotonic()
        self._unsent = 0
        self._sensor: ShaftSensor | None = None
        self._thread = ThreadPoolExecutor(1, "line")
        self.declare(SERIAL_DRIVER)
        values = self.values
        self._joint = joint_name(values["joint"], self.get_namespace())
        self._sensor = ShaftSensor(read_actuator(values["actuator"]), values["velocity_time_constant"])
        self._hall = self.create_publisher(Float64, "hall_voltage", PUBLISHED)
        self._applied = self.create_publisher(Float64, "applied_duty", PUBLISHED)
        self._joints = self.create_publisher(JointState, "joint_states", PUBLISHED)
        self._supply = self.create_publisher(Float64, "supply_voltage", PUBLISHED)
        self._enabled = self.create_publisher(Bool, "enabled", STATE)
        self.create_subscription(Float64, "duty", self._on_duty, SIGNALS)
        self.open_parameters()

    def accept(self, changes: Mapping[str, Any]) -> None:
        """The filter of the velocity changes at once, the rest with the next command or look."""
        if "velocity_time_constant" in changes and self._sensor is not None:
            self._sensor.time_constant = changes["velocity_time_constant"]

    def counters(self) -> Mapping[str, object]:
        """What the line lost, and how the clocks differ."""
        link = self.link
        return {
            "lost": link.lost,
            "repeated": link.repeated,
            "damaged": link.damaged,
            "foreign": link.foreign,
            "unsent": self._unsent,
            "restarts": link.restarts,
            "clock_rate_ppm": f"{link.rate * 1e6:.0f}",
        }

    def begin(self) -> None:
        """Read the line in a thread of its own while duties are served."""
        self._reading = self._thread.submit(self._read)
        self._reading.add_done_callback(lambda _: self.stopping.set())

    def close(self) -> None:
        """Leave the valve to its spring, end the thread, and raise what ended it if anything did."""
        self._send(0.0)
        self._thread.shutdown()
        self._reading.result()

    def _read(self) -> None:
        while not self.stopping.is_set():
            try:
                with Port(self.values["port"], self.values["speed"]) as port:
                    self._port = port
                    self.diagnostics.end("unplugged")
                    self._listen(port)
            except Unplugged as error:
                self.diagnostics.begin("unplugged", ERROR, f"{self.values['port']} is gone ({error}): looking for it")
                self.stopping.wait(RETRY)
            finally:
                self._port = None

    def _listen(self, port: Port) -> None:
        self._heard = time.monotonic()
        while not self.stopping.is_set():
            data = port.read(READ_PATIENCE)
            for received in self.link.take(data, time.time_ns()):
                self._heard = time.monotonic()
                self._publish(received)
            if time.monotonic() - self._heard > self.values["silence_timeout"]:
                self.diagnostics.begin("silence", ERROR, "the device is silent")
            else:
                self.diagnostics.end("silence")

    def _publish(self, received: Received) -> None:
        state, last = received.state, self._last
        if received.restarted:
            self._sensor.reset()
            self.diagnostics.refuse("the device started anew")
        elapsed = 0.0 if last is None or received.restarted else (received.time - last.time) * 1e-9
        angle, velocity = self._sensor.take(state.hall_voltage, elapsed)
        self._hall.publish(messages.number(state.hall_voltage))
        self._applied.publish(messages.number(state.duty))
        self._joints.publish(messages.joint_state(self._joint, received.time, angle, velocity))
        if math.isfinite(state.supply_voltage):
            self._supply.publish(messages.number(state.supply_voltage))
        if last is None or last.state.enabled != state.enabled:
            self._enabled.publish(Bool(data=state.enabled))
        if state.timed_out:
            self.diagnostics.begin("command_timeout", WARN, "no duty reached the device in time: duty 0")
        else:
            self.diagnostics.end("command_timeout")
        self._last = received

    def _on_duty(self, message: Float64) -> None:
        if not math.isfinite(message.data):
            self.diagnostics.begin("duty_not_finite", ERROR, f"duty {message.data} is not finite and was not sent")
            return
        self.diagnostics.end("duty_not_finite")
        if abs(message.data) > 1.0:
            self.diagnostics.begin("duty_clipped", WARN, f"duty {message.data:g} is beyond +-1 and was clipped")
        else:
            self.diagnostics.end("duty_clipped")
        self._send(min(max(message.data, -1.0), 1.0))

    def _send(self, duty: float) -> None:
        port = self._port
        if port is None:
            return
        try:
            self._unsent += not port.write(self.link.command(duty, self.values["command_timeout"]))
        except Unplugged:
            self._unsent += 1


def main() -> None:
    """Run the serial driver."""
    run(SerialDriverNode)
