"""What a node has to say about itself on `/diagnostics`, and in the log when it changes."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rclpy.clock import Clock, ClockType
from rclpy.node import Node

PERIOD = 1.0
"""Time between two reports [s]; a change is reported at once."""
SHOWN = 10.0
"""Time for which a refusal stays in the reports [s]."""

WARN = DiagnosticStatus.WARN
ERROR = DiagnosticStatus.ERROR


class Diagnostics:
    """The conditions a node is in, its counters, and the last thing it refused."""

    def __init__(self, node: Node, counters: Callable[[], Mapping[str, object]]) -> None:
        self._node = node
        self._counters = counters
        self._conditions: dict[str, tuple[bytes, str]] = {}
        self._refusal = ""
        self._refused_at = -SHOWN
        self._publisher = node.create_publisher(DiagnosticArray, "/diagnostics", 10)
        node.create_timer(PERIOD, self.report, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def begin(self, condition: str, level: bytes, text: str) -> None:
        """The node is in a `condition` that lasts; logged and reported when it begins."""
        if condition not in self._conditions:
            self._conditions[condition] = (level, text)
            self._log(level, text)
            self.report()

    def end(self, condition: str) -> None:
        """A lasting condition is over."""
        if self._conditions.pop(condition, None) is not None:
            self._node.get_logger().info(f"{condition}: over")
            self.report()

    def refuse(self, reason: str) -> None:
        """Something was asked of the node that it did not do."""
        self._refusal, self._refused_at = reason, time.monotonic()
        self._log(WARN, reason)
        self.report()

    def report(self) -> None:
        """Publish the conditions in force, a recent refusal and the counters."""
        findings = list(self._conditions.values())
        if time.monotonic() - self._refused_at < SHOWN:
            findings.append((WARN, self._refusal))
        self._publish(findings)

    def _log(self, level: bytes, text: str) -> None:
        log = self._node.get_logger()
        if level == ERROR:
            log.error(text)
        else:
            log.warning(text)

    def _publish(self, findings: list[tuple[bytes, str]]) -> None:
        status = DiagnosticStatus(
            level=max((level for level, _ in findings), default=DiagnosticStatus.OK),
            name=self._node.get_fully_qualified_name().lstrip("/"),
            message="; ".join(text for _, text in findings) or "running",
        )
        values = {**self._counters(), "last_refusal": self._refusal}
        status.values = [KeyValue(key=key, value=str(value)) for key, value in values.items()]
        message = DiagnosticArray(status=[status])
        message.header.stamp = self._node.get_clock().now().to_msg()
        self._publisher.publish(message)
