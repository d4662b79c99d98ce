"""Reading a signal from whoever sends it: with delivery promised where the sender promises it."""

from __future__ import annotations

from collections.abc import Callable

from rclpy.event_handler import QoSRequestedIncompatibleQoSInfo, SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.qos import QoSPolicyKind, QoSProfile, ReliabilityPolicy
from rclpy.subscription import Subscription

from pierburg_ros.nodes.graph.qos import SIGNALS


class Signal:
    """A subscription that asks for delivery, until a publisher appears that promises none.

    DDS connects a reader that wants delivery with no writer that sends as best it can, while one that asks for
    nothing is connected with both. So the weaker reader comes in the place of the stronger one when it is needed,
    and not before: messages of our own publishers are sent again until they arrive.
    """

    def __init__(self, node: Node, kind: type, topic: str, callback: Callable[..., None]) -> None:
        self._node = node
        self._kind = kind
        self._topic = topic
        self._callback = callback
        self._subscription = self._subscribed(SIGNALS)

    @property
    def publishers(self) -> int:
        """How many publishers there are."""
        return int(self._subscription.get_publisher_count())

    def _subscribed(self, profile: QoSProfile) -> Subscription:
        events = SubscriptionEventCallbacks(incompatible_qos=self._on_incompatible)
        return self._node.create_subscription(self._kind, self._topic, self._callback, profile, event_callbacks=events)

    def _on_incompatible(self, event: QoSRequestedIncompatibleQoSInfo) -> None:
        topic = self._subscription.topic_name
        current = self._subscription.qos_profile
        is_weak = current.reliability == ReliabilityPolicy.BEST_EFFORT
        if is_weak or event.last_policy_kind != QoSPolicyKind.RELIABILITY:
            self._node.get_logger().warning(f"{topic}: a publisher cannot serve the quality of service asked for")
            return
        self._node.get_logger().info(f"{topic}: a publisher sends as best it can, and so it is read")
        stronger = self._subscription
        weaker = QoSProfile(depth=current.depth, reliability=ReliabilityPolicy.BEST_EFFORT)
        self._subscription = self._subscribed(weaker)
        self._node.destroy_subscription(stronger)
