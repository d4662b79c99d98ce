"""What is written reads back the same, here and with rosbags, and is whole or not there."""

import numpy as np
import pytest
from mcap.reader import make_reader
from rosbags.highlevel import AnyReader

from pierburg_ros.errors import InputError
from pierburg_ros.recording import Channel, read_recording, write_recording, write_simulated

TIME = 0.002 * np.arange(400)
HALL = 0.42 + 0.01 * np.arange(400)
DUTY = np.sin(TIME)
FLOAT = "std_msgs/msg/Float64"


def test_a_simulated_run_reads_back(tmp_path):
    setpoints = Channel(np.array([0.0, 0.3]), np.array([0.1, 0.9]))
    write_simulated(tmp_path / "run.mcap", TIME, DUTY, HALL, setpoints)
    recording = read_recording(tmp_path / "run.mcap")
    np.testing.assert_allclose(recording.time, TIME, atol=1e-9)
    np.testing.assert_array_equal(recording.measured, HALL)
    np.testing.assert_allclose(recording.command.time, TIME, atol=1e-9)
    np.testing.assert_array_equal(recording.command.values, DUTY)
    np.testing.assert_array_equal(recording.setpoints.values, setpoints.values)


def test_a_position_and_an_earlier_duty_read_back(tmp_path):
    duty = Channel(np.array([-0.5, 0.1]), np.array([0.3, -0.3]))
    write_simulated(tmp_path / "run.mcap", TIME, duty, HALL, quantity="position")
    recording = read_recording(tmp_path / "run.mcap")
    assert recording.quantity == "position"
    np.testing.assert_array_equal(recording.measured, HALL)
    np.testing.assert_allclose(recording.command.time, duty.time, atol=1e-9)


@pytest.mark.parametrize("as_directory", [False, True])
def test_rosbags_opens_it(tmp_path, as_directory):
    signals = {
        "/hall_voltage": (FLOAT, TIME, HALL),
        "/enabled": ("std_msgs/msg/Bool", [0.0, 0.1], [1, 0]),
        "/joint_states": ("sensor_msgs/msg/JointState", TIME, HALL),
        "/duty": (FLOAT, TIME, DUTY),
    }
    path = tmp_path / ("run" if as_directory else "run.mcap")
    write_recording(path, signals, as_directory=as_directory)
    with AnyReader([path]) as reader:
        found: dict[str, list] = {topic: [] for topic in signals}
        for connection, time, data in reader.messages():
            found[connection.topic].append((time, reader.deserialize(data, connection.msgtype)))
    assert [time for time, _ in found["/duty"]] == np.round(TIME * 1e9).astype(int).tolist()
    assert [message.data for _, message in found["/duty"]] == DUTY.tolist()
    assert [message.data for _, message in found["/enabled"]] == [True, False]
    joint = found["/joint_states"][150][1]
    assert joint.name == ["swirl_shaft"] and joint.position.tolist() == [HALL[150]]
    assert joint.header.stamp.nanosec == 300_000_000
    assert read_recording(path).measured.tolist() == HALL.tolist()


def test_the_file_is_what_ros2_tools_expect(tmp_path):
    write_recording(tmp_path / "run.mcap", {"/hall_voltage": (FLOAT, TIME, HALL), "/duty": (FLOAT, TIME, DUTY)})
    with (tmp_path / "run.mcap").open("rb") as stream:
        reader = make_reader(stream, validate_crcs=True)
        summary = reader.get_summary()
        messages = list(reader.iter_messages())
        assert reader.get_header().profile == "ros2"
    assert {schema.encoding for schema in summary.schemas.values()} == {"ros2msg"}
    assert {channel.message_encoding for channel in summary.channels.values()} == {"cdr"}
    assert all("reliability: reliable" in c.metadata["offered_qos_profiles"] for c in summary.channels.values())
    assert [chunk.compression for chunk in summary.chunk_indexes] == ["zstd"]
    assert [channel.topic for _, channel, _ in messages[:4]] == ["/hall_voltage", "/duty"] * 2
    assert [message.sequence for _, channel, message in messages if channel.topic == "/duty"] == list(range(400))
    assert all(message.publish_time == message.log_time for _, _, message in messages)


def test_a_failure_leaves_nothing(tmp_path):
    with pytest.raises(InputError, match="found message type std_msgs/msg/String, expected"):
        write_recording(tmp_path / "run.mcap", {"/rosout": ("std_msgs/msg/String", [0.0], [1.0])})
    assert list(tmp_path.iterdir()) == []


def test_an_existing_directory_is_not_written_over(tmp_path):
    with pytest.raises(InputError, match=r"exists, expected a new rosbag2 directory\. Choose another name"):
        write_recording(tmp_path, {"/duty": (FLOAT, TIME, DUTY)}, as_directory=True)
