"""Who else publishes a topic, as the graph knows it."""

from __future__ import annotations

from rclpy.node import Node


def publishers_of(node: Node, topic: str) -> dict[str, str]:
    """Full names of the nodes that publish `topic`, by the id of the publisher."""
    found = node.get_publishers_info_by_topic(node.resolve_topic_name(topic))
    return {bytes(each.endpoint_gid).hex(): f"{each.node_namespace.rstrip('/')}/{each.node_name}" for each in found}


def listed(names: list[str]) -> str:
    """Names for a text, sorted, each with how often it occurs if more than once."""
    return ", ".join(
        name if names.count(name) == 1 else f"{names.count(name)} times {name}" for name in sorted(set(names))
    )
