"""The monitor as a process: it follows a loop over DDS, warns of a drift, and has the recording split."""

import math
from dataclasses import replace

import pytest

pytest.importorskip("rclpy")

from diagnostic_msgs.msg import DiagnosticArray

from pierburg_ros.nodes.monitor import watched_model

pytestmark = pytest.mark.ros


def statuses(graph, name="monitor"):
    """What the monitor has said so far."""
    return [status for message in graph.received["/diagnostics"] for status in message.status if status.name == name]


def value(graph, key, name="monitor"):
    """A counter of the monitor as it was last reported."""
    values = [{pair.key: pair.value for pair in status.values} for status in statuses(graph, name)]
    return int(values[-1].get(key, 0)) if values else 0


def setpoints(duration):
    """A file of moves of ten degrees, one every 1.5 s, between 25 and 65 degrees."""
    angles = [35.0, 45.0, 55.0, 65.0, 55.0, 45.0, 35.0, 25.0]
    rows = [f"{1.5 * move},{math.radians(angles[move % len(angles)]):.6f}" for move in range(round(duration / 1.5))]
    return "\n".join(["time,setpoint", *rows, ""])


def test_a_resistance_that_drifted_is_named_and_the_recording_split(graph):
    """In simulated time, so that a busy machine loses no tick of the plant."""
    (graph.folder / "setpoints.csv").write_text(setpoints(600))
    graph.watch("/diagnostics", DiagnosticArray)
    graph.start("recorder", "use_sim_time:=true", "output:=recordings/")
    graph.start("monitor", "use_sim_time:=true")
    graph.until(lambda: statuses(graph), "the monitor")
    graph.start("controller", "use_sim_time:=true", "hall_timeout:=0.0", "setpoint_file:=setpoints.csv")
    plant = ("lockstep:=true", "time_factor:=1.0", "rate:=200.0", "hall_voltage_noise:=0.003")
    graph.start("plant", *plant, "armature_resistance:=4.84263")
    for count in range(1, 9):
        graph.until(lambda count=count: value(graph, "movements") >= count, f"{count} movements")
    graph.until(lambda: any("drift" in status.message for status in statuses(graph)), "a drift")
    said = next(status for status in statuses(graph) if "drift" in status.message)
    assert "armature_resistance x 1.1" in said.message
    graph.until(lambda: len(list((graph.folder / "recordings").glob("*.mcap"))) > 1, "a second recording")


def test_a_description_that_cannot_be_used_is_refused_in_one_line(graph):
    description = "name: odd\ntitle: odd\nload: spring\nsensor: position\nstops: {lower: 0.0, upper: 1.0}\n"
    (graph.folder / "odd.yaml").write_text(description)
    status, output = graph.ended(graph.start("monitor", "actuator:=odd.yaml"), by=None)
    assert status == 2
    assert "Traceback" not in output


def test_silence_is_said(graph):
    graph.watch("/diagnostics", DiagnosticArray)
    graph.start("monitor")
    graph.until(lambda: any("no samples on joint_states" in s.message for s in statuses(graph)), "a warning")


def test_samples_of_another_joint_are_named_in_a_warning_that_stays(graph):
    graph.watch("/diagnostics", DiagnosticArray)
    graph.start("monitor", "joint:=elbow")
    graph.start("plant", "rate:=100.0")
    text = "no samples on joint_states for 2 s (found swirl_shaft, expected elbow): nothing is watched"
    graph.until(lambda: any(text in s.message for s in statuses(graph)), "a warning")
    reports = len(statuses(graph))
    graph.until(lambda: len(statuses(graph)) > reports + 3, "more reports")
    assert all(text in s.message and s.level == b"\x01" for s in statuses(graph)[reports:])


def test_plant_and_monitor_of_a_namespace_speak_of_the_same_joint(graph):
    graph.watch("/diagnostics", DiagnosticArray)
    graph.start("monitor", arguments=("-r", "__ns:=/left"))
    graph.start("plant", "rate:=100.0", arguments=("-r", "__ns:=/left"))
    graph.start("controller", arguments=("-r", "__ns:=/left"))
    graph.until(lambda: value(graph, "samples", "left/monitor") > 100, "samples")
    graph.until(lambda: "no samples" not in statuses(graph, "left/monitor")[-1].message, "no warning")


def test_duty_and_hall_voltage_alone_are_followed(graph):
    graph.watch("/diagnostics", DiagnosticArray)
    graph.start("monitor", "angle_topic:=hall_voltage", "duty_topic:=duty")
    graph.start("plant", "rate:=100.0")
    graph.start("controller")
    graph.until(lambda: value(graph, "samples") > 200, "samples")


def test_it_watches_the_model_of_a_file_or_the_nominal_one(tmp_path):
    nominal = watched_model("pierburg", "")
    replace(nominal, values={**nominal.values, "armature_resistance": 5.0}).write(tmp_path / "model.yaml")
    assert watched_model("pierburg", str(tmp_path / "model.yaml")).values["armature_resistance"] == 5.0
