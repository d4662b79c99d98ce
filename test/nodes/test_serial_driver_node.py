"""The serial driver as a process over DDS, with a simulated device on a pseudo-terminal."""

import math

import pytest

pytest.importorskip("rclpy")

from diagnostic_msgs.msg import DiagnosticArray
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool, Float64
from support.simulated_device import DeviceOnPty, SimulatedDevice

from pierburg_ros.nodes.graph.qos import STATE

pytestmark = pytest.mark.ros


@pytest.fixture
def line():
    line = DeviceOnPty(SimulatedDevice(period=0.01))
    yield line
    line.unplug()


def said(graph, text):
    """Whether the driver has said `text` so far."""
    return any(text in status.message for message in graph.received["/diagnostics"] for status in message.status)


def test_it_offers_the_topics_of_an_actuator_and_obeys_duty(graph, line):
    topics = {"hall_voltage": Float64, "applied_duty": Float64, "joint_states": JointState, "supply_voltage": Float64}
    for name, kind in topics.items():
        graph.watch(name, kind)
    graph.start("serial_driver", f"port:={line.path}", "command_timeout:=0.0")
    graph.until(lambda: all(graph.received[name] for name in topics), "all topics")
    assert graph.received["supply_voltage"][-1].data == pytest.approx(13.5)
    graph.publish("duty", Float64(data=0.23))
    graph.until(lambda: graph.received["applied_duty"][-1].data == pytest.approx(0.23), "the duty")
    graph.until(lambda: graph.received["hall_voltage"][-1].data > 1.0, "the valve to open")
    stamps = [
        message.header.stamp.sec * 10**9 + message.header.stamp.nanosec for message in graph.received["joint_states"]
    ]
    assert stamps == sorted(set(stamps))
    assert graph.received["joint_states"][-1].name == ["swirl_shaft"]


def test_a_duty_that_is_no_number_is_not_sent(graph, line):
    graph.watch("applied_duty", Float64)
    graph.watch("/diagnostics", DiagnosticArray)
    graph.start("serial_driver", f"port:={line.path}", "command_timeout:=0.0")
    graph.until(lambda: graph.received["applied_duty"], "the device")
    graph.publish("duty", Float64(data=0.1))
    graph.publish("duty", Float64(data=math.nan))
    graph.until(lambda: said(graph, "not finite"), "the refusal")
    graph.until(lambda: graph.received["applied_duty"][-1].data == pytest.approx(0.1), "the duty before")


def test_the_time_out_of_the_device_is_told(graph, line):
    graph.watch("/diagnostics", DiagnosticArray)
    graph.watch("applied_duty", Float64)
    graph.start("serial_driver", f"port:={line.path}", "command_timeout:=0.1")
    graph.until(lambda: graph.received["applied_duty"], "the device")
    graph.publish("duty", Float64(data=0.2))
    graph.until(lambda: said(graph, "no duty reached the device in time"), "the time-out")
    graph.until(lambda: graph.received["applied_duty"][-1].data == 0.0, "duty 0")


def test_silence_and_reset_are_told(graph, line):
    graph.watch("/diagnostics", DiagnosticArray)
    graph.watch("enabled", Bool, STATE)
    graph.start("serial_driver", f"port:={line.path}")
    graph.until(lambda: graph.received["enabled"], "the device")
    line.silent = True
    graph.until(lambda: said(graph, "the device is silent"), "silence")
    line.device.reset()
    line.silent = False
    graph.until(lambda: said(graph, "the device started anew"), "the reset")


def test_a_pulled_plug_is_told_and_a_new_one_found(graph):
    path = graph.folder / "line"
    first = DeviceOnPty(SimulatedDevice(period=0.01))
    path.symlink_to(first.path)
    graph.watch("hall_voltage", Float64)
    graph.watch("/diagnostics", DiagnosticArray)
    graph.start("serial_driver", f"port:={path}")
    graph.until(lambda: graph.received["hall_voltage"], "the device")
    path.unlink()
    first.unplug()
    graph.until(lambda: said(graph, "is gone"), "the pulled plug")
    heard = len(graph.received["hall_voltage"])
    second = DeviceOnPty(SimulatedDevice(period=0.01))
    path.symlink_to(second.path)
    graph.until(lambda: len(graph.received["hall_voltage"]) > heard + 10, "the device again")
    second.unplug()


def test_what_is_no_line_ends_in_one_line(graph):
    (graph.folder / "file").touch()
    status, output = graph.ended(graph.start("serial_driver", "port:=file"), by=None)
    assert status == 2
    assert "is no serial line" in output
    assert "Traceback" not in output
