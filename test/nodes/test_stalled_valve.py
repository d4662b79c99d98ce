"""A valve that is stalled for half a minute, over DDS: limited, switched off and named, by device and controller."""

import math
import statistics

import pytest

pytest.importorskip("rclpy")

from diagnostic_msgs.msg import DiagnosticArray
from rosgraph_msgs.msg import Clock
from std_msgs.msg import Float64

pytestmark = pytest.mark.ros
DURATION = 30.0  # s
RATE = 100.0  # Hz
RATED, TIME_CONSTANT = 1.0 / 3.0, 20.0  # share of the stall current, s: as the parameters say by default
LIMITED_FOR = 10.0  # s
FULL = 0.7  # duty: twice the rated one; noise takes a tenth off the one that is wanted
OFF = "stall: the winding is too hot: duty 0 until it has cooled"


def seconds(clock):
    """Simulated time [s] of a message."""
    return clock.clock.sec + clock.clock.nanosec * 1e-9


class Stall:
    """What one run applied over simulated time [s] since its first large duty, and what was said above OK."""

    def __init__(self, graph):
        self.graph = graph
        self.clock = graph.watch("/clock", Clock)
        self.applied = graph.watch("applied_duty", Float64)
        self.diagnostics = graph.watch("/diagnostics", DiagnosticArray)

    def duties(self):
        """Applied duty by time since the first large one."""
        numbers = {
            topic: [info["publication_sequence_number"] for info in self.graph.stamps[topic]]
            for topic in ("/clock", "applied_duty")
        }
        times = {n: seconds(message) for n, message in zip(numbers["/clock"], self.clock, strict=True)}
        applied = {n: message.data for n, message in zip(numbers["applied_duty"], self.applied, strict=True)}
        found = {times[n]: duty for n, duty in applied.items() if n in times}
        began = min(time for time, duty in found.items() if duty > FULL)
        return {time - began: duty for time, duty in found.items()}

    def end(self):
        """Wait until half a minute has passed since the first large duty."""
        self.graph.until(lambda: any(message.data > FULL for message in self.applied), "a large duty")
        end = seconds(self.clock[-1]) + DURATION
        self.graph.until(lambda: seconds(self.clock[-1]) > end, "half a minute")

    def said(self, node):
        """What the winding's task of a node said above OK."""
        status = [each for message in self.diagnostics for each in message.status]
        return {each.message for each in status if each.name == f"{node}: winding" and each.level != b"\x00"}


def check(stall, node, late, spread):
    """The duty wanted, then the rated current, then 0, when the closed form of I^2 t says so, or by `late` [s] later.

    `spread`: how far the duties of the first two may be from their middle [1].
    """
    duties = stall.duties()
    wanted = [duty for time, duty in duties.items() if 0.2 < time < 2.0]
    ratio = RATED / statistics.median(wanted)
    hot = -TIME_CONSTANT * math.log(1.0 - ratio**2)
    limited = [duty for time, duty in duties.items() if hot + late < time < hot + LIMITED_FOR - 0.1]
    off = [duty for time, duty in duties.items() if hot + LIMITED_FOR + late < time < hot + LIMITED_FOR + 10.0]
    assert min(duty for time, duty in duties.items() if 0.2 < time < hot - 0.1) > FULL
    assert abs(statistics.median(limited) - RATED) < 0.03
    assert max(abs(duty - RATED) for duty in limited) <= spread
    assert off and set(off) == {0.0}
    assert {"stall: the winding is hot, current limited to 1.1 A", OFF} <= stall.said(node)


def test_a_device_held_against_its_stop_protects_itself(graph):
    """A duty of 1 without end: the plant opens, meets its stop, and limits what it applies."""
    stall = Stall(graph)
    graph.start("plant", "simulated_time:=true", "time_factor:=8.0", f"rate:={RATE}", "command_timeout:=0")
    graph.publish("duty", Float64(data=1.0))
    stall.end()
    check(stall, "plant", late=0.3, spread=0.01)


def test_a_controller_takes_back_the_duty_of_a_jammed_valve(graph):
    """The shaft is held by more friction than the motor has torque, and the device does not protect itself."""
    stall = Stall(graph)
    jammed = ("coulomb_friction:=5.0", "thermal_time_constant:=0.0", "hall_voltage_noise:=0.02")
    graph.start("plant", "lockstep:=true", "time_factor:=0.0", f"rate:={RATE}", "command_timeout:=0", *jammed)
    graph.until_connected()  # or the first large duty is missed, and all that follows seems early
    graph.start("controller", "use_sim_time:=true", "hall_timeout:=0", "setpoint:=1.0")
    stall.end()
    check(stall, "controller", late=0.3, spread=0.2)
