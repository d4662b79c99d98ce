"""Quality of service of the topics in section 2 of docs/contract.md."""

from rclpy.qos import QoSProfile, ReliabilityPolicy

SIGNALS = QoSProfile(depth=10, reliability=ReliabilityPolicy.RELIABLE)
"""Reading signals at the sample rate: a late reader wants the newest ones, not the past."""

PUBLISHED = QoSProfile(depth=1000, reliability=ReliabilityPolicy.RELIABLE)
"""Publishing them: kept for a recorder that a busy machine holds up for two seconds at 500 Hz."""

COMMANDS = QoSProfile(depth=10, reliability=ReliabilityPolicy.RELIABLE)
"""Setpoints and parameters sent by a person or a script."""

RECORDED = QoSProfile(depth=1000, reliability=ReliabilityPolicy.RELIABLE)
"""The recorder's reading, which wants all of them."""

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
