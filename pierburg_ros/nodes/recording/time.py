"""Times of recorded messages, and how far the recorder has got, for a plant that makes the time."""

from __future__ import annotations

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
        self._publisher = node.create_publisher(Header, RECORDED_UNTIL, PROGRESS) if is_simulated else None

    def take(self, received: Received, sent: int) -> None:
        """Note a message that was `sent` [ns] and has come."""
        name = received.topic.name
        if self._is_simulated and name in self._followed:
            self._last[name] = sent
            if name == CLOCK:
                reading = deserialize_message(received.data, ClockMessage)
                self._simulated.reading(sent, messages.nanoseconds(reading.clock))

    def of(self, received: Received) -> tuple[int, int]:
        """Publish and log time [ns] of a message."""
        if not self._is_simulated:
            return received.sent, received.arrived
        time = self._simulated.at(min(received.sent, received.arrived))
        return time, time

    def tell(self) -> None:
        """Publish up to which simulated time every message of the plant has come."""
        if self._last and CLOCK in self._last:
            self._publish(self._simulated.at(min(self._last.values())))

    def leave(self) -> None:
        """Publish that nobody need wait any more."""
        if self._is_simulated:
            self._publish(0)

    def _publish(self, time: int) -> None:
        self._publisher.publish(Header(frame_id=self._name, stamp=messages.stamp(time)))
