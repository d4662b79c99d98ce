"""The recorder as a node: topics of any installed type to MCAP."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from datetime import datetime

from rclpy.clock import Clock, ClockType
from rclpy.serialization import serialize_message
from std_msgs.msg import String
from std_srvs.srv import SetBool, Trigger

from pierburg_ros.errors import InputError
from pierburg_ros.nodes.core.recorder_parameters import RECORDER
from pierburg_ros.nodes.core.source_order import SourceOrder
from pierburg_ros.nodes.graph.diagnostics import ERROR, WARN
from pierburg_ros.nodes.graph.parameter_values import ParameterValues
from pierburg_ros.nodes.graph.parameters import LiveNode
from pierburg_ros.nodes.graph.running import run
from pierburg_ros.nodes.recording.definitions import type_name
from pierburg_ros.nodes.recording.file import Topic
from pierburg_ros.nodes.recording.receiver import Receiver
from pierburg_ros.nodes.recording.series import RecordingSeries
from pierburg_ros.nodes.recording.time import CLOCK, RecordedTime
from pierburg_ros.nodes.recording.topics import Received, RecordedTopics
from pierburg_ros.nodes.recording.writer import RecordingWriter

HORIZON = 0.1
"""Time for which messages are held back to be written in the order of their sending [s]."""
WRITE_PERIOD = 0.05
"""Time between two writings [s]."""
AT_THE_START = 5_000_000_000
"""Time [ns] for which messages wait for the first `/clock`, which may be read after what was sent behind it."""
SPLIT_PATIENCE = 5.0
"""Longest wait [s] for what was sent before a file is to end: a publisher that was killed is waited for in vain."""
LOOK_PERIOD = 0.5
"""Time between two looks at the graph [s]."""


class RecorderNode(LiveNode):
    """Records from its start to its end, unless told otherwise."""

    def __init__(self) -> None:
        super().__init__("recorder")
        self.writer: RecordingWriter | None = None
        self.topics: RecordedTopics | None = None
        self.declare(RECORDER)
        self._order: SourceOrder[Received] = SourceOrder(HORIZON)
        self._values_topic = Topic(f"{self.get_fully_qualified_name()}/parameters", type_name(String))
        self._parameter_values = ParameterValues(self, self.values["parameters_of"], self._take_values)
        series = RecordingSeries(self.values["output"], self.values["form"] == "rosbag2", datetime.now())
        self.writer = RecordingWriter(series)
        clock = [CLOCK] if self.is_simulated else []
        self.topics = RecordedTopics(self, dict.fromkeys([*self.values["topics"], *clock]))
        self._time = RecordedTime(self, self.is_simulated)
        self._receiver = Receiver(self.topics)
        self.create_service(SetBool, "~/record", self._on_record)
        self.create_service(Trigger, "~/split", self._on_split)
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self.create_timer(WRITE_PERIOD, self._write_due, clock=steady)
        self.create_timer(LOOK_PERIOD, self._look, clock=steady)
        self.open_parameters()

    def counters(self) -> Mapping[str, object]:
        """What is recorded where, and what was lost, in all and by topic."""
        file = self.writer.file if self.writer else None
        losses = self._losses()
        return {
            "file": str(file.path) if file else "not recording",
            "messages": file.messages if file else 0,
            "lost_messages": sum(lost for lost, _ in losses.values()),
            **{f"lost_messages {name}": f"{lost} of {lost + got}" for name, (lost, got) in losses.items() if lost},
            "unwritten_messages": self.writer.unwritten if self.writer else 0,
        }

    def begin(self) -> None:
        """Open the first file, now that no signal interrupts what completes it."""
        self._begin()

    def close(self) -> None:
        """Write what has arrived and complete the file; InputError where the disk does not take it."""
        self._receiver.stop()
        self._time.leave()
        self._drain()
        summary = self._end() if self.writer.file is not None else ""
        if self.writer.problem:
            raise InputError(self.writer.problem)
        if summary:
            print(summary, flush=True)

    def _begin(self) -> None:
        """Go on in a new file; InputError, and the old one goes on, where there can be none."""
        self.writer.begin()
        self._parameter_values.want()
        self.diagnostics.end("write")
        self.diagnostics.end("lost")
        self.get_logger().info(f"recording {self.writer.file.path}")

    def _end(self) -> str:
        """Complete the file and say what is in it."""
        file = self.writer.file
        self.writer.end()
        if self.writer.problem:
            return self.writer.problem
        return f"{file.path}: {file.messages} messages, {sum(lost for lost, _ in file.losses.values())} lost"

    def _drain(self, until: float = math.inf) -> None:
        """Write what has arrived and was sent up to a time [ns]."""
        self._receiver.turn()
        self._take()
        self._write(self._order.until(until))

    def _catch_up(self) -> str:
        """Write what was sent before this call, waiting for what is on the way; what is to be said of the rest."""
        called, end = time.time_ns(), time.monotonic() + SPLIT_PATIENCE
        came, behind = True, list[str]()
        while (came or behind) and time.monotonic() < end and not self.stopping.wait(WRITE_PERIOD):
            came, behind = self._take() <= called, self.topics.behind(called)
            self._time.tell()
        self._drain(called)
        late = ", ".join(sorted(behind))
        return f"; nothing newer came on {late}: what is on the way goes into the next file" if behind else ""

    def _take(self) -> float:
        """Put what has come in order; when the earliest of it was sent [ns]."""
        earliest = math.inf
        for received in self._receiver.received():
            sent = min(received.sent, received.arrived)
            self._time.take(received, sent)
            self._order.put(sent, received, received.taken)
            earliest = min(earliest, sent)
        return earliest

    def _take_values(self, text: str) -> None:
        now = time.time_ns()
        self._order.put(now, Received(self._values_topic, serialize_message(String(data=text)), 0, now, now, now))

    def _look(self) -> None:
        self.topics.look()
        self._parameter_values.ask()
        self._report()
        if self.writer.is_due_again():
            self._try_again()

    def _losses(self) -> dict[str, tuple[int, int]]:
        file = self.writer.file if self.writer else None
        return file.losses if file else {}

    def _report(self) -> None:
        losses = {name: lost for name, (lost, _) in self._losses().items() if lost}
        if self._time.waits:
            self.diagnostics.begin("clock", WARN, "waiting for /clock, since use_sim_time is set: nothing is recorded")
        else:
            self.diagnostics.end("clock")
        if losses:
            text = ", ".join(f"{name} {lost}" for name, lost in sorted(losses.items()))
            self.diagnostics.begin("lost", WARN, f"messages lost on the way to the recorder: {text}")

    def _try_again(self) -> None:
        try:
            self._begin()
        except InputError as error:
            self.get_logger().debug(str(error))

    def _write_due(self) -> None:
        self._take()
        first_clock = AT_THE_START if self._time.waits else 0
        self._write(self._order.due(time.time_ns() - first_clock))
        self._time.tell()

    def _write(self, received: list[Received]) -> None:
        for number, timed in enumerate(self._time.parts(received)):
            if number and self.writer.file is not None:
                self._try_again()
            if not self.writer.write(timed, self.values["flush_interval"]):
                self.diagnostics.begin("write", ERROR, self.writer.problem)

    def _on_record(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        try:
            if request.data and self.writer.file is None:
                self._drain()
                self._begin()
            elif not request.data and self.writer.file is not None:
                rest = self._catch_up()
                response.message = (self._end() if self.writer.file is not None else self.writer.problem) + rest
            response.success = not self.writer.problem
            response.message = response.message or str(self.counters()["file"])
            if not request.data:
                self._rest()
        except InputError as error:
            response.success, response.message = False, str(error)
        return response

    def _rest(self) -> None:
        """Not to record is what was asked for: no file is missing."""
        self.writer.rest()
        self.diagnostics.end("write")

    def _on_split(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        if self.writer.file is None:
            response.success, response.message = False, self.writer.problem or "not recording"
            return response
        try:
            rest = self._catch_up()
            self._begin()
            response.success, response.message = True, f"{self.writer.file.path}{rest}"
        except InputError as error:
            response.success, response.message = False, str(error)
        return response


def main() -> None:
    """Run the recorder."""
    run(RecorderNode)
