"""How far a node started by `pierburg run` looks for others."""

import os
from types import SimpleNamespace

import pytest

from pierburg_ros.cli import run as command
from pierburg_ros.errors import InputError


def started(monkeypatch, environment, node="monitor"):
    """Environment in which `pierburg run` starts a node, given that of its user."""
    seen = []
    monkeypatch.setattr(os, "environ", dict(environment))
    monkeypatch.setattr(command, "require_ros", lambda: None)
    module = SimpleNamespace(main=lambda: seen.append(dict(os.environ)))
    monkeypatch.setattr(command, "import_module", lambda name: module)
    monkeypatch.setattr("sys.argv", ["pierburg"])
    command.run(SimpleNamespace(args=[]), node)
    return seen[0]


def test_a_node_stays_on_this_machine_by_default(monkeypatch):
    assert started(monkeypatch, {})["ROS_AUTOMATIC_DISCOVERY_RANGE"] == "LOCALHOST"


def test_a_setting_of_the_user_wins(monkeypatch):
    given = {"ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET"}
    assert started(monkeypatch, given)["ROS_AUTOMATIC_DISCOVERY_RANGE"] == "SUBNET"


def test_a_node_that_does_not_exist_is_refused_with_those_that_do(monkeypatch):
    with pytest.raises(InputError, match="monitor, serial_driver"):
        started(monkeypatch, {}, "actuator")
