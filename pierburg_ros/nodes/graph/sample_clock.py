"""Which time a Hall sample was taken at, so that the control law integrates over the right interval."""

from __future__ import annotations

import time

from rclpy.node import Node
from rosgraph_msgs.msg import Clock

from pierburg_ros.nodes.core.sample_time import SampleTime, StampTime
from pierburg_ros.nodes.graph import messages
from pierburg_ros.nodes.graph.qos import SIGNALS

GRACE = 0.02
"""Time [s] for which a sample waits for its `/clock`, which was sent before it but may be read after it."""


class SampleClock:
    """In wall time the stamp of a sample's sender; in simulated time that of the `/clock` in force at its sending."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self.stamps = StampTime()
        self._times = SampleTime()
        self._subscription = node.create_subscription(Clock, "/clock", self._take, SIGNALS)

    @property
    def is_simulated(self) -> bool:
        """Whether the node goes by `/clock`."""
        return bool(self._node.get_clock().ros_time_is_active)

    def at(self, info: dict[str, int]) -> int | None:
        """Time [ns] of the sample that came with `info`; None while no simulated time is known."""
        sent = info["source_timestamp"]
        if not self.is_simulated:
            return self.stamps.at(sent)
        self.read()
        end = time.monotonic() + GRACE
        while self._times.paired and not self._times.has_own(sent) and time.monotonic() < end:
            self.read()
        return self._times.at(sent)

    def read(self) -> None:
        """Take in all that has come from `/clock`, which the executor might hand over too late."""
        while taken := self._subscription.handle.take_message(Clock, False):
            self._take(*taken)

    def _take(self, message: Clock, info: dict[str, int]) -> None:
        self._times.reading(info["source_timestamp"], messages.nanoseconds(message.clock))
