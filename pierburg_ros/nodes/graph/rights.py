"""What a running node has on the graph: its topics, services and clients, for a policy that allows just these."""

from __future__ import annotations

import time
from collections.abc import Sequence

from rclpy.node import Node
from rclpy.node import NodeNameNonExistentError as Missing

from pierburg_ros.nodes.core.policy import Rights, named

COMPLETE = "set_parameter"
"""Last topic that every node of this package subscribes: with it the node is whole."""
RIGHTS_SETTLED = 3.0
"""Time for which nothing may be added before the rights count [s]: a whole controller looks at the graph for 1 s before
it has a publisher, and on a busy machine discovery takes another second."""
DEADLINE = 600.0
"""Longest wait for a node [s], which may have to compile its simulator first."""


def rights_of(observers: Sequence[Node], name: str) -> list[Rights]:
    """Rights that a node `name` uses on the graph of each observer; TimeoutError where one does not come up."""
    end = time.monotonic() + DEADLINE
    seen, since = [Rights()], time.monotonic()
    while time.monotonic() < end:
        time.sleep(0.1)
        now = [_present(observer, name) for observer in observers]
        if now != seen:
            seen, since = now, time.monotonic()
        is_whole = all(f"~/{COMPLETE}" in each.subscribe for each in seen)
        if is_whole and time.monotonic() - since > RIGHTS_SETTLED:
            return seen
    raise TimeoutError(f"{name} was not whole on the graph within {DEADLINE:g} s: {seen}")


def _present(observer: Node, name: str) -> Rights:
    try:
        found = (
            observer.get_publisher_names_and_types_by_node(name, "/"),
            observer.get_subscriber_names_and_types_by_node(name, "/"),
            observer.get_service_names_and_types_by_node(name, "/"),
            observer.get_client_names_and_types_by_node(name, "/"),
        )
    except Missing:
        return Rights()
    return Rights(*(named((topic for topic, _ in entries), name) for entries in found))
