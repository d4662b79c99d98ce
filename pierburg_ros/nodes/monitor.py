"""The monitor as a node: follows duty and sensor of a running actuator, and warns when the model no longer holds."""

from __future__ import annotations

import time
from collections.abc import Mapping

import numpy as np
from rclpy.clock import Clock, ClockType
from rclpy.task import Future
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64
from std_srvs.srv import Trigger

from pierburg_ros.actuators import read_actuator
from pierburg_ros.errors import InputError
from pierburg_ros.monitoring.evidence import decoded
from pierburg_ros.monitoring.findings import Finding
from pierburg_ros.monitoring.monitor import Monitor
from pierburg_ros.monitoring.pairing import Angle, Pairing
from pierburg_ros.nodes.core.joint import joint_name
from pierburg_ros.nodes.core.monitor_parameters import MONITOR
from pierburg_ros.nodes.graph import messages
from pierburg_ros.nodes.graph.diagnostics import ERROR, WARN
from pierburg_ros.nodes.graph.drained import Drained, Unserved
from pierburg_ros.nodes.graph.parameters import LiveNode
from pierburg_ros.nodes.graph.running import run
from pierburg_ros.plant import Model
from pierburg_ros.plant.model_file import read_model

MONITOR_LOOK = 0.1
"""Time between two looks at the topics [s]: as long as a movement that ended may wait to be judged."""
SILENCE = 2.0
"""Time without samples [s] after which that is said: longer than a node takes to start to publish once connected."""
SPLITS_APART = 60.0
"""Least time between two splits of the recording [s], so that a finding that flickers leaves no crumbs."""


