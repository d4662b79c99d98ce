"""Topics read in batches: at 500 Hz a callback a message takes ten times the processor of taking many at once."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from rclpy.callback_groups import CallbackGroup
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy

DRAINED = QoSProfile(depth=5000, reliability=ReliabilityPolicy.BEST_EFFORT)
"""Ten seconds at 500 Hz between two looks; best effort matches every publisher."""


class Unserved(CallbackGroup):
    """Entities that the executor leaves alone: neither does it wait for them, nor does a message wake it."""

    def can_execute(self, entity: Any) -> bool:
        """Never."""
        return False

    def beginning_execution(self, entity: Any) -> bool:
        """Never."""
        return False

    def ending_execution(self, entity: Any) -> None:
        """Nothing was begun."""


class Drained:
    """A subscription whose messages are taken by a caller, when it likes."""

    def __init__(self, node: Node, kind: type, topic: str, group: Unserved) -> None:
        self._kind = kind
        self._subscription = node.create_subscription(kind, topic, lambda _: None, DRAINED, callback_group=group)

    def taken(self) -> Iterator[tuple[Any, dict[str, int]]]:
        """Messages that have come since the last call, with what the middleware knows of them."""
        while received := self._subscription.handle.take_message(self._kind, False):
            yield received
