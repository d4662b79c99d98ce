"""What the controller makes of what the actuator really did: its winding's heat, its time, its direction, its angle."""

import time

import pytest

pytest.importorskip("rclpy")

from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray
from rosgraph_msgs.msg import Clock
from std_msgs.msg import Float64

pytestmark = pytest.mark.ros
PERIOD = 20_000_000  # ns
AT_ONCE = 5
"""Ticks sent together: half of what a reader keeps."""
NOISE = (0.0, 0.004)  # V, alternating: more than a sensor counts as frozen with
CLOSED, OPEN = 0.42, 4.52  # V


class Actuator:
    """Publishes a clock, a Hall voltage and the duty that it obeyed; a few ticks at a time."""

    def __init__(self, graph, *parameters):
        self.graph = graph
        self.duties = graph.watch("duty", Float64)
        self.diagnostics = graph.watch("/diagnostics", DiagnosticArray)
        self.voltage, self.applied, self.now = CLOSED, None, 10**9
        given = ("use_sim_time:=true", "hall_timeout:=0.0", "angle_timeout:=3600.0", *parameters)
        graph.start("controller", *given)
        graph.until(self.started, "the first duty")

    def started(self):
        """Whether the controller answers; a tick more each time it is asked."""
        self.tick()
        return self.duties

    def tick(self):
        """One tick."""
        self.now += PERIOD
        self.graph.publish("/clock", Clock(clock=Time(sec=self.now // 10**9, nanosec=self.now % 10**9)))
        self.graph.publish("hall_voltage", Float64(data=self.voltage + NOISE[self.now // PERIOD % 2]))
        if self.applied is not None:
            self.graph.publish("applied_duty", Float64(data=self.applied))

    def run(self, duration):
        """Ticks for `duration` [s], a duty for each."""
        wanted = len(self.duties)
        for count in range(1, round(duration * 1e9 / PERIOD) + 1):
            self.tick()
            wanted += 1
            if count % AT_ONCE == 0:
                self.graph.until(lambda wanted=wanted: len(self.duties) >= wanted, "the duties")

    def said(self, *texts):
        """Whether a message above OK with all these texts has come."""
        told = [each for message in self.diagnostics for each in message.status if each.level != b"\x00"]
        return any(all(text in each.message for text in texts) for each in told)

    def heat(self):
        """The heat of the winding as last reported."""
        found = [v.value for m in self.diagnostics for s in m.status for v in s.values if v.key == "heat"]
        return float(found[-1])


def test_a_duty_that_the_actuator_did_not_obey_heats_nothing(graph):
    """Full duty against a standstill is three times the rated current, which makes the winding hot after 2.4 s."""
    actuator = Actuator(graph, "setpoint:=1.2")
    actuator.applied = 0.0
    actuator.run(3.0)
    assert actuator.duties[-1].data > 0.9
    reports = len(actuator.diagnostics)
    graph.until(lambda: len(actuator.diagnostics) > reports + 1, "a later report")
    assert actuator.heat() < 0.1
    assert not actuator.said("stall")
    actuator.applied = None
    actuator.run(5.0)
    graph.until(lambda: actuator.said("stall: the winding is hot"), "the heat of what was sent")


@pytest.mark.parametrize(
    ("setpoint", "voltage", "texts"),
    [
        (0.0, CLOSED + 0.5, ("the angle rests at 0.922 V", "that closes (stop at 0.42 V): sensor off")),
        (1.2, CLOSED, ("the angle rests at 0.422 V", "that opens", "polarity")),
    ],
)
def test_an_offset_at_the_stop_and_a_reversed_polarity_at_rest_are_named(graph, setpoint, voltage, texts):
    actuator = Actuator(graph, f"setpoint:={setpoint}")
    actuator.voltage = voltage
    actuator.run(2.0)
    graph.until(lambda: actuator.said(*texts), "a name for it")


def test_a_motion_against_the_duty_is_named(graph):
    actuator = Actuator(graph, "setpoint:=1.57", "thermal_time_constant:=0.0")
    actuator.voltage = OPEN - 0.5
    actuator.run(1.0)
    for _ in range(14):
        actuator.voltage -= 0.25
        actuator.run(AT_ONCE * PERIOD * 1e-9)
    graph.until(lambda: actuator.said("the angle moves the other way", "that opens"), "a name for it")


def test_a_sample_that_was_sent_late_does_not_make_the_next_one_too_fast(graph):
    """Taken on time, sent 0.1 s later; the next one follows at once, and the shaft has gone on meanwhile."""
    duties = graph.watch("duty", Float64)
    diagnostics = graph.watch("/diagnostics", DiagnosticArray)
    graph.start("controller", "hall_timeout:=0.0", "angle_timeout:=3600.0")

    def started():
        graph.publish("hall_voltage", Float64(data=CLOSED))
        return duties

    graph.until(started, "the first duty")
    for _ in range(5):
        for voltage in (0.6, 0.6, 0.62, 1.9, 1.9, 1.9, 1.9, 1.0, 0.6):
            time.sleep(0.1 if voltage != 1.9 else 0.0)
            graph.publish("hall_voltage", Float64(data=voltage))
    answered = len(duties)
    graph.until(lambda: len(duties) > answered or (started() and len(duties) > answered), "the last duty")
    reports = len(diagnostics)
    graph.until(lambda: len(diagnostics) > reports + 2, "what it says then")
    assert not any("came faster" in s.message for m in diagnostics for s in m.status)
