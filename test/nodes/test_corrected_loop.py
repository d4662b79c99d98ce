"""From a corrected model to a better loop, over the graph: the plant has the effect, the controller the tuned file."""

import math

import pytest
import yaml

pytest.importorskip("rclpy")

from std_msgs.msg import Float64

from pierburg_ros.cli.app import main
from pierburg_ros.processes import free_domain

TICKS = 500
START, TARGET = 0.3, 0.9
LAGGING = "actuator: pierburg\neffects: {sensor_lag: {time_constant: 0.009}}\n"


def hall(angle: float) -> float:
    """Hall voltage [V] of an angle [rad] of the nominal sensor."""
    return 0.42 + angle / (math.pi / 2) * 4.1


@pytest.fixture
def corrected(tmp_path):
    """The model file of a valve whose sensor lags, and the parameter file that is tuned for it."""
    model, controller = tmp_path / "model.yaml", tmp_path / "controller.yaml"
    model.write_text(LAGGING)
    with pytest.raises(SystemExit) as ended:
        arguments = ("--model", model, "-o", controller, "--generations", "0", "--members", "4", "--quiet")
        main(["tune", *map(str, arguments)])
    assert ended.value.code == 0
    return model, controller


def overshoot(graph, model, setpoints, *arguments) -> float:
    """By how much the Hall voltage goes beyond the target of a step, as a share of the step, in a run in lockstep."""
    sensed = graph.watch("hall_voltage", Float64)
    graph.start("plant", "lockstep:=true", "time_factor:=0", "command_timeout:=0", f"model:={model}")
    graph.until_connected()
    control = ("use_sim_time:=true", "hall_timeout:=0", f"setpoint_file:={setpoints}")
    graph.start("controller", *control, arguments=arguments)
    graph.until(lambda: len(sensed) > TICKS, "a run in lockstep")
    late = [message.data for message in sensed[-TICKS // 10 :]]
    assert max(abs(voltage - hall(TARGET)) for voltage in late) < 0.05
    return (max(message.data for message in sensed) - hall(TARGET)) / (hall(TARGET) - hall(START))


@pytest.mark.ros
def test_the_tuned_file_is_better_on_the_plant_that_has_the_effect(corrected, tmp_path):
    from support.ros_graph import Graph

    model, controller = corrected
    setpoints = tmp_path / "setpoints.csv"
    setpoints.write_text(f"time,setpoint\n0,{START}\n0.5,{TARGET}\n")
    # a domain for each: nobody is left from the run before
    with Graph(free_domain(), tmp_path) as graph:
        before = overshoot(graph, model, setpoints)
    with Graph(free_domain(), tmp_path) as graph:
        after = overshoot(graph, model, setpoints, "--params-file", str(controller))
    assert before > 0.05
    assert after < 0.02


@pytest.mark.ros
def test_the_tuned_file_loads_into_a_running_controller_under_any_name(corrected, graph):
    """As `ros2 param load` does it: every parameter of the file, one by one."""
    _, controller = corrected
    values = yaml.safe_load(controller.read_text())["/**"]["ros__parameters"]
    graph.start("controller", arguments=("-r", "__node:=throttle"))
    results = graph.set("throttle", **values)
    assert [result.reason for result in results if not result.successful] == []
    assert graph.get("throttle", "predictor_lag") == [0.009]
