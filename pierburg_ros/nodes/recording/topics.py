"""Subscriptions of the recorder: raw, of any installed type, with the quality of service on offer."""

from __future__ import annotations

import time
from collections.abc import Iterable
from dataclasses import dataclass
from threading import Lock

from rclpy.callback_groups import CallbackGroup
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.subscription import Subscription

from pierburg_ros.errors import InputError
from pierburg_ros.nodes.core.numbering import Numbering
from pierburg_ros.nodes.core.recorder_parameters import BOOL, DEFAULT_TOPICS
from pierburg_ros.nodes.core.steady_senders import SteadySenders
from pierburg_ros.nodes.graph.publishers import publishers_of
from pierburg_ros.nodes.graph.qos import RECORDED, described
from pierburg_ros.nodes.graph.taken import Taken, Taker
from pierburg_ros.nodes.recording.definitions import message_class, type_hash
from pierburg_ros.nodes.recording.file import Topic


@dataclass(frozen=True)
class Received:
    """A message as it came: how many are missing before it, and when it was sent, received and taken [ns]."""

    topic: Topic
    data: bytes
    missing: int
    sent: int
    arrived: int
    taken: int


class ServedElsewhere(CallbackGroup):
    """Keeps subscriptions out of the executor's hands, for a thread that takes from them itself."""

    def can_execute(self, entity: object) -> bool:
        """Never."""
        return False

    def beginning_execution(self, entity: object) -> bool:
        """Never."""
        return False

    def ending_execution(self, entity: object) -> None:
        """Nothing was begun."""


class RecordedTopics:
    """Keeps every wanted topic subscribed and gives what has come, with the gaps in each publisher's numbering.

    `take` may be called from one thread while another one looks at the graph.
    """

    def __init__(self, node: Node, names: Iterable[str]) -> None:
        self._numbering = Numbering()
        self._senders = SteadySenders()
        self._taker = Taker()
        self._node = node
        self._kinds = {node.resolve_topic_name(name): DEFAULT_TOPICS.get(name) for name in names}
        self._group = ServedElsewhere()
        self._lock = Lock()
        self._subscriptions: dict[str, Subscription] = {}
        self._topics: dict[str, Topic] = {}
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
                is_wanted = known in (None, BOOL)  # A state holds on; the past of the log belongs to other runs.
                self._subscribe(name, kinds[0], profile_for(offers, keeps_history=is_wanted))

    def take(self) -> list[Received]:
        """All that has arrived, topic by topic."""
        with self._lock:
            return [
                self._received(name, taken)
                for name, subscription in self._subscriptions.items()
                for taken in self._taker.taken(subscription)
            ]

    def behind(self, time: int) -> list[str]:
        """Topics of which more is on the way: a steady publisher's, of whom nothing sent after `time` [ns] has come."""
        present = {name: publishers_of(self._node, name) for name in self._subscriptions}
        with self._lock:
            return [name for name, ids in present.items() if self._senders.behind(set(map(bytes.fromhex, ids)), time)]

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
        made = self._node.create_subscription(
            message, name, lambda _: None, profile, raw=True, callback_group=self._group
        )
        with self._lock:
            self._subscriptions[name] = made
            self._topics.setdefault(name, Topic(name, kind))
        if current is not None:
            self._node.destroy_subscription(current)

    def _received(self, name: str, taken: Taken) -> Received:
        if not self._topics[name].qos:
            self._topics[name] = self._described(name)
        missing = self._numbering.take(taken.publisher, taken.number)
        self._senders.take(taken.publisher, taken.sent)
        return Received(self._topics[name], taken.data, missing, taken.sent, taken.arrived, time.time_ns())

    def _described(self, name: str) -> Topic:
        offers = self._node.get_publishers_info_by_topic(name)
        return Topic(name, self._topics[name].kind, tuple(described(info.qos_profile) for info in offers))


def profile_for(offers: list[QoSProfile], keeps_history: bool) -> QoSProfile:
    """What the publishers can serve: delivery if one promises it, the past if all keep it."""
    reliable = any(offer.reliability == ReliabilityPolicy.RELIABLE for offer in offers)
    latched = keeps_history and all(o.durability == DurabilityPolicy.TRANSIENT_LOCAL for o in offers)
    return QoSProfile(
        depth=RECORDED.depth,
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE,
    )
