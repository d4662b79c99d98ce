"""Trials over the ROS graph: what the nodes are told, and one recording by three processes."""

import csv
from dataclasses import replace

import numpy as np
import pytest

from pierburg_ros.errors import InputError
from pierburg_ros.processes import running
from pierburg_ros.proof import graph
from pierburg_ros.proof.concealment import draw_over_graph
from pierburg_ros.proof.plan import planned

TRIAL = replace(draw_over_graph("sensor_lag", 0, 3), duration=4.0, holdout_duration=2.0)


def test_graph_trials_are_closed_loop_without_a_loggers_converter():
    trial = draw_over_graph("backlash", 0, 3)
    assert trial.closed_loop and trial.over_graph and trial.converter_step == 0.0
    assert "outside" not in planned(3, over_graph=True).counts


def test_the_nodes_are_told_to_use_the_textbook_and_to_record_no_parameters(tmp_path):
    told = graph.settings(TRIAL, tmp_path / "a.mcap", tmp_path / "m.yaml", tmp_path / "s.csv", False)
    assert list(told) == ["recorder", "controller", "plant"]
    assert told["plant"]["formulation"] == "textbook" and told["plant"]["lockstep"] is True
    assert "parameter" not in str(told["recorder"]["topics"])
    assert told["plant"]["seed"] != graph.settings(TRIAL, *3 * [tmp_path], True)["plant"]["seed"]


def test_setpoints_are_written_where_they_change(tmp_path):
    graph.write_setpoints(tmp_path / "setpoints.csv", TRIAL, 4.0, holdout=False)
    rows = list(csv.DictReader((tmp_path / "setpoints.csv").open()))
    values = [float(row["setpoint"]) for row in rows]
    assert float(rows[0]["time"]) == 0.0
    assert len(values) > 1 and np.all(np.diff(values) != 0.0)


@pytest.mark.parametrize(("kind", "number"), planned(1, over_graph=True).names)
def test_the_controller_takes_the_setpoints_of_every_planned_trial(kind, number, tmp_path):
    trial = draw_over_graph(kind, number, 1)
    for holdout in (False, True):
        graph.write_setpoints(tmp_path / "setpoints.csv", trial, 20.0, holdout)
        values = [float(row["setpoint"]) for row in csv.DictReader((tmp_path / "setpoints.csv").open())]
        assert min(values) >= 0.0
        assert max(values) <= np.pi / 2


def test_a_node_that_ends_early_is_reported(tmp_path):
    with (
        pytest.raises(InputError, match="a node ended while"),
        running({"no such node": {}}, tmp_path / "a.log", {}) as nodes,
    ):
        nodes[0].wait(timeout=60.0)
        graph.wait_for(tmp_path / "a.mcap", 1.0, nodes)


@pytest.mark.ros
def test_three_processes_record_what_the_textbook_does(tmp_path):
    pytest.importorskip("rclpy")
    run = graph.record_over_graph(TRIAL, tmp_path / "train.mcap")
    assert run.time[-1] >= 4.0
    assert np.std(run.measured - run.ideal) == pytest.approx(TRIAL.noise, rel=0.1)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["train.mcap"]
