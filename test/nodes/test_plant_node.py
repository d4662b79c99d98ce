"""The plant as a process: what it publishes, obeys, refuses and survives."""

import math
import signal

import pytest

pytest.importorskip("rclpy")

from diagnostic_msgs.msg import DiagnosticArray
from rcl_interfaces.msg import Log, ParameterDescriptor
from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.srv import DescribeParameters
from rclpy.parameter import Parameter
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64
from std_srvs.srv import Trigger

pytestmark = pytest.mark.ros


def complaints(diagnostics):
    """All messages above OK so far, level and text."""
    found = [status for message in diagnostics for status in message.status]
    return [(status.level, status.message) for status in found if status.level != b"\x00"]


@pytest.fixture
def plant(graph):
    """A running plant and the signals it publishes."""
    graph.hall_voltage = graph.watch("hall_voltage", Float64)
    graph.joint_states = graph.watch("joint_states", JointState)
    graph.applied_duty = graph.watch("applied_duty", Float64)
    graph.diagnostics = graph.watch("/diagnostics", DiagnosticArray)
    graph.process = graph.start("plant")
    graph.until(lambda: len(graph.joint_states) > 10, "joint states")
    return graph


def test_at_rest_it_publishes_the_closed_stop_tick_by_tick(plant):
    assert {m.data for m in plant.hall_voltage} == {0.42}
    assert {m.data for m in plant.applied_duty} == {0.0}
    state = plant.joint_states[-1]
    assert list(state.name) == ["swirl_shaft"]
    assert state.position[0] == pytest.approx(0.0, abs=1e-12)
    stamps = [m.header.stamp.sec + m.header.stamp.nanosec * 1e-9 for m in plant.joint_states]
    assert stamps == sorted(set(stamps))


def test_a_tick_is_published_in_the_order_of_the_contract(plant):
    names = ("hall_voltage", "applied_duty", "joint_states")
    ticks = [
        {info["publication_sequence_number"]: info["source_timestamp"] for info in plant.stamps[name]} for name in names
    ]
    common = set.intersection(*map(set, ticks))
    assert common
    assert all(ticks[0][k] <= ticks[1][k] <= ticks[2][k] for k in common)


def test_a_duty_opens_the_valve_and_silence_closes_it(plant):
    def opened():
        plant.publish("duty", Float64(data=0.6))
        return plant.hall_voltage[-1].data > 1.5

    plant.until(opened, "an open valve")
    assert max(m.data for m in plant.applied_duty) == 0.6
    plant.until(lambda: plant.applied_duty[-1].data == 0.0, "the time-out")
    plant.until(lambda: plant.hall_voltage[-1].data < 0.6, "the spring")
    plant.until(lambda: (b"\x01", "no duty for 0.05 s: duty 0") in complaints(plant.diagnostics), "a report")


def test_duties_that_are_not_finite_are_refused_and_wide_ones_clipped(plant):
    assert plant.set("plant", command_timeout=0.0)[0].successful
    plant.publish("duty", Float64(data=7.0))
    plant.until(lambda: plant.applied_duty[-1].data == 1.0, "the clipped duty")
    plant.publish("duty", Float64(data=math.nan))
    plant.until(lambda: any(level == b"\x02" for level, _ in complaints(plant.diagnostics)), "an error")
    assert plant.applied_duty[-1].data == 1.0
    plant.publish("duty", Float64(data=0.25))
    plant.until(lambda: plant.applied_duty[-1].data == 0.25, "the next duty")


def test_parameters_are_described_with_unit_and_range(plant):
    names = ["armature_resistance", "static_friction.breakaway_torque"]
    request = DescribeParameters.Request(names=names)
    first, second = plant.call(DescribeParameters, "plant/describe_parameters", request).descriptors
    assert isinstance(first, ParameterDescriptor)
    assert "[ohm]" in first.description
    assert first.floating_point_range[0].from_value > 0.0
    assert "[N.m]" in second.description
    assert plant.get("plant", *names) == [4.139, 0.0]


def test_what_cannot_be_set_is_refused_with_a_reason(plant):
    refusals = [
        ("armature_resistance", -1.0, "expected 0.1 to 50 ohm"),
        ("armature_resistance", math.nan, "expected 0.1 to 50 ohm"),
        ("armature_resistance", "high", "expected a number"),
        ("nonsense", 1.0, "has no parameter 'nonsense'"),
        ("suply_voltage", 12.0, "Did you mean supply_voltage?"),
        ("actuator", "xl330", "read-only"),
    ]
    for name, value, reason in refusals:
        result = plant.set("plant", **{name: value})[0]
        assert not result.successful
        assert reason in result.reason
        assert plant.get("plant", "armature_resistance") == [4.139]
    ticks = len(plant.joint_states)
    plant.until(lambda: len(plant.joint_states) > ticks + 10, "further ticks")


