"""Which topic of a recording gives which signal: by last name under any namespace, or as a person chose it."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.errors import InputError, near
from pierburg_ros.recording.decoding import numbers
from pierburg_ros.recording.formats.cdr import CLOCK, JOINT_STATE
from pierburg_ros.recording.formats.messages import Bag, Messages
from pierburg_ros.recording.signal_map import SignalMap, Source
from pierburg_ros.recording.signals import OPTIONAL, SIGNALS, last_name

PLAIN = {
    f"std_msgs/msg/{kind}"
    for kind in ("Float32", "Float64", "Int8", "Int16", "Int32", "Int64", "UInt8", "UInt16", "UInt32", "UInt64")
}
"""Types of one number, any of which a topic that is called like a signal may have."""
TICKS = "clock"
"""Last name of the topic of simulated time."""


@dataclass(frozen=True)
class Found:
    """The messages that give a signal, its value [SI] in each, and where that comes from."""

    signal: str
    messages: Messages
    values: Signal
    source: Source


def nothing(source: Source, signal: str, found: str) -> InputError:
    """What to say where a person chose a source for a `signal` that may be absent, and nothing is there."""
    place = "" if source.origin == "--topic" else f"{source.origin}: "
    return InputError(f"{place}{found}, expected values of {signal}. Leave it out, in a signal map as {signal}: null.")


def namespace(topic: str) -> str:
    """`/bench/hall_voltage` -> `/bench`."""
    return topic.rpartition("/")[0]


@dataclass(frozen=True)
class Topics:
    """Finds the messages of a signal among the topics of `bag`; `chosen` are the sources that a person named."""

    bag: Bag
    chosen: SignalMap = field(default_factory=SignalMap)

    def find(self, signal: str) -> Found | None:
        """The messages of `signal` and its values, or None where there are none."""
        source, topic = self.chosen.sources.get(signal), self.topic_of(signal)
        if topic is None or not self.bag.data[topic]:
            if source is not None and signal in OPTIONAL:
                raise nothing(source, signal, f"{self.bag.name} has no messages on {topic}")
            return None
        messages = self.bag.messages(topic)
        if source is None:
            self.check_type(signal, messages)
        source = source or Source("topic", topic, origin=self.bag.name)
        origin = self.bag.name if source.origin in (self.bag.name, "--topic") else source.origin
        usual = source.path is None and (messages.type != JOINT_STATE or signal == "position")
        read = numbers(messages, source.path, origin, usual=usual)
        return Found(
            signal,
            messages.select(read.kept),
            source.values(read.raw.astype(np.float64)),
            replace(source, kind="topic"),
        )

    def check_type(self, signal: str, messages: Messages) -> None:
        """Refuse a topic that is called like the signal and is something else than one number."""
        expected = SIGNALS[signal].topics[last_name(messages.topic)]
        if messages.type != expected and (messages.type not in PLAIN or expected == JOINT_STATE):
            raise InputError(
                f"{self.bag.name}: {messages.topic} is a {messages.type}, expected {expected}."
                f" Name another with --topic {signal}=/your/topic."
            )

    def topic_of(self, signal: str) -> str | None:
        """The topic of `signal`, chosen or called like it, with messages or without."""
        source = self.chosen.sources.get(signal)
        if source is not None:
            return self.chosen_topic(source, signal)
        return None if signal in self.chosen.left_out else self.own_topic(signal)

    def own_topic(self, signal: str) -> str | None:
        """The topic with messages that is called like the signal; of several names the first that is there."""
        for name in SIGNALS[signal].topics:
            topic = self.called(name, signal)
            if topic is not None:
                return topic
        return None

    def called(self, name: str, signal: str) -> str | None:
        """The topic with messages and this last name."""
        candidates = self.all_called(name)
        if len(candidates) > 1:
            raise InputError(
                f"{self.bag.name} has {len(candidates)} topics for {name} ({', '.join(sorted(candidates))}),"
                f" expected one. Choose with --topic {signal}={sorted(candidates)[0]}."
            )
        return candidates[0] if candidates else None

    def all_called(self, name: str) -> list[str]:
        """The topics with this last name: those with messages, and in a namespace that a person chose, if any are."""
        candidates = [topic for topic in self.bag.types if last_name(topic) == name]
        candidates = [topic for topic in candidates if self.bag.data[topic]] or candidates[:1]
        namespaces = {namespace(source.name) for source in self.chosen.sources.values()}
        return [topic for topic in candidates if namespace(topic) in namespaces] or candidates

    def chosen_topic(self, source: Source, signal: str) -> str:
        """The topic that a person named for `signal`."""
        if source.kind == "column":
            raise InputError(
                f"{source.origin} names a column, {self.bag.name} has topics (found: {self.listed()})."
                " Write topic: in place of column:."
            )
        return self.named(source.name, signal, source.origin)

    def named(self, topic: str, signal: str, origin: str) -> str:
        """`topic`, which a person named, if it is there."""
        if topic not in self.bag.types:
            place = "" if origin == "--topic" else f"{origin}: "
            raise InputError(
                f"{place}{self.bag.name} has no topic {topic} for {signal} (found: {self.listed()})."
                f"{near(topic, self.bag.types)} Name one of those."
            )
        return topic

    def stamped(self) -> Messages | None:
        """The messages whose stamps others may share: those that a map names, or else joint states."""
        time = self.chosen.time
        if time is not None:
            if time.columns:
                raise InputError(
                    f"{time.origin} names the column {time.columns[0]}, {self.bag.name} has topics. Write"
                    " time: {topic: /name, field: header.stamp}, or choose with --time {stamp,clock,publish,log}."
                )
            return self.bag.messages(self.named(time.topic, "time", time.origin))
        source = self.chosen.sources.get("position")
        if self.chosen.sources and not source and len(self.all_called("joint_states")) > 1:
            return None  # joints of others, beside signals that a person chose
        topic = self.chosen_topic(source, "position") if source else self.called("joint_states", "position")
        is_joint = topic is not None and self.bag.data[topic] and self.bag.types[topic] == JOINT_STATE
        return self.bag.messages(topic) if topic is not None and is_joint else None

    def ticks(self) -> Messages | None:
        """The messages of simulated time."""
        topic = self.called(TICKS, TICKS)
        if topic is None or not self.bag.data[topic]:
            return None
        if self.bag.types[topic] != CLOCK:
            raise InputError(f"{self.bag.name}: {topic} is a {self.bag.types[topic]}, expected {CLOCK}. Rename it.")
        return self.bag.messages(topic)

    def listed(self) -> str:
        """Every topic of the recording, for a message to a person."""
        return ", ".join(sorted(self.bag.types)) or "no topics"
