"""What the plant says on `/diagnostics` about the duties that it gets and who else is on its topics."""

from __future__ import annotations

import time

from rclpy.clock import Clock, ClockType

from pierburg_ros.nodes.core.rate import Rate
from pierburg_ros.nodes.graph.diagnostics import ERROR, OK, WARN
from pierburg_ros.nodes.graph.parameters import LiveNode
from pierburg_ros.nodes.graph.publishers import listed, publishers_of

TASK = "duty"
GRAPH_LOOK = 0.5
"""Time between two looks at the graph for others [s]."""


class PlantReports:
    """Counts duties and names what is wrong with them."""

    def __init__(self, node: LiveNode) -> None:
        self._node = node
        self._diagnostics = node.diagnostics
        self._received = Rate()
        self._refused = self._clipped = 0
        self._diagnostics.task(TASK, "obeyed", self._values)
        self._diagnostics.begin("waiting", OK, "waiting for duty", TASK)
        node.create_timer(GRAPH_LOOK, self._look, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def duty(self, duty: float, is_within: bool) -> None:
        """A duty [1] was taken, clipped where it was not within its range."""
        self._received.event(time.monotonic())
        self._diagnostics.end("waiting")
        self._diagnostics.end("duty_not_finite")
        if is_within:
            self._diagnostics.end("duty_clipped")
        else:
            self._clipped += 1
            self._diagnostics.begin("duty_clipped", WARN, f"duty {duty:g} is beyond +-1 and was clipped", TASK)

    def refused(self, text: str) -> None:
        """A duty was refused."""
        self._refused += 1
        self._diagnostics.begin("duty_not_finite", ERROR, text, TASK)

    def timeout(self, is_lost: bool, timeout: float) -> None:
        """Whether the last duty is older than `timeout` [s]."""
        if is_lost:
            self._diagnostics.begin("command_timeout", WARN, f"no duty for {timeout:g} s: duty 0", TASK)
        else:
            self._diagnostics.end("command_timeout")

    def _look(self) -> None:
        self._several("duty", "second_controller", WARN)
        self._several("hall_voltage", "second_plant", ERROR)

    def _several(self, topic: str, condition: str, level: bytes) -> None:
        if self._node.count_publishers(topic) > 1:
            names = listed(list(publishers_of(self._node, topic).values()))
            self._diagnostics.begin(condition, level, f"more than one publishes {topic}: {names}", TASK)
        else:
            self._diagnostics.end(condition)

    def _values(self) -> dict[str, object]:
        now = time.monotonic()
        return {
            **self._received.values(now, "duty"),
            "refused_count": self._refused,
            "clipped_count": self._clipped,
        }
