"""What a node has to say about itself on `/diagnostics` (REP 107), and in the log when it changes."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from threading import RLock

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rclpy.clock import Clock, ClockType
from rclpy.node import Node

from pierburg_ros.nodes.core.health import SHORTEST_REPORT, Condition, Health, Status

OK = DiagnosticStatus.OK
WARN = DiagnosticStatus.WARN
ERROR = DiagnosticStatus.ERROR

LOGGED = 1.0
"""Shortest time between two log lines about one thing [s]."""

Values = Callable[[], Mapping[str, object]]


class Diagnostics:
    """One status for each task of a node, once a second and when something changes.

    The first task is the node itself and bears its name alone; `task` adds others. Any thread may call.
    """

    def __init__(self, node: Node, counters: Values) -> None:
        self.hardware_id = node.get_name()
        """What the node is about; nodes that know an actuator name it here."""
        self._node = node
        self._health = Health()
        self._lock = RLock()
        self._logged: dict[str, float] = {}
        self._tasks: dict[str, tuple[str, Values]] = {"": ("running", counters)}
        self._publisher = node.create_publisher(DiagnosticArray, "/diagnostics", 10)
        node.create_timer(SHORTEST_REPORT, self._look, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def task(self, name: str, well: str, values: Values) -> None:
        """Add a task with the message for when it is well and what its status counts."""
        self._tasks[name] = (well, values)

    def begin(self, condition: str, level: bytes, text: str, task: str = "") -> None:
        """The node is in a `condition` that lasts; logged when it begins, told with its newest text."""
        with self._lock:
            is_new = self._health.begin(condition, Condition(task, level, text))
        if is_new:
            self._log(condition, level, text)
            self._look()

    def end(self, condition: str) -> None:
        """A lasting condition is over."""
        with self._lock:
            was_in_force = self._health.end(condition)
        if was_in_force:
            self._log(f"{condition}: over", OK, f"{condition}: over")
            self._look()

    def refuse(self, reason: str) -> None:
        """Something was asked of the node that it did not do."""
        with self._lock:
            self._health.refuse(reason, time.monotonic())
        self._log(reason, WARN, reason)
        self._look()

    def report(self) -> None:
        """Publish the status of every task."""
        with self._lock:
            wells = {name: well for name, (well, _) in self._tasks.items()}
            told = self._health.report(wells, time.monotonic())
        message = DiagnosticArray(status=[self._status(each) for each in told])
        message.header.stamp = self._node.get_clock().now().to_msg()
        self._publisher.publish(message)

    def _look(self) -> None:
        with self._lock:
            is_due = self._health.is_due(time.monotonic())
        if is_due:
            self.report()

    def _log(self, subject: str, level: bytes, text: str) -> None:
        """One line, unless the last one about the same subject was a moment ago."""
        now = time.monotonic()
        if now - self._logged.get(subject, -LOGGED) < LOGGED:
            return
        self._logged = {name: at for name, at in self._logged.items() if now - at < LOGGED} | {subject: now}
        log = self._node.get_logger()
        if level == ERROR:  # a line of code for each level: the logger refuses several from one
            log.error(text)
        elif level == WARN:
            log.warning(text)
        else:
            log.info(text)

    def _status(self, status: Status) -> DiagnosticStatus:
        own = self._node.get_fully_qualified_name().lstrip("/")
        values = dict(self._tasks[status.task][1]())
        if not status.task:
            values["last_refusal"] = self._health.refusal
        return DiagnosticStatus(
            level=status.level,
            name=f"{own}: {status.task}" if status.task else own,
            message=status.message,
            hardware_id=self.hardware_id,
            values=[KeyValue(key=key, value=str(value)) for key, value in values.items()],
        )
