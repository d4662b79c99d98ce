"""Which topic of a recording plays which role: by last name under any namespace, or as a person names it."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field

from pierburg_ros.errors import InputError
from pierburg_ros.recording.formats.cdr import BOOL, CLOCK, FLOAT64, JOINT_STATE
from pierburg_ros.recording.formats.messages import Bag, Messages

ROLES = {
    "duty": FLOAT64,
    "applied_duty": FLOAT64,
    "current": FLOAT64,
    "torque": FLOAT64,
    "hall_voltage": FLOAT64,
    "joint_states": JOINT_STATE,
    "position": FLOAT64,
    "speed": FLOAT64,
    "supply_voltage": FLOAT64,
    "temperature": FLOAT64,
    "enabled": BOOL,
    "setpoints": FLOAT64,
    "clock": CLOCK,
}
"""Type of the topic of each role; a recording is read through these and nothing else."""
MEASURED = {"hall_voltage": "hall_voltage", "joint_states": "position", "position": "position", "speed": "speed"}
"""Quantity that a role measures; where a recording holds several, the first is taken."""
DRIVING = {"applied_duty": "duty", "duty": "duty", "current": "current", "torque": "torque"}
"""Input that a role gives, likewise: what the plant says it applied comes before what was asked for."""


def in_order(roles: Mapping[str, str], named: Collection[str], preferred: Collection[str]) -> list[str]:
    """`roles`, first those that a person named, then those that are `preferred`, then as they stand."""
    return sorted(roles, key=lambda role: (role not in named, roles[role] not in preferred))


def last_name(topic: str) -> str:
    """`/bench/hall_voltage` -> `hall_voltage`."""
    return topic.rsplit("/", 1)[-1]


def namespace(topic: str) -> str:
    """`/bench/hall_voltage` -> `/bench`."""
    return topic.rpartition("/")[0]


def check_names(named: Mapping[str, str], known: Mapping[str, str]) -> None:
    """Refuse a name given for a role that does not exist."""
    unknown = sorted(set(named) - set(known))
    if unknown:
        raise InputError(
            f"--topic found the unknown signal {', '.join(unknown)}, expected one of {', '.join(known)}."
            " Write --topic duty=/bench/pwm."
        )


@dataclass(frozen=True)
class Topics:
    """Finds the messages of a role among the topics of `bag`; `named` maps roles to topics that a person chose."""

    bag: Bag
    named: Mapping[str, str] = field(default_factory=dict)

    def find(self, role: str) -> Messages | None:
        """The messages of `role`, or None where there are none."""
        topic = self.topic(role)
        if topic is None or not self.bag.data[topic]:
            return None
        if self.bag.types[topic] != ROLES[role]:
            raise InputError(
                f"{self.bag.name}: {topic} is a {self.bag.types[topic]}, expected {ROLES[role]}."
                f" Name another with --topic {role}=/your/topic."
            )
        if self.bag.encodings[topic] != "cdr":
            raise InputError(
                f"{self.bag.name}: {topic} is encoded as {self.bag.encodings[topic]!r}, expected 'cdr'."
                " Convert it with a ROS 2 bag tool."
            )
        return self.bag.messages(topic)

    def topic(self, role: str) -> str | None:
        """The topic of `role`: the named one, else the one with messages and that last name."""
        if role in self.named:
            return self.named_topic(role)
        candidates = [topic for topic in self.bag.types if last_name(topic) == role]
        candidates = [topic for topic in candidates if self.bag.data[topic]] or candidates[:1]
        chosen = {namespace(topic) for topic in self.named.values()}
        if len(candidates) > 1:
            candidates = [topic for topic in candidates if namespace(topic) in chosen] or candidates
        if len(candidates) > 1:
            raise InputError(
                f"{self.bag.name} has {len(candidates)} topics for {role} ({', '.join(sorted(candidates))}),"
                f" expected one. Choose with --topic {role}={sorted(candidates)[0]}."
            )
        return candidates[0] if candidates else None

    def named_topic(self, role: str) -> str:
        """The topic that a person named for `role`."""
        topic = self.named[role]
        if topic not in self.bag.types:
            raise InputError(
                f"{self.bag.name} has no topic {topic} for {role} (found: {self.listed()}). Name one of those."
            )
        return topic

    def listed(self) -> str:
        """Every topic of the recording, for a message to a person."""
        return ", ".join(sorted(self.bag.types)) or "no topics"