class MonitorNode(LiveNode):
    """Reports drift, faults of the sensor and suspected physics on `/diagnostics`, and has the recording split."""

    def __init__(self) -> None:
        super().__init__("monitor")
        self.monitor: Monitor | None = None
        self.declare(MONITOR)
        values = self.values
        self._model = watched_model(values["actuator"], values["model"])
        self.get_logger().info("preparing the simulator, which is compiled at its first start on a machine")
        self.monitor = Monitor(self._model, values["tolerance"], values["misfit_tolerance"], values["offset_tolerance"])
        self.monitor.prepare()
        by_joint, applied = values["angle_topic"] == "joint_states", values["duty_topic"] == "applied_duty"
        self._pairing = Pairing(follows=applied and not by_joint, every_tick=applied)
        group = Unserved()
        kind, self._angle = (JointState, self._of_joint) if by_joint else (Float64, self._of_voltage)
        self._angles = Drained(self, kind, values["angle_topic"], group)
        self._duties = Drained(self, Float64, values["duty_topic"], group)
        self._supplies = Drained(self, Float64, "supply_voltage", group)
        self._split = self.create_client(Trigger, f"{values['recorder']}/split") if values["recorder"] else None
        self._joint = joint_name(values["joint"], self.get_namespace())
        self._split_at, self._recording, self._strangers = -SPLITS_APART, "", ""
        self._heard = dict.fromkeys((values["angle_topic"], values["duty_topic"]), time.monotonic())
        self.samples = 0
        self.create_timer(MONITOR_LOOK, self._look, clock=Clock(clock_type=ClockType.STEADY_TIME))
        self.open_parameters()

    def counters(self) -> Mapping[str, object]:
        """What was seen, and the windows of the findings in force [s, by the samples' clock]."""
        if self.monitor is None:
            return {}
        windows = [f"{self._stamped(f.start):.3f} to {self._stamped(f.end):.3f}" for f in self.monitor.findings]
        return {
            "samples": self.samples,
            "lost": self._pairing.lost,
            "movements": self.monitor.movements,
            "sensor_noise_rad": f"{self.monitor.noise:.3g}",
            "supply_over_model": f"{self.monitor.judgement.supply:.3f}",
            "windows": ", ".join(windows),
            "recording": self._recording,
        }

    def _look(self) -> None:
        for message, info in self._angles.taken():
            self._angle(message, info["source_timestamp"], info["publication_sequence_number"])
        for message, info in self._duties.taken():
            self._heard[self.values["duty_topic"]] = time.monotonic()
            self._pairing.duty(info["source_timestamp"], info["publication_sequence_number"], message.data)
        for message, info in self._supplies.taken():
            self._pairing.supply(info["source_timestamp"], message.data)
        self._report_silence()
        samples = self._pairing.paired(time.time_ns())
        self.samples += samples.time.size
        for change in self.monitor.take(samples):
            self._report(change.finding, change.begins)

    def _of_joint(self, message: JointState, sent: int, number: int) -> None:
        if self._joint not in message.name or len(message.position) != len(message.name):
            self._strangers = ", ".join(message.name)
            return
        angle = message.position[message.name.index(self._joint)]
        self._of_sample(Angle(messages.nanoseconds(message.header.stamp), sent, number, angle))

    def _of_voltage(self, message: Float64, sent: int, number: int) -> None:
        angle = decoded(self._model.actuator, np.float64(message.data))
        self._of_sample(Angle(sent, sent, number, float(angle)))

    def _of_sample(self, angle: Angle) -> None:
        self._heard[self.values["angle_topic"]], self._strangers = time.monotonic(), ""
        self._pairing.angle(angle)

    def _report_silence(self) -> None:
        silent = " and ".join(topic for topic, at in self._heard.items() if time.monotonic() - at > SILENCE)
        if not silent:
            self.diagnostics.end("silence")
            return
        found = f" (found {self._strangers}, expected {self._joint})" if self._strangers else ""
        text = f"no samples on {silent} for {SILENCE:g} s{found}: nothing is watched"
        self.diagnostics.begin("silence", WARN, text)

    def _report(self, finding: Finding, begins: bool) -> None:
        condition = " ".join((finding.kind, *finding.names))
        if not begins:
            self.diagnostics.end(condition)
            return
        window = f"{self._stamped(finding.start):.3f} to {self._stamped(finding.end):.3f} s"
        level = ERROR if finding.kind == "sensor" else WARN
        self._keep_recording()
        self.diagnostics.begin(condition, level, f"{finding.text} (samples of {window})")

    def _stamped(self, elapsed: float) -> float:
        """Time of a sample [s] by the clock that stamped it."""
        return (self._pairing.origin or 0) * 1e-9 + elapsed

    def _keep_recording(self) -> None:
        """Have the recording end here, so that the file that holds the window can be kept."""
        now = time.monotonic()
        if self._split is None or now - self._split_at < SPLITS_APART:
            return
        if not self._split.service_is_ready():
            self._recording = f"no recorder called {self.values['recorder']}: nothing kept"
            return
        self._split_at = now
        self._split.call_async(Trigger.Request()).add_done_callback(self._on_split)

    def _on_split(self, future: Future) -> None:
        answer = future.result()
        kept = "keep the recording that ended; the next is" if answer.success else "the recorder did not split:"
        self._recording = f"{kept} {answer.message}"
        self.get_logger().info(self._recording)
        self.diagnostics.report()


def watched_model(actuator: str, path: str) -> Model:
    """The model of a file, or the nominal one of an actuator; InputError where its supply is none of its parameters."""
    model = read_model(path) if path else Model.nominal(read_actuator(actuator))
    if model.actuator.quantity == "speed":
        raise InputError(
            f"Actuator {model.actuator.name} measures its speed; the monitor follows angles. Choose another one."
        )
    if model.values.get("supply_voltage", 0.0) == 0.0:
        raise InputError(
            f"Actuator {model.actuator.name} has no supply_voltage; the monitor follows actuators that are driven by "
            "duty x supply voltage. Give one."
        )
    return model


def main() -> None:
    """Run the monitor."""
    run(MonitorNode)
