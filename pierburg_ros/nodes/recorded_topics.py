"""Subscriptions of the recorder: raw, of any installed type, with the quality of service on offer."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.subscription import Subscription

from pierburg_ros.errors import InputError
from pierburg_ros.nodes.core.recorder_parameters import DEFAULT_TOPICS
from pierburg_ros.nodes.definitions import message_class, type_hash
from pierburg_ros.nodes.qos import RECORDED, described
from pierburg_ros.nodes.recording_file import Topic


@dataclass(frozen=True)
class Received:
    """A message as it came: its number among its publisher's, and when it was sent and received [ns]."""

    topic: Topic
    data: bytes
    sequence: int
    sent: int
    arrived: int


class RecordedTopics:
    """Keeps every wanted topic subscribed and hands over what comes, counting gaps in the numbering."""

    def __init__(self, node: Node, names: Iterable[str], take: Callable[[Received], None]) -> None:
        self.lost: Counter[str] = Counter()
        self._node = node
        self._take = take
        self._kinds = {node.resolve_topic_name(name): DEFAULT_TOPICS.get(name) for name in names}
        self._subscriptions: dict[str, Subscription] = {}
        self._topics: dict[str, Topic] = {}
        self._last: dict[str, int] = {}
        for name, kind in self._kinds.items():
            if kind is not None:
                self._subscribe(name, kind, RECORDED)

    def look(self) -> None:
        """Subscribe what has appeared, and weaken subscriptions that their publishers cannot serve."""
        present = dict(self._node.get_topic_names_and_types())
        for name, known in list(self._kinds.items()):
            kinds = [known] if known else present.get(name, [])
            offers = [info.qos_profile for info in self._node.get_publishers_info_by_topic(name)]
            if kinds and offers:
                self._subscribe(name, kinds[0], profile_for(offers, keeps_history=known is None))

    def drain(self) -> None:
        """Take everything that has arrived and was not served yet."""
        for subscription in self._subscriptions.values():
            while taken := subscription.handle.take_message(subscription.msg_type, True):
                subscription.callback(*taken)

    def _subscribe(self, name: str, kind: str, profile: QoSProfile) -> None:
        current = self._subscriptions.get(name)
        if current is not None and current.qos_profile == profile:
            return
        try:
            message = message_class(kind)
            type_hash(kind)
        except InputError as error:
            self._node.diagnostics.refuse(f"{name} is not recorded: {error}")
            del self._kinds[name]
            return
        if current is not None:
            self._node.destroy_subscription(current)
        self._subscriptions[name] = self._node.create_subscription(
            message, name, lambda data, info: self._on_message(name, kind, data, info), profile, raw=True
        )

    def _on_message(self, name: str, kind: str, data: bytes, info: dict[str, int]) -> None:
        if name not in self._topics:
            self._topics[name] = self._described(name, kind)
        sequence = info["publication_sequence_number"]
        self._count_gap(name, sequence)
        sent, arrived = info["source_timestamp"], info["received_timestamp"]
        self._take(Received(self._topics[name], data, sequence, sent, arrived))

    def _count_gap(self, name: str, sequence: int) -> None:
        gap = sequence - self._last.get(name, sequence) - 1
        self._last[name] = sequence
        if gap > 0 and self._subscriptions[name].get_publisher_count() == 1:
            self.lost[name] += gap

    def _described(self, name: str, kind: str) -> Topic:
        offers = self._node.get_publishers_info_by_topic(name)
        return Topic(name, kind, tuple(described(info.qos_profile) for info in offers))


def profile_for(offers: list[QoSProfile], keeps_history: bool) -> QoSProfile:
    """What the publishers can serve: delivery if one promises it, the past if all keep it."""
    reliable = any(offer.reliability == ReliabilityPolicy.RELIABLE for offer in offers)
    latched = keeps_history and all(o.durability == DurabilityPolicy.TRANSIENT_LOCAL for o in offers)
    return QoSProfile(
        depth=RECORDED.depth,
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE,
    )
