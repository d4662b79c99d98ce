"""Bags of a robot under ros2_control: the map that is drafted reads them as written, one joint from each topic."""

import numpy as np
import pytest
import yaml
from rosbags.rosbag2 import StoragePlugin
from support.ros2_control_bags import RATE, TOPICS, motion, write_arm

from pierburg_ros.recording import read_recording
from pierburg_ros.recording.inspection import inspect

ELBOW = motion()["elbow"]
"""The joint that moves furthest."""


def drafted(folder, *topics, plugin=StoragePlugin.MCAP):
    """The recording of some topics by the map that is drafted of them, and the map."""
    bag = write_arm(folder / "bag", *topics, plugin=plugin)
    text = inspect(bag).signals
    (folder / "drafted.yaml").write_text(text)
    return read_recording(bag, signals=folder / "drafted.yaml"), yaml.safe_load(text)


def check(recording, torque):
    """Whether it is the elbow's motion, on the stamps of the messages."""
    assert (recording.quantity, recording.input, recording.time_source) == ("position", "torque", "stamp")
    np.testing.assert_allclose(recording.time, np.arange(recording.time.size) / RATE, atol=1e-6)
    np.testing.assert_array_equal(recording.measured, ELBOW["position"])
    np.testing.assert_array_equal(recording.command.values, ELBOW[torque])


@pytest.mark.parametrize("plugin", [StoragePlugin.MCAP, StoragePlugin.SQLITE3])
@pytest.mark.parametrize(
    ("topic", "torque"),
    [
        ("/joint_states", "effort"),
        ("/dynamic_joint_states", "effort"),
        ("/arm_controller/controller_state", "command"),
        ("/pid_controller/controller_state", "command"),
    ],
)
def test_each_topic_with_torque_and_angle_is_read_by_its_draft(tmp_path, topic, torque, plugin):
    recording, _ = drafted(tmp_path, topic, plugin=plugin)
    check(recording, torque)


@pytest.mark.parametrize("state", ["/arm_controller/controller_state", "/pid_controller/controller_state"])
def test_the_reference_of_a_controller_is_the_setpoint(tmp_path, state):
    recording, _ = drafted(tmp_path, state)
    np.testing.assert_array_equal(recording.setpoints.values, ELBOW["reference"])


def test_all_topics_together_are_read_by_their_draft(tmp_path):
    recording, chosen = drafted(tmp_path, *TOPICS)
    check(recording, "command")
    assert set(chosen) == {"torque", "position", "setpoints"}


@pytest.mark.parametrize(
    ("topic", "signal", "like"),
    [
        ("/controller/commands", "torque", "effort[elbow]"),
        ("/forward_position_controller/commands", "setpoints", "position[elbow]"),
    ],
)
def test_commands_without_names_are_the_joint_that_they_are_like(tmp_path, topic, signal, like):
    bag = write_arm(tmp_path / "bag", "/joint_states", topic)
    fields = {each.path: each.could_be for each in next(t for t in inspect(bag).topics if t.name == topic).fields}
    assert fields["data[0]"].startswith(f"like {like} of /joint_states: {signal}")
    assert fields["data[1]"].startswith(f"like {like.replace('elbow', 'shoulder')} of /joint_states: {signal}")


def test_what_is_wanted_of_a_speed_what_is_wrong_and_what_only_scales_is_no_signal(tmp_path):
    (topic,) = inspect(write_arm(tmp_path / "bag", "/arm_controller/controller_state")).topics
    fields = {each.path: each.could_be for each in topic.fields}
    for path in ("reference.velocities[elbow]", "reference.accelerations[elbow]", "error.positions[elbow]"):
        assert fields[path] is None
    assert fields["speed_scaling_factor"] is None


def test_the_draft_is_of_the_joint_that_moves_furthest_and_says_so(tmp_path):
    text = inspect(write_arm(tmp_path / "bag", *TOPICS)).signals
    assert "# Of the joints it is elbow, which moves furthest" in text
    assert "[shoulder]" not in text
