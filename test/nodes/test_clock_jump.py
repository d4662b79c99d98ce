"""A jump of /clock: the controller counts it as its longest interval, says so, and its duty does not jump with it."""

from itertools import pairwise

import pytest

pytest.importorskip("rclpy")

from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray
from rosgraph_msgs.msg import Clock
from std_msgs.msg import Float64

pytestmark = pytest.mark.ros
PERIOD = 2_000_000  # ns
JUMP = 1000 * 10**9  # ns
NEAR = 0.45  # V, 0.0115 rad: short of the setpoint by so little that nothing saturates for seconds
SETPOINT = 0.02  # rad
LONGEST = 60.0
"""Samples that a jump may count for: 0.1 s are 50, and a few follow it."""


class Source:
    """Publishes a clock and, after each reading, a Hall sample; one duty is waited for before the next."""

    def __init__(self, graph):
        self.graph = graph
        self.duty = graph.watch("duty", Float64)
        self.diagnostics = graph.watch("/diagnostics", DiagnosticArray)
        self.now = 10**9

    def started(self):
        """Whether the controller answers; a sample more each time it is asked."""
        self.send()
        return self.duty

    def send(self):
        """A reading of the clock and a sample."""
        self.graph.publish("/clock", Clock(clock=Time(sec=self.now // 10**9, nanosec=self.now % 10**9)))
        self.graph.publish("hall_voltage", Float64(data=NEAR))

    def sample(self, after=PERIOD):
        """The duty of one sample, `after` [ns] the last."""
        self.now += after
        before = len(self.duty)
        self.send()
        self.graph.until(lambda: len(self.duty) > before, "a duty")
        return self.duty[-1].data

    def said(self, text):
        """Whether a text above OK has come."""
        status = [each for message in self.diagnostics for each in message.status]
        return any(text in each.message and each.level != b"\x00" for each in status)


def test_a_jump_of_1000_s_is_bounded_and_said(graph):
    source = Source(graph)
    graph.start("controller", "use_sim_time:=true", "hall_timeout:=0", "angle_timeout:=3600.0", f"setpoint:={SETPOINT}")
    graph.until(source.started, "the first duty")
    steady = [source.sample() for _ in range(80)]
    growth = max(abs(later - before) for before, later in pairwise(steady[-20:]))
    jumped = [source.sample(JUMP), *(source.sample() for _ in range(5))]
    assert max(abs(duty - steady[-1]) for duty in jumped) <= LONGEST * growth
    graph.until(lambda: source.said("s lay between two Hall samples: counted as 0.1 s"), "the jump to be said")
