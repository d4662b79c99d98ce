"""Which time a Hall sample was taken at, so that the control law integrates over the right interval."""

from __future__ import annotations

import time

from rclpy.node import Node
from rosgraph_msgs.msg import Clock

from pierburg_ros.nodes import messages
from pierburg_ros.nodes.qos import SIGNALS

GRACE = 0.02
"""Time [s] for which a sample waits for its `/clock`, which was sent before it but may be read after it."""


class SampleClock:
    """In wall time the stamp of a sample's sender; in simulated time the `/clock` sent before the sample."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self._reading = 0
        self._subscription = node.create_subscription(Clock, "/clock", self._on_clock, SIGNALS)

    def at(self, info: dict[str, int], last: int | None) -> int | None:
        """Time [ns] of the sample that came with `info`; None while no simulated time is known.

        `last` is the time of the sample before: where the clock has not moved since, this one is a repetition.
        """
        if not self._node.get_clock().ros_time_is_active:
            return info["source_timestamp"]
        self._read()
        end = time.monotonic() + GRACE
        while self._reading == last and time.monotonic() < end:
            self._read()
        return self._reading or None

    def _read(self) -> None:
        while taken := self._subscription.handle.take_message(Clock, False):
            self._on_clock(taken[0])

    def _on_clock(self, message: Clock) -> None:
        self._reading = messages.nanoseconds(message.clock)