def test_parameters_by_topic_with_integers_and_refusals(plant):
    rosout = plant.watch("/rosout", Log)
    plant.publish("plant/set_parameter", Parameter("armature_resistance", value=5).to_parameter_msg())
    plant.until(lambda: plant.get("plant", "armature_resistance") == [5.0], "the new value")
    wrong = Parameter("armature_resistance", value=1e6).to_parameter_msg()
    assert isinstance(wrong, ParameterMessage)
    plant.publish("plant/set_parameter", wrong)
    reason = "armature_resistance is 1e+06; expected 0.1 to 50 ohm."
    plant.until(lambda: (b"\x01", reason) in complaints(plant.diagnostics), "a warning on /diagnostics")
    plant.until(lambda: any(m.msg == reason and m.level == 30 for m in rosout), "a warning in rosout")
    assert plant.get("plant", "armature_resistance") == [5.0]


def test_coupled_parameters_change_together_or_not_at_all(plant):
    alone = plant.set("plant", static_friction__breakaway_torque=0.15)[0]
    assert not alone.successful
    assert "coulomb_friction" in alone.reason
    refused = plant.set_together("plant", coulomb_friction=0.3, static_friction__breakaway_torque=0.25)
    assert not refused.successful
    assert plant.get("plant", "coulomb_friction") == [0.2007]
    together = {"coulomb_friction": 0.1, "static_friction__breakaway_torque": 0.15}
    assert plant.set_together("plant", **together).successful
    assert plant.get("plant", "coulomb_friction", "static_friction.breakaway_torque") == [0.1, 0.15]


def test_reset_closes_the_valve_at_once(plant):
    plant.set("plant", command_timeout=0.0)
    plant.publish("duty", Float64(data=1.0))
    plant.until(lambda: plant.hall_voltage[-1].data == 4.52, "the open stop")
    plant.publish("duty", Float64(data=0.0))
    plant.until(lambda: plant.applied_duty[-1].data == 0.0, "duty 0")
    assert plant.call(Trigger, "plant/reset", Trigger.Request()).success
    plant.until(lambda: plant.hall_voltage[-1].data == 0.42, "the closed stop")


@pytest.mark.parametrize("by", [signal.SIGINT, signal.SIGTERM])
def test_it_ends_cleanly_on_a_signal(plant, by):
    status, output = plant.ended(plant.process, by)
    assert status == 0
    assert "Traceback" not in output


def test_values_of_a_parameter_file_are_checked_too(graph):
    file = graph.folder / "plant.yaml"
    file.write_text(
        "plant:\n  ros__parameters:\n    armature_resistance: 5\n    gear_ratio: -3.0\n    rate: 200\n    nonsense: 1\n"
    )
    status, output = graph.ended(graph.start("plant", arguments=("--params-file", str(file))), by=None)
    assert status == 2
    ratio, unknown = output.splitlines()[-2:]
    assert ratio.startswith("gear_ratio is -3; expected ")
    assert unknown.startswith("plant has no parameter 'nonsense'")


@pytest.mark.parametrize(
    ("parameter", "line"),
    [
        ("model:=missing.yaml", "missing.yaml"),
        ("actuator:=steam_engine", "steam_engine"),
        ("actuator:=xl330", "measures its position"),
    ],
)
def test_what_it_cannot_start_with_is_one_line_and_status_2(graph, parameter, line):
    process = graph.start("plant", parameter)
    status, output = graph.ended(process, by=None)
    assert status == 2
    lines = [text for text in output.splitlines() if "[INFO]" not in text]
    assert len(lines) == 1
    assert line in lines[0]


def test_a_model_file_sets_values_and_effects(graph):
    file = graph.folder / "model.yaml"
    file.write_text(
        "actuator: pierburg\nparameters: {armature_resistance: 4.71}\n"
        "effects:\n  static_friction: {breakaway_torque: 0.27, stribeck_velocity: 0.1}\n"
    )
    graph.start("plant", f"model:={file}", "formulation:=textbook")
    names = ("armature_resistance", "static_friction.breakaway_torque", "formulation")
    assert graph.get("plant", *names) == [4.71, 0.27, "textbook"]
