"""The recorder as a node: topics of any installed type to MCAP."""

from __future__ import annotations

import time
from collections.abc import Mapping
from datetime import datetime

from rclpy.clock import Clock, ClockType
from rclpy.serialization import deserialize_message, serialize_message
from rosgraph_msgs.msg import Clock as ClockMessage
from std_msgs.msg import String
from std_srvs.srv import SetBool, Trigger

from pierburg_ros.errors import InputError
from pierburg_ros.nodes import messages
from pierburg_ros.nodes.core.recorder_parameters import RECORDER
from pierburg_ros.nodes.core.source_order import SimulatedTime, SourceOrder
from pierburg_ros.nodes.definitions import type_name
from pierburg_ros.nodes.diagnostics import ERROR
from pierburg_ros.nodes.parameter_values import ParameterValues
from pierburg_ros.nodes.parameters import LiveNode
from pierburg_ros.nodes.recorded_topics import Received, RecordedTopics
from pierburg_ros.nodes.recording_file import RecordingFile, Topic
from pierburg_ros.nodes.recording_series import RecordingSeries
from pierburg_ros.nodes.running import run

HORIZON = 0.1
"""Time for which messages are held back to be written in the order of their sending [s]."""
WRITE_PERIOD = 0.05
"""Time between two writings [s]."""
LOOK_PERIOD = 0.5
"""Time between two looks at the graph [s]."""
CLOCK = "/clock"


class RecorderNode(LiveNode):
    """Records from its start to its end, unless told otherwise."""

    def __init__(self) -> None:
        super().__init__("recorder")
        self.file: RecordingFile | None = None
        self.topics: RecordedTopics | None = None
        self.declare(RECORDER)
        self._order: SourceOrder[Received] = SourceOrder(HORIZON)
        self._simulated = SimulatedTime()
        self._flushed = time.monotonic()
        as_bag = self.values["form"] == "rosbag2"
        self._series = RecordingSeries(self.values["output"], as_bag, datetime.now())
        self._values_topic = Topic(f"{self.get_fully_qualified_name()}/parameters", type_name(String))
        self._parameter_values = ParameterValues(self, self.values["parameters_of"], self._take_values)
        self._begin()
        wanted = dict.fromkeys([*self.values["topics"], *([CLOCK] if self._is_simulated() else [])])
        self.topics = RecordedTopics(self, wanted, self._take)
        self.create_service(SetBool, "~/record", self._on_record)
        self.create_service(Trigger, "~/split", self._on_split)
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self.create_timer(WRITE_PERIOD, self._write_due, clock=steady)
        self.create_timer(LOOK_PERIOD, self._look, clock=steady)
        self.open_parameters()

    def counters(self) -> Mapping[str, object]:
        """What is recorded where, and what was lost."""
        lost = sum(self.topics.lost.values()) if self.topics else 0
        path = str(self.file.path) if self.file else "not recording"
        return {"file": path, "messages": self.file.messages if self.file else 0, "lost_messages": lost}

    def close(self) -> None:
        """Write what has arrived and complete the file."""
        self.topics.drain()
        self._write(self._order.rest())
        self._end()

    def _begin(self) -> None:
        self.file = self._series.open()
        self._parameter_values.want()
        self.get_logger().info(f"recording {self.file.path}")

    def _end(self) -> None:
        if self.file is not None:
            self.file, finished = None, self.file
            self._series.finish()
            print(f"{finished.path}: {finished.messages} messages", flush=True)

    def _take(self, received: Received) -> None:
        sent = min(received.sent, received.arrived)
        if received.topic.name == CLOCK and self._is_simulated():
            reading = deserialize_message(received.data, ClockMessage)
            self._simulated.reading(sent, messages.nanoseconds(reading.clock))
        self._order.put(sent, received)

    def _take_values(self, text: str) -> None:
        now = time.time_ns()
        self._take(Received(self._values_topic, serialize_message(String(data=text)), 0, now, now))

    def _look(self) -> None:
        self.topics.look()
        self._parameter_values.ask()

    def _write_due(self) -> None:
        self._write(self._order.due(time.time_ns()))

    def _write(self, received: list[Received]) -> None:
        if self.file is None:
            return
        try:
            for each in received:
                published, logged = self._times(each)
                self.file.add(each.topic, each.data, each.sequence, published, logged)
            if time.monotonic() - self._flushed > self.values["flush_interval"]:
                self.file.flush()
                self._flushed = time.monotonic()
        except OSError as error:
            self.file = None
            self.diagnostics.begin("write", ERROR, f"recording ended: {error.strerror}")

    def _times(self, received: Received) -> tuple[int, int]:
        if not self._is_simulated():
            return received.sent, received.arrived
        sent = min(received.sent, received.arrived)
        return self._simulated.at(sent), self._simulated.at(sent)

    def _is_simulated(self) -> bool:
        return bool(self.get_parameter("use_sim_time").value)

    def _on_record(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        try:
            if request.data and self.file is None:
                self._begin()
            elif not request.data:
                self.close()
            response.success, response.message = True, self.counters()["file"]
        except InputError as error:
            response.success, response.message = False, str(error)
        return response

    def _on_split(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        if self.file is None:
            response.success, response.message = False, "not recording"
            return response
        try:
            self.close()
            self._begin()
            response.success, response.message = True, str(self.file.path)
        except InputError as error:
            response.success, response.message = False, str(error)
        return response


def main() -> None:
    """Run the recorder."""
    run(RecorderNode)
