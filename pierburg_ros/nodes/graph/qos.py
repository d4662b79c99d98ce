"""Quality of service of the topics in section 2 of docs/contract.md."""

from typing import Any

from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.qos_overriding_options import QoSOverridingOptions

from pierburg_ros.nodes.core.depth import KEPT_MESSAGES

SIGNALS = QoSProfile(depth=10, reliability=ReliabilityPolicy.RELIABLE)
"""Reading signals at the sample rate: a late reader wants the newest ones, not the past."""

PUBLISHED = QoSProfile(depth=KEPT_MESSAGES, reliability=ReliabilityPolicy.RELIABLE)
"""Publishing them, in full: a node with a parameter `depth` keeps so many, see `LiveNode.kept`."""

STATE = QoSProfile(depth=1, reliability=ReliabilityPolicy.RELIABLE, durability=DurabilityPolicy.TRANSIENT_LOCAL)
"""What is said only when it changes: a reader that comes later gets the last one."""

COMMANDS = QoSProfile(depth=10, reliability=ReliabilityPolicy.RELIABLE)
"""Setpoints and parameters sent by a person or a script."""

RECORDED = QoSProfile(depth=KEPT_MESSAGES, reliability=ReliabilityPolicy.RELIABLE)
"""The recorder's reading, which wants all of them."""

PROGRESS = QoSProfile(depth=10, reliability=ReliabilityPolicy.RELIABLE, durability=DurabilityPolicy.TRANSIENT_LOCAL)
"""How far a recorder is, for a plant that may start after it."""

OVERRIDABLE = (SIGNALS, PUBLISHED, COMMANDS)
"""Profiles that a person may change, topic by topic, with the parameters `qos_overrides`."""

_FOREVER = {"sec": 9223372036, "nsec": 854775807}


def described(profile: QoSProfile) -> dict[str, object]:
    """A profile as rosbag2 writes it into a recording, time limits left open."""
    return {
        "history": profile.history.name.lower(),
        "depth": profile.depth,
        "reliability": profile.reliability.name.lower(),
        "durability": profile.durability.name.lower(),
        "deadline": dict(_FOREVER),
        "lifespan": dict(_FOREVER),
        "liveliness": "automatic",
        "liveliness_lease_duration": dict(_FOREVER),
        "avoid_ros_namespace_conventions": False,
    }


def overridable(profile: object, options: dict[str, Any]) -> dict[str, Any]:
    """The options of a publisher or subscription, with leave to override its profile if it is one of ours."""
    if profile not in OVERRIDABLE:
        return options
    return {"qos_overriding_options": QoSOverridingOptions.with_default_policies(), **options}
