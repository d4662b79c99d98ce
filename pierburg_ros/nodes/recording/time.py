"""Times of recorded messages, and how far the recorder has got, for a plant that makes the time."""

from __future__ import annotations

from collections.abc import Iterable
from time import monotonic

from rclpy.node import Node
from rclpy.serialization import deserialize_message
from rosgraph_msgs.msg import Clock as ClockMessage
from std_msgs.msg import Header

from pierburg_ros.nodes.core.source_order import SimulatedTime
from pierburg_ros.nodes.graph import messages
from pierburg_ros.nodes.graph.qos import PROGRESS
from pierburg_ros.nodes.recording.topics import Received

CLOCK = "/clock"
RECORDED_UNTIL = "/recorded_until"
"""Topic on which a recorder in simulated time says up to when it has everything; no stamp says that it leaves."""
FILES_APART = 1.0
"""Least time [s] between two files that a jump back begins: two sources of /clock jump at every reading."""
Timed = tuple[Received, int, int]
"""A message with its publish and log times [ns]."""
OF_THE_PLANT = ("hall_voltage", "applied_duty", "joint_states")
"""Topics with a message for every tick."""


class RecordedTime:
    """In wall time a message's own times; in simulated time the `/clock` in force when it was sent."""

    def __init__(self, node: Node, is_simulated: bool) -> None:
        self._is_simulated = is_simulated
        self._simulated = SimulatedTime()
        self._name = node.get_fully_qualified_name()
        self._followed = {CLOCK, *(node.resolve_topic_name(name) for name in OF_THE_PLANT)}
        self._last: dict[str, int] = {}
        self._held: dict[str, Received] = {}
        self._latest, self._newest, self._jumped = 0, 0, -FILES_APART
        self._publisher = node.create_publisher(Header, RECORDED_UNTIL, PROGRESS) if is_simulated else None

    def take(self, received: Received, sent: int) -> None:
        """Note a message that was `sent` [ns] and has come."""
        name = received.topic.name
        if self._is_simulated and name in self._followed:
            self._last[name] = sent
            if name == CLOCK:
                reading = deserialize_message(received.data, ClockMessage)
                self._simulated.reading(sent, messages.nanoseconds(reading.clock))

    @property
    def waits(self) -> bool:
        """Whether there is no time yet, for the first `/clock` has not come."""
        return self._is_simulated and CLOCK not in self._last

    def parts(self, received: Iterable[Received]) -> list[list[Timed]]:
        """Messages with their times, another part wherever simulated time goes back.

        Before the first `/clock` there is no time: what lasts is held until then, and the rest left out.
        """
        if not self._is_simulated:
            return [[(each, each.sent, each.arrived) for each in received]]
        found: list[list[Timed]] = [[]]
        for each in received:
            time = self._simulated.at(min(each.sent, each.arrived))
            if time is None:
                self._held |= {each.topic.name: each} if each.topic.lasts else {}
                continue
            if each.topic.name == CLOCK and self._goes_back(each.sent, time):
                found.append([])
            found[-1] += [(held, time, time) for held in (*self._held.values(), each)]
            self._held.clear()
        return found

    def _goes_back(self, sent: int, time: int) -> bool:
        """Whether the `/clock` in force when a later one was `sent` [ns] reads less: what is only late goes nowhere."""
        if sent < self._newest:
            return False
        back, self._latest, self._newest = time < self._latest, time, sent
        now = monotonic()
        if not back or now - self._jumped < FILES_APART:
            return False
        self._jumped = now
        return True

    def tell(self) -> None:
        """Publish up to which simulated time every message of the plant has come."""
        until = self._simulated.at(min(self._last.values())) if self._last else None
        if until is not None:
            self._publish(until)

    def leave(self) -> None:
        """Publish that nobody need wait any more."""
        if self._is_simulated:
            self._publish(0)

    def _publish(self, time: int) -> None:
        self._publisher.publish(Header(frame_id=self._name, stamp=messages.stamp(time)))
