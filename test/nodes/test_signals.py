"""Signals are read from whoever sends them, and their quality of service can be overridden."""

import sys

import pytest

pytest.importorskip("rclpy")

from rclpy.qos import QoSProfile, ReliabilityPolicy
from std_msgs.msg import Float64

from pierburg_ros.nodes.graph.signals import Signal

pytestmark = pytest.mark.ros


def reliabilities(graph, topic):
    """What the readers of a topic ask for."""
    return [info.qos_profile.reliability for info in graph.node.get_subscriptions_info_by_topic(topic)]


def test_a_best_effort_publisher_is_heard(graph):
    heard = []
    Signal(graph.node, Float64, "hall_voltage", lambda message: heard.append(message.data))
    best_effort = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
    publisher = graph.node.create_publisher(Float64, "hall_voltage", best_effort)

    def come():
        publisher.publish(Float64(data=0.42))
        return heard

    graph.until(come, "a sample")
    graph.until(lambda: reliabilities(graph, "/hall_voltage") == [ReliabilityPolicy.BEST_EFFORT], "one weaker reader")


def test_a_reliable_publisher_keeps_its_reliable_reader(graph):
    heard = []
    signal = Signal(graph.node, Float64, "hall_voltage", lambda message: heard.append(message.data))
    graph.publish("hall_voltage", Float64(data=0.42))
    graph.until(lambda: heard, "a sample")
    assert signal.publishers == 1
    assert reliabilities(graph, "/hall_voltage") == [ReliabilityPolicy.RELIABLE]


def test_overrides_hold_and_one_for_a_topic_that_does_not_exist_is_named(graph):
    process = graph.start(
        "recorder",
        "output:=run.mcap",
        "qos_overrides./recorder/set_parameter.subscription.reliability:=best_effort",
        "qos_overrides./nowhere.publisher.depth:=7",
    )
    topic = "/recorder/set_parameter"
    graph.until(lambda: reliabilities(graph, topic) == [ReliabilityPolicy.BEST_EFFORT], "the override")
    graph.until((graph.folder / "run.mcap").exists, "its file, after all that is said about parameters")
    _, output = graph.ended(process)
    assert "recorder has no topic /nowhere for qos_overrides" in output
    assert "no topic /recorder/set_parameter" not in output


def test_overrides_hold_for_what_the_controller_publishes_once_it_is_active(graph):
    given = "qos_overrides./duty.publisher.reliability:=best_effort"
    process = graph.start("controller", given, "qos_overrides./controller/error.publisher.depth:=7")
    offered = lambda: [each.qos_profile.reliability for each in graph.node.get_publishers_info_by_topic("/duty")]  # noqa: E731
    graph.until(lambda: offered() == [ReliabilityPolicy.BEST_EFFORT], "the override")
    _, output = graph.ended(process)
    assert "qos_overrides" not in output


DEPTHS = """
import sys
import rclpy
from pierburg_ros.nodes.plant import PlantNode
rclpy.init(args=sys.argv)
node = PlantNode()
print({each.topic_name: each.qos_profile.depth for each in node.publishers if each.topic_name == "/hall_voltage"})
"""


@pytest.mark.parametrize(
    ("parameters", "depth"),
    [
        ((), 5),
        (("depth:=70",), 70),
        (("depth:=70", "qos_overrides./hall_voltage.publisher.depth:=8"), 8),
        (("simulated_time:=true",), 10_000),
        (("use_sim_time:=true",), 10_000),
    ],
)
def test_publishers_keep_as_much_as_of_any_sensor_unless_told_otherwise_or_time_is_simulated(graph, parameters, depth):
    given = [word for parameter in parameters for word in ("-p", parameter)]
    status, output = graph.ended(graph.run([sys.executable, "-c", DEPTHS, "--ros-args", *given]), by=None)
    assert status == 0 and f"{{'/hall_voltage': {depth}}}" in output, output
