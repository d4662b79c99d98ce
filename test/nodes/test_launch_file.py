"""What the launch file starts, as processes with the arguments that it passes."""

import sys

import pytest

pytest.importorskip("rclpy")

from sensor_msgs.msg import JointState
from std_msgs.msg import Float64
from support.launch_file import command_line, launched

from pierburg_ros.recording import read_recording

pytestmark = pytest.mark.ros


def start(graph, **given):
    """The processes of one launch."""
    _, nodes = launched(**given)
    codes = [f"from pierburg_ros.nodes.{node['executable']} import main; main()" for node in nodes]
    arguments = [command_line(node) for node in nodes]
    return [graph.run([sys.executable, "-c", *each]) for each in map(lambda c, a: [c, *a], codes, arguments)]


def test_two_actuators_in_two_namespaces_keep_their_own_joints_setpoints_and_recordings(graph):
    wanted = {"left": 0.4, "right": 1.2}
    joints = {side: graph.watch(f"/{side}/joint_states", JointState) for side in wanted}
    duties = {side: graph.watch(f"/{side}/active_setpoint", Float64) for side in wanted}
    processes = {
        side: start(graph, namespace=side, setpoint=str(angle), output=f"{side}.mcap") for side, angle in wanted.items()
    }

    def arrived(side, angle):
        """Six seconds after its first sample too: a recorder may know the plant later than this process does."""
        return len(joints[side]) > 3000 and duties[side] and abs(joints[side][-1].position[0] - angle) < 0.05

    graph.until(lambda: all(arrived(*each) for each in wanted.items()), "both shafts at their setpoints")
    for side, angle in wanted.items():
        assert joints[side][-1].name == [f"{side}_swirl_shaft"]
        assert duties[side][-1].data == angle
        for process in reversed(processes[side]):
            status, _ = graph.ended(process)
            assert status == 0
        recording = read_recording(graph.folder / f"{side}.mcap")
        assert recording.losses == ()
        assert recording.quantity == "hall_voltage"
