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
FROM_THE_STOP = math.radians(20.0)
LAGGING = "sensor_lag: {time_constant: 0.009}"
RUBBING = "load_dependent_friction: {coefficient: 0.2}"


def hall(angle: float) -> float:
    """Hall voltage [V] of an angle [rad] of the nominal sensor."""
    return 0.42 + angle / (math.pi / 2) * 4.1


def tuned(effect, tmp_path):
    """The model file of a valve with an effect, and the parameter file that is tuned for it."""
    model, controller = tmp_path / "model.yaml", tmp_path / "controller.yaml"
    model.write_text(f"actuator: pierburg\neffects: {{{effect}}}\n")
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


def load(graph, node, file):
    """Load a parameter file into a running node as `ros2 param load` does it: every parameter, one by one."""
    values = yaml.safe_load(file.read_text())["/**"]["ros__parameters"]
    assert [result.reason for result in graph.set(node, **values) if not result.successful] == []


def on_the_way(graph, model, file=None) -> int:
    """Samples between closed stop and target of a step, in lockstep; `file` goes into the running controller."""
    sensed = graph.watch("hall_voltage", Float64)
    graph.start("controller", "use_sim_time:=true", "hall_timeout:=0", "setpoint:=0.0")
    if file is not None:
        load(graph, "controller", file)
    graph.start("plant", "lockstep:=true", "time_factor:=0", "command_timeout:=0", f"model:={model}")
    margin = hall(math.radians(0.5)) - hall(0.0)
    graph.until(lambda: sensed, "the closed stop")  # only what hears the plant hears the whole step
    graph.publish("setpoints", Float64(data=FROM_THE_STOP))
    graph.until(lambda: sensed[-1].data > hall(FROM_THE_STOP) - margin, "the target")
    arrived = len(sensed)
    graph.until(lambda: len(sensed) > arrived + TICKS, "what follows")
    assert abs(sensed[-1].data - hall(FROM_THE_STOP)) < margin
    return sum(hall(0.0) + margin < message.data < hall(FROM_THE_STOP) - margin for message in sensed)


def before_and_after(tmp_path, measured, *given, tuned):
    """What is `measured` of a loop that is `given`, without and with what was `tuned`."""
    from support.ros_graph import Graph

    found = []
    for more in ((), tuned):
        # a domain for each: nobody is left from the run before
        with Graph(free_domain(), tmp_path) as graph:
            found.append(measured(graph, *given, *more))
    return found


@pytest.mark.ros
def test_a_schedule_is_better_on_the_plant_whose_friction_grows_with_the_load(tmp_path):
    """Nothing late, so the file schedules the load: the step no longer waits for the integrator."""
    model, controller = tuned(RUBBING, tmp_path)
    before, after = before_and_after(tmp_path, on_the_way, model, tuned=(controller,))
    assert 0 < after < 0.75 * before


@pytest.mark.ros
def test_the_tuned_file_is_better_on_the_plant_that_has_the_effect(tmp_path):
    model, controller = tuned(LAGGING, tmp_path)
    setpoints = tmp_path / "setpoints.csv"
    setpoints.write_text(f"time,setpoint\n0,{START}\n0.5,{TARGET}\n")
    before, after = before_and_after(tmp_path, overshoot, model, setpoints, tuned=("--params-file", str(controller)))
    assert before > 0.05
    assert after < 0.02


@pytest.mark.ros
def test_the_tuned_file_loads_into_a_running_controller_under_any_name(tmp_path, graph):
    _, controller = tuned(LAGGING, tmp_path)
    graph.start("controller", arguments=("-r", "__node:=throttle"))
    load(graph, "throttle", controller)
    assert graph.get("throttle", "predictor_lag") == [0.009]
