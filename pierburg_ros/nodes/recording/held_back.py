"""Holds the source of simulated time back while a recorder is too far behind."""

from __future__ import annotations

from threading import Event

from rclpy.node import Node
from std_msgs.msg import Header

from pierburg_ros.nodes.core.follower import Follower
from pierburg_ros.nodes.graph import messages
from pierburg_ros.nodes.graph.diagnostics import WARN, Diagnostics
from pierburg_ros.nodes.graph.qos import PROGRESS
from pierburg_ros.nodes.recording.time import RECORDED_UNTIL

RECORDER_LOOK = 0.002
"""Time [s] between two looks whether a recorder has moved."""


class HeldBack:
    """Waits for every recorder that says how far it is, and for none that is gone."""

    def __init__(self, node: Node, diagnostics: Diagnostics, stopping: Event) -> None:
        self._diagnostics = diagnostics
        self._stopping = stopping
        self._followers: dict[str, Follower] = {}
        self._subscription = node.create_subscription(Header, RECORDED_UNTIL, self._on_progress, PROGRESS)

    def wait(self, now: int, period: int) -> bool:
        """Return when the tick at `now` [ns] may be followed by another one; whether that took any waiting."""
        waited = False
        while self.must_wait(now, period) and not self._stopping.wait(RECORDER_LOOK):
            waited = True
        return waited

    def must_wait(self, now: int, period: int) -> bool:
        """Whether the tick at `now` [ns], ticks being `period` [ns] apart, is too far ahead of a recorder."""
        followers = list(self._followers.values())
        waits = [each.must_wait(now, period) for each in followers]
        if any(each.given_up for each in followers):
            self._diagnostics.begin("recorder", WARN, "a recorder does not follow and is not waited for")
        else:
            self._diagnostics.end("recorder")
        return any(waits)

    def _on_progress(self, message: Header) -> None:
        until = messages.nanoseconds(message.stamp)
        if until == 0:
            self._followers.pop(message.frame_id, None)
        else:
            self._followers.setdefault(message.frame_id, Follower()).progress(until)
