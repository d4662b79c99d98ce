"""The way in from ros2_control over DDS, the test in the place of its hardware component for topics."""

import math

import pytest

pytest.importorskip("rclpy")

from diagnostic_msgs.msg import DiagnosticArray
from rclpy.qos import QoSProfile, qos_profile_sensor_data
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64

pytestmark = pytest.mark.ros


class Hardware:
    """What a hardware component for topics has: one publisher of depth 1 and one subscription as for sensors."""

    def __init__(self, graph):
        self.graph = graph
        self.states = graph.watch("joint_states", JointState, qos_profile_sensor_data)
        self.publisher = graph.node.create_publisher(JointState, "joint_commands", QoSProfile(depth=1))
        graph.diagnostics = graph.watch("/diagnostics", DiagnosticArray)

    def send(self, joint="swirl_shaft", **arrays):
        """One command for a joint."""
        self.graph.until(lambda: self.publisher.get_subscription_count(), "a reader of joint_commands")
        self.publisher.publish(JointState(name=[joint], **{name: [value] for name, value in arrays.items()}))

    def send_until(self, condition, what, **arrays):
        """The same command again and again, as an update loop sends it."""

        def sent():
            self.send(**arrays)
            return condition()

        self.graph.until(sent, what)

    def reported(self, text):
        """Whether a text has appeared on /diagnostics."""
        return any(text in status.message for message in self.graph.diagnostics for status in message.status)


@pytest.fixture
def hardware(graph):
    return Hardware(graph)


def test_a_commanded_position_is_followed_and_the_state_of_the_joint_comes_back_stamped(graph, hardware):
    graph.start("plant", "command_timeout:=2.0")
    graph.start("controller", "hall_timeout:=2.0")
    near = lambda: hardware.states and abs(hardware.states[-1].position[0] - 0.785) < 0.05  # noqa: E731
    hardware.send_until(near, "the shaft at the position", position=0.785, effort=math.nan)
    stamps = [(each.header.stamp.sec, each.header.stamp.nanosec) for each in hardware.states]
    assert stamps == sorted(stamps) and stamps[0] > (0, 0)
    assert all(list(each.name) == ["swirl_shaft"] and len(each.velocity) == 1 for each in hardware.states)


def test_a_commanded_effort_is_the_duty_and_a_silent_sender_lets_go(graph, hardware):
    applied = graph.watch("applied_duty", Float64)
    graph.start("plant", "command_timeout:=2.0")
    graph.start("controller", "command:=duty", "command_timeout:=1.0", "hall_timeout:=2.0")
    moved = lambda: hardware.states and hardware.states[-1].position[0] > 0.3  # noqa: E731
    hardware.send_until(moved, "the shaft on its way", position=0.1, effort=0.4)
    graph.until(lambda: applied and applied[-1].data == 0.0, "duty 0 once nobody commands")
    graph.until(lambda: hardware.reported("no joint_commands for 1 s: duty 0"), "the warning")
    assert {each.data for each in applied} <= {0.0, 0.4}


def test_what_cannot_be_obeyed_is_named_and_what_is_not_commanded_changes_nothing(graph, hardware):
    active = graph.watch("active_setpoint", Float64)
    graph.start("controller", "hall_timeout:=0")
    graph.until(lambda: active, "the controller")
    hardware.send(joint="elbow", position=0.5)
    graph.until(lambda: hardware.reported("joint_commands names elbow, expected swirl_shaft"), "the wrong name")
    hardware.send(position=0.6)
    graph.until(lambda: active[-1].data == 0.6, "the position")
    for position in (math.nan, 3.0):
        hardware.send(position=position)
    graph.until(lambda: hardware.reported("Setpoint 3 rad is beyond the stops"), "the refusal")
    assert active[-1].data == 0.6 and not hardware.reported("Setpoint nan")


@pytest.mark.parametrize(
    ("parameters", "joint"), [((), "left_swirl_shaft"), (("joint:=valve",), "valve")], ids=["namespace", "parameter"]
)
def test_the_joint_is_called_as_the_other_nodes_of_the_namespace_call_it(graph, parameters, joint):
    active = graph.watch("left/active_setpoint", Float64)
    publisher = graph.node.create_publisher(JointState, "left/joint_commands", QoSProfile(depth=1))
    graph.start("controller", "hall_timeout:=0", *parameters, arguments=("-r", "__ns:=/left"))

    def followed():
        publisher.publish(JointState(name=[joint], position=[0.6]))
        return active and active[-1].data == 0.6

    graph.until(followed, "the position")


def test_a_clipped_duty_is_named_and_setpoints_are_refused_where_duties_are_forwarded(graph, hardware):
    duty = graph.watch("duty", Float64)
    graph.start("controller", "command:=duty", "command_timeout:=0", "hall_timeout:=0")
    hardware.send(effort=1.5)

    def clipped():
        graph.publish("hall_voltage", Float64(data=0.42))
        return duty and duty[-1].data == 1.0

    graph.until(clipped, "the clipped duty")
    graph.until(lambda: hardware.reported("duty 1.5 is beyond +-1 and was clipped"), "the warning")
    refused = graph.set("controller", setpoint=0.5)[0]
    assert not refused.successful and "command duty" in refused.reason
