"""Before the first `/clock` there is no time; a clock that jumps back is said by every node and begins a new file."""

import pytest

pytest.importorskip("rclpy")

from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray
from mcap.reader import make_reader
from rclpy.duration import Duration
from rosgraph_msgs.msg import Clock
from std_msgs.msg import Bool, Float64
from support.ros_graph import DEADLINE

from pierburg_ros.nodes.graph.qos import STATE

pytestmark = pytest.mark.ros


def reading(milliseconds):
    """A reading of the clock."""
    return Clock(clock=Time(sec=milliseconds // 1000, nanosec=milliseconds % 1000 * 1_000_000))


def recorded(path):
    """(topic, log time [ms]) of each message in a file."""
    with path.open("rb") as stream:
        return [(c.topic, m.log_time // 1_000_000) for _, c, m in make_reader(stream).iter_messages()]


def test_the_recorder_waits_for_the_first_clock_and_begins_a_new_file_where_it_jumps_back(graph):
    diagnostics = graph.watch("/diagnostics", DiagnosticArray)
    graph.node.create_publisher(Bool, "enabled", STATE).publish(Bool(data=True))
    process = graph.start("recorder", "output:=run.mcap", "use_sim_time:=true")
    duty = graph.node.create_publisher(Float64, "duty", 1000)
    clock = graph.node.create_publisher(Clock, "/clock", 1000)
    graph.until(lambda: duty.get_subscription_count() and clock.get_subscription_count() > 1, "the recorder")

    def send(*times):
        for milliseconds in times:
            if milliseconds is not None:
                clock.publish(reading(milliseconds))
            duty.publish(Float64(data=0.1))
        assert all(each.wait_for_all_acked(Duration(seconds=DEADLINE)) for each in (clock, duty))

    def said(text):
        return any(text in s.message and s.level == b"\x01" for m in diagnostics for s in m.status)

    send(*[None] * 50)
    graph.until(lambda: said("waiting for /clock"), "the wait to be said")
    send(*range(5000, 5100))
    graph.until(lambda: any(m.header.stamp == reading(5099).clock for m in diagnostics), "the clock to be followed")
    send(1000)
    graph.until(lambda: said("the clock went back by 4.1 s"), "the jump to be said")
    send(*range(1001, 1100))
    graph.until(lambda: (graph.folder / "run_1.mcap").exists(), "a new file")
    assert graph.ended(process)[0] == 0
    before, after = (recorded(graph.folder / name) for name in ("run.mcap", "run_1.mcap"))
    assert [time for topic, time in before if topic == "/duty"] == list(range(5000, 5100))
    assert [time for topic, time in after if topic == "/duty"] == list(range(1000, 1100))
    assert ("/enabled", 5000) in before


def test_plant_controller_and_monitor_say_that_the_clock_went_back(graph):
    diagnostics = graph.watch("/diagnostics", DiagnosticArray)
    joint = graph.watch("hall_voltage", Float64)
    nodes = ("plant", "controller", "monitor")
    for node in nodes:
        graph.start(node, "use_sim_time:=true")
    clock = graph.node.create_publisher(Clock, "/clock", 1000)
    graph.until(lambda: clock.get_subscription_count() > 3, "readers of the clock")
    now = iter(range(8000, 10**9, 20))

    def running():
        clock.publish(reading(next(now)))
        return len(joint) > 5 and {s.name for m in diagnostics for s in m.status} >= set(nodes)

    graph.until(running, "samples")
    for milliseconds in range(3000, 3200, 20):
        clock.publish(reading(milliseconds))

    def told():
        return {s.name for m in diagnostics for s in m.status if "the clock went back by" in s.message}

    graph.until(lambda: told() >= set(nodes), "all three to say so")
