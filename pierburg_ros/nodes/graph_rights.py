"""What a running node has on the graph: its topics, services and clients, for a policy that allows just these."""

from __future__ import annotations

import time

from rclpy.node import Node
from rclpy.node import NodeNameNonExistentError as Missing

from pierburg_ros.nodes.core.policy import Rights, named

COMPLETE = "set_parameter"
"""Last topic that every node of this package subscribes: with it the node is whole."""
SETTLED = 1.0
"""Time for which nothing may be added before the rights count [s]: discovery of one node takes a tenth of it."""
DEADLINE = 600.0
"""Longest wait for a node [s], which may have to compile its simulator first."""


def rights_of(observer: Node, name: str) -> Rights:
    """Rights that the node `name` uses; TimeoutError where it does not come up."""
    end = time.monotonic() + DEADLINE
    seen, since = Rights(), time.monotonic()
    while time.monotonic() < end:
        time.sleep(0.1)
        now = _present(observer, name)
        if now != seen:
            seen, since = now, time.monotonic()
        if f"~/{COMPLETE}" in seen.subscribe and time.monotonic() - since > SETTLED:
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
