"""Two plants on one graph: both say so, and so does the controller that would listen to both, until one is gone."""

import signal

import pytest

pytest.importorskip("rclpy")

from diagnostic_msgs.msg import DiagnosticArray

pytestmark = pytest.mark.ros
TEXT = "more than one publishes hall_voltage: /first, /second"


def test_two_plants_are_noticed_and_named_until_one_ends(graph):
    diagnostics = graph.watch("/diagnostics", DiagnosticArray)

    def newest():
        """The newest status of the task on duties, by node."""
        return {each.name: each for message in diagnostics for each in message.status if each.name.endswith(": duty")}

    graph.start("plant", arguments=("-r", "__node:=first"))
    second = graph.start("plant", arguments=("-r", "__node:=second"))
    graph.start("controller")

    def is_named_by(*nodes):
        told = newest()
        return all(f"{node}: duty" in told and TEXT in told[f"{node}: duty"].message for node in nodes)

    graph.until(lambda: is_named_by("first", "second", "controller"), "all three to name both plants")
    assert {newest()[f"{node}: duty"].level for node in ("first", "second", "controller")} == {b"\x02"}
    graph.ended(second, signal.SIGTERM)
    graph.until(lambda: not (is_named_by("first") or is_named_by("controller")), "the plant that is left to be alone")
    assert graph.node.count_publishers("hall_voltage") == 1
