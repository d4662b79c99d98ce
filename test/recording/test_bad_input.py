"""What cannot be read is refused in one line: found, expected, what to do."""

import numpy as np
import pytest
from support.tables import refusal

from pierburg_ros.errors import InputError
from pierburg_ros.recording import Channel, Recording, read_recording


def test_missing_file(tmp_path):
    assert refusal(tmp_path / "no.mcap").endswith("no.mcap does not exist, expected a recording. Check the path.")


def test_not_an_mcap(tmp_path):
    path = tmp_path / "notes.mcap"
    path.write_text("hello")
    assert refusal(path) == (
        "notes.mcap is not an MCAP file (its first bytes are others). Give an .mcap, a rosbag2 directory or a .csv."
    )


@pytest.mark.parametrize("content", [b"", b"\x89MCAP0\r\n"])
def test_empty_file(tmp_path, content):
    path = tmp_path / "empty.mcap"
    path.write_bytes(content)
    assert refusal(path).startswith("empty.mcap " + ("holds no messages" if content else "is not an MCAP file"))


def test_damaged_chunk(write_bag, run):
    path = write_bag(run(count=2000))
    content = bytearray(path.read_bytes())
    content[len(content) // 3 : len(content) // 3 + 400] = bytes(400)
    path.write_bytes(content)
    assert refusal(path).startswith("run.mcap is damaged after ")


def test_no_duty_topic(write_bag, run):
    assert refusal(write_bag(run(duty="/rosout"))) == (
        "run.mcap has no duty topic (found: /hall_voltage, /rosout). Name it with --topic duty=/your/topic;"
        " pierburg inspect says what each could be."
    )


def test_no_measured_topic(write_bag, run):
    assert refusal(write_bag(run(hall="/angle"))) == (
        "run.mcap has no measured signal topic (found: /angle, /duty). Name it with --topic hall_voltage=/your/topic;"
        " pierburg inspect says what each could be."
    )


def test_no_messages_at_all(write_bag):
    assert refusal(write_bag([], duty="float", hall_voltage="float")) == (
        "run.mcap holds no messages, expected a measured signal and what drove it. Record again."
    )


def test_no_messages_on_the_duty_topic(write_bag, run):
    messages = [item for item in run() if item.topic != "/duty"]
    assert refusal(write_bag(messages, duty="float")) == (
        "run.mcap has no messages on /duty, expected a duty. Name another with --topic duty=/your/topic."
    )


def test_two_topics_for_one_role(write_bag, run):
    both = write_bag(run() + run(hall="/recorded/hall_voltage", duty="/recorded/duty"))
    assert refusal(both) == (
        "run.mcap has 2 topics for hall_voltage (/hall_voltage, /recorded/hall_voltage), expected one."
        " Choose with --topic hall_voltage=/hall_voltage."
    )
    chosen = read_recording(both, topics={"hall_voltage": "/recorded/hall_voltage"})
    assert chosen.command.values.size == 50


def test_a_named_topic_that_is_not_there(write_bag, run):
    assert refusal(write_bag(run()), topics={"duty": "/pwm"}) == (
        "run.mcap has no topic /pwm for duty (found: /duty, /hall_voltage). Name one of those."
    )


def test_an_unknown_role(write_bag, run):
    assert refusal(write_bag(run()), topics={"volume": "/duty"}).startswith(
        "--topic found the unknown signal volume, expected one of duty, applied_duty, current, torque, hall"
    )


def test_wrong_message_type(write_bag, run):
    messages = [item._replace(kind="text", value="0.1") if item.topic == "/duty" else item for item in run()]
    assert refusal(write_bag(messages)) == (
        "run.mcap: /duty is a std_msgs/msg/String, expected std_msgs/msg/Float64."
        " Name another with --topic duty=/your/topic."
    )


@pytest.mark.parametrize("bad", [float("nan"), float("inf")])
@pytest.mark.parametrize("topic", ["/hall_voltage", "/duty"])
def test_samples_that_are_not_finite(write_bag, run, bad, topic):
    messages = run()
    place = next(k for k, item in enumerate(messages) if item.topic == topic and item.sequence == 20)
    messages[place] = messages[place]._replace(value=bad)
    time = "0.200" if topic == "/hall_voltage" else "0.201"
    assert refusal(write_bag(messages)) == (
        f"run.mcap: {topic} has samples that are NaN or infinite (1 of 50, first at {time} s), expected"
        " finite numbers. Cut or repair the recording there."
    )


def test_a_clock_that_runs_backwards(write_bag, run):
    messages = [item._replace(publish=item.publish - 0.3 * (k >= 60), log=item.log) for k, item in enumerate(run())]
    assert refusal(write_bag(messages)) == (
        "run.mcap: /hall_voltage has a clock running backwards by 0.29 s after 30 messages (publish time),"
        " expected times that never decrease. Cut the recording there, or choose another clock with"
        " --time {stamp,clock,publish,log}."
    )


def test_one_sample(write_bag, run):
    assert refusal(write_bag(run(count=1))) == (
        "run.mcap spans no time (1 samples of hall_voltage), expected two samples or more at different times."
        " Record longer."
    )


def test_duty_in_percent(write_bag, run):
    messages = [item._replace(value=24.0) if item.topic == "/duty" else item for item in run()]
    assert refusal(write_bag(messages)).startswith(
        "run.mcap: found a duty of magnitude 24, expected a fraction within [-1, 1]. Divide percentages by"
    )


def test_an_unknown_clock(write_bag, run):
    assert refusal(write_bag(run()), time="wall") == (
        "--time found 'wall', expected one of stamp, clock, publish, log. Choose one of those."
    )


def test_a_folder_that_is_no_recording(tmp_path):
    assert refusal(tmp_path).endswith(
        "is a folder without metadata.yaml (0 MCAP files), expected a rosbag2 directory. Name one of its files."
    )


def test_metadata_that_lists_nothing(tmp_path):
    (tmp_path / "metadata.yaml").write_text("rosbag2_bagfile_information: 3\n")
    assert "metadata.yaml does not list the files of a rosbag2 recording" in refusal(tmp_path)


def test_metadata_that_lists_a_file_that_is_gone(tmp_path):
    (tmp_path / "metadata.yaml").write_text("rosbag2_bagfile_information: {relative_file_paths: [a_0.mcap]}\n")
    assert "metadata.yaml lists a_0.mcap, which does not exist" in refusal(tmp_path)


def test_a_recording_validates_itself():
    held = Channel(np.zeros(1), np.zeros(1))
    with pytest.raises(InputError, match="found quantity 'weight', expected one of hall_voltage, position, speed"):
        Recording("made", "weight", np.arange(3.0), np.zeros(3), held)
    with pytest.raises(InputError, match=r"made: hall_voltage has a clock running backwards at 1\.000 s"):
        Recording("made", "hall_voltage", np.array([0.0, 1.0, 0.5]), np.zeros(3), held)
    with pytest.raises(InputError, match="a channel has 2 times and 1 values"):
        Channel(np.zeros(2), np.zeros(1))
