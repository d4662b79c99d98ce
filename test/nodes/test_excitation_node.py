"""The excitation as a process: a file played to a plant, and what it says without one."""

import sys

import numpy as np
import pytest

pytest.importorskip("rclpy")

from std_msgs.msg import Float64

from pierburg_ros.recording import read_recording

pytestmark = pytest.mark.ros


def test_a_duty_file_is_played_once_and_ends_with_duty_0(graph):
    (graph.folder / "duty.csv").write_text("time,duty\n0,0\n0.3,0.24\n0.8,0.1\n1.2,0.1\n")
    graph.watch("duty", Float64)
    graph.start("plant", "rate:=100.0", "lockstep:=true", "time_factor:=0.0")  # no level is missed on a busy machine
    excitation = graph.start("excitation", "duty_file:=duty.csv", "patience:=60.0", "use_sim_time:=true")
    status, output = graph.ended(excitation, by=None)
    assert status == 0, output
    played = graph.received["duty"]
    graph.until(lambda: played and played[-1].data == 0.0 and len(played) > 100, "the last duty")
    levels = [message.data for message in played]
    assert list(dict.fromkeys(levels)) == [0.0, 0.24, 0.1]
    assert 115 <= len(levels) <= 130


def test_without_a_plant_it_says_so_in_one_line(graph):
    (graph.folder / "duty.csv").write_text("time,duty\n0,0\n1,0\n")
    status, output = graph.ended(graph.start("excitation", "duty_file:=duty.csv", "patience:=1.0"), by=None)
    assert status == 2
    assert "No Hall sample came for 1 s" in output
    assert "Traceback" not in output


def test_an_experiment_over_the_graph_records_what_it_played(graph):
    graph.start("plant", "rate:=200.0")
    code = "from pierburg_ros.cli.app import main; main()"
    command = ["experiment", "random_steps", "--duration", "5", "--graph", "--output", "out"]
    status, output = graph.ended(graph.run([sys.executable, "-c", code, *command]), by=None)
    assert status == 0, output
    recording = read_recording(graph.folder / "out/random_steps.mcap")
    assert recording.duration > 4.5
    assert np.ptp(recording.measured) > 0.5
