"""A sensor that breaks while it is controlled, over DDS: duty 0, the fault's name, and the return."""

import json
import signal
import statistics
import sys
from pathlib import Path

import pytest

pytest.importorskip("rclpy")

from diagnostic_msgs.msg import DiagnosticArray

pytestmark = pytest.mark.ros
BENCH = Path(__file__).parents[1] / "support" / "scripted_sensor.py"


def played(graph, fault, repeats):
    """What the scripted sensor measured, and all messages above OK meanwhile."""
    diagnostics = graph.watch("/diagnostics", DiagnosticArray)
    controller = graph.start("controller")
    graph.until(lambda: diagnostics, "the controller's reports, before anything is to be heard in them")
    bench = graph.run([sys.executable, str(BENCH), fault, str(repeats)])
    graph.until(lambda: bench.poll() is not None, "the end of the script")
    _, output = graph.ended(bench, by=None)
    graph.ended(controller)
    status = [each for message in diagnostics for each in message.status]
    return json.loads(output.splitlines()[-1]), [each for each in status if each.level != b"\x00"]


@pytest.mark.parametrize(
    ("fault", "text"),
    [
        ("zero", "outside the sensor's band"),
        ("five", "outside the sensor's band"),
        ("nan", "not finite"),
        ("frozen", "sensor frozen, shaft blocked or drive dead"),
        ("silence", "no Hall sample"),
    ],
)
def test_a_lost_angle_is_answered_with_duty_0_named_and_over_when_the_sensor_is_back(graph, fault, text):
    found, complaints = played(graph, fault, 1)
    assert all(each is not None for each in found["seconds"])
    assert all(found["returned"])
    told = [each for each in complaints if text in each.message and "duty 0" in each.message]
    assert any(each.level == b"\x02" and each.name.endswith("angle sensor") for each in told)
    assert {each.hardware_id for each in told} == {"pierburg"}


def test_single_spikes_do_not_swing_the_duty(graph):
    """By the lower quartile: samples that are held up swing the duty too, a spike let through always does."""
    found, _ = played(graph, "spikes", 1)
    assert len(found["swings"]) > 5
    assert statistics.quantiles(found["swings"])[0] < 0.3
    assert all(found["returned"])


def test_a_second_controller_stays_passive_and_takes_over(graph):
    from std_msgs.msg import Float64

    diagnostics = graph.watch("/diagnostics", DiagnosticArray)
    graph.watch("duty", Float64)
    first = graph.start("controller", arguments=("-r", "__node:=first"))
    graph.until(lambda: graph.node.count_publishers("duty") == 1, "the first controller")
    graph.start("controller", arguments=("-r", "__node:=second"))

    def said():
        return any(
            each.name == "second: duty" and "/first publishes duty" in each.message
            for message in diagnostics
            for each in message.status
        )

    graph.until(said, "the second one to say that it is passive")
    assert graph.node.count_publishers("duty") == 1
    graph.ended(first, signal.SIGTERM)
    names = lambda: [each.node_name for each in graph.node.get_publishers_info_by_topic("/duty")]  # noqa: E731
    graph.until(lambda: names() == ["second"], "the second one to take over")


def test_transitions_that_do_not_exist_are_refused_and_the_others_work(graph):
    from lifecycle_msgs.srv import ChangeState, GetState

    controller = graph.start("controller")
    graph.until(lambda: graph.node.count_publishers("duty") == 1, "the controller")

    def change(label):
        request = ChangeState.Request()
        request.transition.label = label
        return graph.call(ChangeState, "controller/change_state", request).success

    assert not change("activate")
    assert not change("nonsense")
    assert change("deactivate")
    graph.until(lambda: graph.node.count_publishers("duty") == 0, "no duties")
    assert change("activate")
    graph.until(lambda: graph.node.count_publishers("duty") == 1, "duties again")
    assert graph.call(GetState, "controller/get_state", GetState.Request()).current_state.label == "active"
    assert graph.ended(controller)[0] == 0
