"""Runs in lockstep: started by their partners, repeatable tick by tick, ended when nobody answers."""

from threading import Event

import pytest

pytest.importorskip("rclpy")

from rosgraph_msgs.msg import Clock
from std_msgs.msg import Float64

from pierburg_ros.errors import InputError
from pierburg_ros.nodes.core.plant_time import Lockstep
from pierburg_ros.processes import free_domain

TICKS = 500


def numbered_messages(graph, topic):
    """Messages of a topic by their number among those published."""
    return {
        info["publication_sequence_number"]: message
        for info, message in zip(graph.stamps[topic], graph.received[topic], strict=True)
    }


def played(graph, setpoints):
    """(Hall voltage, duty) by simulated time [ns] of one run in lockstep."""
    topics = {"hall_voltage": Float64, "applied_duty": Float64, "/clock": Clock}
    watched = {topic: graph.watch(topic, kind) for topic, kind in topics.items()}
    noisy = ("hall_voltage_noise:=0.003", "seed:=3")
    graph.start("plant", "lockstep:=true", "time_factor:=0", "command_timeout:=0", *noisy)
    graph.until_connected()
    graph.start("controller", "use_sim_time:=true", "hall_timeout:=0", f"setpoint_file:={setpoints}")
    graph.until(lambda: all(len(found) > TICKS for found in watched.values()), "a run in lockstep")
    numbered = {topic: numbered_messages(graph, topic) for topic in topics}
    common = set.intersection(*(set(found) for found in numbered.values()))
    return {
        numbered["/clock"][n].clock.nanosec + numbered["/clock"][n].clock.sec * 10**9: (
            numbered["hall_voltage"][n].data,
            numbered["applied_duty"][n].data,
        )
        for n in common
    }


@pytest.mark.ros
def test_a_run_repeats_bit_by_bit(tmp_path):
    from support.ros_graph import Graph

    setpoints = tmp_path / "setpoints.csv"
    setpoints.write_text("time,setpoint\n0,0.2\n0.3,0.9\n0.6,0.4\n")
    runs = []
    for _ in range(2):
        with Graph(free_domain(), tmp_path) as graph:  # one of its own: nobody is left from the run before
            runs.append(played(graph, setpoints))
    first, second = runs
    ticks = sorted(set(first) & set(second))
    assert len(ticks) > 0.9 * TICKS
    assert {tick % 2_000_000 for tick in ticks} == {0}
    assert [first[tick] for tick in ticks] == [second[tick] for tick in ticks]
    assert max(hall for hall, _ in first.values()) > 2.0


@pytest.mark.ros
def test_it_waits_for_its_partners(graph):
    clock = graph.watch("/clock", Clock)
    graph.start("plant", "lockstep:=true")
    assert graph.get("plant", "lockstep") == [True]
    assert clock == []
    graph.watch("hall_voltage", Float64)
    graph.publish("duty", Float64(data=0.0))
    graph.until(lambda: clock, "the first tick")


@pytest.mark.ros
def test_it_ends_with_one_line_when_the_controller_falls_silent(graph):
    clock = graph.watch("/clock", Clock)
    graph.watch("hall_voltage", Float64)
    plant = graph.start("plant", "lockstep:=true")
    graph.publish("duty", Float64(data=0.0))
    graph.until(lambda: len(clock) > 3, "repeated samples")
    status, output = graph.ended(plant, by=None)
    assert status == 2
    lines = [text for text in output.splitlines() if not text.startswith("[")]
    assert len(lines) == 1
    assert "No duty came within 5 s" in lines[0]


class Partner:
    """Answers samples from inside `send`, as often as told."""

    def __init__(self, answers):
        self.answers = iter(answers)
        self.lockstep = Lockstep(Event())
        self.sent = 0

    def send(self):
        self.sent += 1
        for _ in range(next(self.answers)):
            self.lockstep.reply()


def test_one_sample_one_reply():
    partner = Partner([1, 1])
    partner.lockstep.exchange(partner.send)
    partner.lockstep.exchange(partner.send)
    assert partner.sent == 2


def test_a_sample_without_reply_is_repeated_and_the_surplus_reply_is_taken_in():
    partner = Partner([0, 2, 1])
    partner.lockstep.exchange(partner.send)
    assert partner.sent == 2
    partner.lockstep.exchange(partner.send)
    assert partner.sent == 3


def test_a_stray_duty_before_the_sample_is_no_reply():
    partner = Partner([0, 1])
    partner.lockstep.reply()
    partner.lockstep.exchange(partner.send)
    assert partner.sent == 2


def test_nobody_answers(monkeypatch):
    monkeypatch.setattr("pierburg_ros.nodes.core.plant_time.REPEAT", 0.05)
    monkeypatch.setattr("pierburg_ros.nodes.core.plant_time.GIVE_UP", 0.2)
    partner = Partner([0] * 10)
    with pytest.raises(InputError, match="No duty came"):
        partner.lockstep.exchange(partner.send)
    assert partner.sent == 4
