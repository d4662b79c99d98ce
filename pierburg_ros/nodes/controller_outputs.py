"""The publishers of an active controller; a passive one has none, so that the graph shows who steers."""

from __future__ import annotations

from rclpy.node import Node
from std_msgs.msg import Bool, Float64

from pierburg_ros.control import Internals
from pierburg_ros.nodes.graph import messages
from pierburg_ros.nodes.graph.publishers import publishers_of
from pierburg_ros.nodes.graph.qos import PUBLISHED

INTERNALS = {"error": Float64, "pi_output": Float64, "derivative": Float64, "saturated": Bool}
"""What `publish_internals` publishes: the internals of the control law and their message types."""
TOPICS = ("duty", "active_setpoint", *(f"~/{name}" for name in INTERNALS))
"""What is published while the controller is active."""


class Outputs:
    """Duty, setpoint in force and internals, on the graph from `open` to `close`."""

    def __init__(self, node: Node) -> None:
        self._node = node
        before = publishers_of(node, "duty")
        self._duty = node.create_publisher(Float64, "duty", PUBLISHED)
        self.own = next(iter(sorted(set(publishers_of(node, "duty")) - set(before))), "")
        """Id of the duty's publisher: its creator sees it at once, all others by discovery."""
        self._setpoint = node.create_publisher(Float64, "active_setpoint", PUBLISHED)
        self._internals = {
            name: node.create_publisher(kind, f"~/{name}", PUBLISHED) for name, kind in INTERNALS.items()
        }

    def close(self) -> None:
        """Leave the valve to its spring and the graph to others."""
        self.duty(0.0)
        for publisher in (self._duty, self._setpoint, *self._internals.values()):
            self._node.destroy_publisher(publisher)

    def duty(self, duty: float) -> None:
        """Publish a duty [1]."""
        self._duty.publish(messages.number(duty))

    def setpoint(self, setpoint: float) -> None:
        """Publish the setpoint in force [rad]."""
        self._setpoint.publish(messages.number(setpoint))

    def internals(self, internals: Internals) -> None:
        """Publish what the control law works with."""
        for name, publisher in self._internals.items():
            publisher.publish(INTERNALS[name](data=getattr(internals, name)))
