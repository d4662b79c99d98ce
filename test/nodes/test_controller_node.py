"""The controller as a process, its Hall samples sent by the test."""

import math
import signal

import pytest

pytest.importorskip("rclpy")

from diagnostic_msgs.msg import DiagnosticArray
from std_msgs.msg import Bool, Float64
from std_srvs.srv import SetBool

pytestmark = pytest.mark.ros


@pytest.fixture
def controller(graph):
    """A running controller, which the test feeds by `graph.sample`."""
    graph.duty = graph.watch("duty", Float64)
    graph.active = graph.watch("active_setpoint", Float64)
    graph.diagnostics = graph.watch("/diagnostics", DiagnosticArray)
    graph.process = graph.start("controller", "hall_timeout:=0")
    graph.sample = lambda voltage: graph.publish("hall_voltage", Float64(data=voltage))
    graph.until(lambda: graph.active, "the controller")
    return graph


def answered(graph, voltage):
    """The duty for one sample."""
    before = len(graph.duty)
    graph.sample(voltage)
    graph.until(lambda: len(graph.duty) > before, "a duty")
    return graph.duty[-1].data


def reported(graph, text):
    """Whether a text has appeared on /diagnostics."""
    return any(text in status.message for message in graph.diagnostics for status in message.status)


def test_one_duty_for_every_sample(controller):
    answered(controller, 0.42)
    before = len(controller.duty)
    for _ in range(20):
        answered(controller, 0.42)
    assert len(controller.duty) == before + 20


def test_setpoints_by_topic_and_parameter_the_last_writer_wins(controller):
    controller.publish("setpoints", Float64(data=0.785))
    controller.until(lambda: controller.active[-1].data == 0.785, "the topic's setpoint")
    assert controller.get("controller", "setpoint") == [0.0]
    assert controller.set("controller", setpoint=1)[0].successful
    controller.until(lambda: controller.active[-1].data == 1.0, "the parameter's setpoint")
    duties = [answered(controller, 0.42) for _ in range(5)]
    assert duties[-1] > 0.0


def test_a_setpoint_that_cannot_be_is_refused_and_the_last_one_stays(controller):
    controller.publish("setpoints", Float64(data=0.5))
    controller.until(lambda: controller.active[-1].data == 0.5, "the first setpoint")
    for value in (math.nan, -0.1, 2.0):
        controller.publish("setpoints", Float64(data=value))
        controller.until(lambda value=value: reported(controller, f"Setpoint {value:g}"), "the refusal")
        assert controller.active[-1].data == 0.5
        assert not controller.set("controller", setpoint=value)[0].successful
        assert controller.get("controller", "setpoint") == [0.0]


def test_within_reach_of_a_stop_a_setpoint_is_clamped(controller):
    controller.publish("setpoints", Float64(data=math.pi / 2 + 0.0015))
    controller.until(lambda: controller.active[-1].data == math.pi / 2, "the clamped setpoint")
    assert controller.set("controller", setpoint=-0.0015)[0].successful
    controller.until(lambda: controller.active[-1].data == 0.0, "the clamped parameter")


def test_disabled_it_answers_with_zero(controller):
    controller.set("controller", setpoint=1.0)
    assert controller.call(SetBool, "controller/enable", SetBool.Request(data=False)).success
    assert [answered(controller, 0.42) for _ in range(3)] == [0.0, 0.0, 0.0]
    assert controller.call(SetBool, "controller/enable", SetBool.Request(data=True)).success
    assert max(answered(controller, 0.42) for _ in range(10)) > 0.0


def test_gains_are_live_and_checked_together(controller):
    assert controller.set("controller", proportional_gain=2)[0].successful
    assert controller.get("controller", "proportional_gain") == [2.0]
    refused = controller.set("controller", positive=-0.5)[0]
    assert not refused.successful
    assert "order" in refused.reason
    assert controller.get("controller", "positive") != [-0.5]


def test_without_hall_samples_it_sends_zero_and_says_so(controller):
    controller.set("controller", setpoint=1.0)
    assert max(answered(controller, 0.42 + 0.01 * step) for step in range(10)) > 0.0
    controller.set("controller", hall_timeout=0.05)
    controller.until(lambda: reported(controller, "no Hall sample for 0.05 s"), "the error")
    controller.until(lambda: controller.duty[-1].data == 0.0, "duty 0")


def test_a_sample_that_is_not_finite_keeps_the_duty(controller):
    controller.set("controller", setpoint=1.0, angle_timeout=3600.0)
    duty = [answered(controller, 0.42 + 0.01 * step) for step in range(10)][-1]
    assert duty > 0.0
    assert answered(controller, math.nan) == duty
    controller.until(lambda: reported(controller, "last duty kept"), "the error")


def test_internals_on_demand(controller):
    errors = controller.watch("controller/error", Float64)
    saturated = controller.watch("controller/saturated", Bool)
    controller.set("controller", setpoint=1.0, publish_internals=True)
    volts = 4.10 / (math.pi / 2)

    def seen():
        controller.sample(0.42)
        return errors and saturated

    controller.until(seen, "the internals")
    assert errors[-1].data == pytest.approx(volts)


@pytest.mark.parametrize("by", [signal.SIGINT, signal.SIGTERM])
def test_it_ends_cleanly_on_a_signal(controller, by):
    status, output = controller.ended(controller.process, by)
    assert status == 0
    assert "Traceback" not in output


def test_a_setpoint_file_that_cannot_be_read_is_one_line_and_status_2(graph):
    file = graph.folder / "setpoints.csv"
    file.write_text("time,setpoint\n0,9\n")
    status, output = graph.ended(graph.start("controller", f"setpoint_file:={file}"), by=None)
    assert status == 2
    assert "setpoints.csv line 2" in output
    assert len(output.splitlines()) == 1
