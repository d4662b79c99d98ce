"""The recorder as a process: what stands in its files, however it ends."""

import signal
import time
from collections import Counter
from contextlib import suppress
from pathlib import Path

import pytest

pytest.importorskip("rclpy")

import yaml
from mcap.exceptions import EndOfFile
from mcap.reader import make_reader
from mcap.records import Channel, Message
from mcap.stream_reader import StreamReader
from rclpy.duration import Duration
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rosbags.highlevel import AnyReader
from rosbags.rosbag2 import Reader
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Imu
from std_msgs.msg import Bool, Float64, String
from std_srvs.srv import SetBool, Trigger
from support.ros_graph import DEADLINE

from pierburg_ros.nodes.graph.qos import STATE

pytestmark = pytest.mark.ros


def messages(path):
    """(topic, message) of a recording, as any rosbags user reads it: types from the file itself."""
    with AnyReader([Path(path)]) as reader:
        return [(c.topic, reader.deserialize(data, c.msgtype)) for c, _, data in reader.messages()]


def values(path, topic="/duty"):
    """Numbers recorded on one topic, in the order of the file."""
    return [message.data for name, message in messages(path) if name == topic]


def so_far(path):
    """Numbers of messages by topic in a file that may have no end yet."""
    topics, counts = {}, Counter()
    with path.open("rb") as stream, suppress(EndOfFile):
        for record in StreamReader(stream).records:
            if isinstance(record, Channel):
                topics[record.id] = record.topic
            elif isinstance(record, Message):
                counts[topics[record.channel_id]] += 1
    return counts


def recorder(graph, *parameters):
    """A running recorder that already reads `duty`."""
    process = graph.start("recorder", *parameters)
    graph.publisher = graph.node.create_publisher(Float64, "duty", 1000)
    graph.until(lambda: graph.publisher.get_subscription_count() > 0, "the recorder")
    graph.until(lambda: any(graph.folder.rglob("*.mcap")), "its file")
    return process


def send(graph, numbers):
    """Publish numbers on `duty` one after another."""
    for number in numbers:
        graph.publisher.publish(Float64(data=float(number)))
    assert graph.publisher.wait_for_all_acked(Duration(seconds=DEADLINE))


@pytest.mark.parametrize("by", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_completes_the_file(graph, by):
    process = recorder(graph, "output:=run.mcap")
    send(graph, range(200))
    status, output = graph.ended(process, by)
    assert status == 0
    assert "Traceback" not in output
    assert values(graph.folder / "run.mcap") == list(range(200))


def test_publish_time_is_the_senders_and_log_time_the_arrival(graph):
    process = recorder(graph, "output:=run.mcap")
    before = time.time_ns()
    send(graph, range(20))
    after = time.time_ns()
    graph.ended(process)
    with (graph.folder / "run.mcap").open("rb") as stream:
        found = [m for _, c, m in make_reader(stream).iter_messages() if c.topic == "/duty"]
    assert [m.sequence for m in found] == list(range(1, 21))
    assert all(before <= m.publish_time <= after for m in found)
    assert all(m.publish_time <= m.log_time for m in found)


def test_channels_carry_profile_schema_and_quality_of_service(graph):
    process = recorder(graph, "output:=run.mcap")
    send(graph, [0.5])
    graph.ended(process)
    with (graph.folder / "run.mcap").open("rb") as stream:
        reader = make_reader(stream)
        summary = reader.get_summary()
        assert reader.get_header().profile == "ros2"
    channel = next(c for c in summary.channels.values() if c.topic == "/duty")
    schema = summary.schemas[channel.schema_id]
    assert (schema.name, schema.encoding) == ("std_msgs/msg/Float64", "ros2msg")
    assert b"float64 data" in schema.data
    offered = yaml.safe_load(channel.metadata["offered_qos_profiles"])
    assert offered[0]["reliability"] == "reliable"
    assert channel.metadata["topic_type_hash"].startswith("RIHS01_")


def test_what_was_sent_comes_to_disk_by_itself_and_outlasts_a_kill(graph):
    process = recorder(graph, "output:=run.mcap")
    path = graph.folder / "run.mcap"
    sent = 0

    def grown():
        nonlocal sent
        send(graph, range(sent, sent + 200))
        sent += 200
        return path.exists() and path.stat().st_size > 20_000

    graph.until(grown, "messages on disk")
    graph.until(lambda: so_far(path)["/duty"] == sent, "all of them, without another message")
    send(graph, [-1.0])
    process.kill()
    graph.ended(process, by=None)
    assert so_far(path)["/duty"] >= sent


def test_record_and_split(graph):
    process = recorder(graph, "output:=run.mcap")
    send(graph, range(10))
    split = graph.call(Trigger, "recorder/split", Trigger.Request())
    assert split.success
    assert split.message.endswith("run_1.mcap")
    send(graph, range(10, 20))
    assert graph.call(SetBool, "recorder/record", SetBool.Request(data=False)).success
    send(graph, range(20, 30))
    assert graph.call(SetBool, "recorder/record", SetBool.Request(data=True)).success
    send(graph, range(30, 40))
    graph.ended(process)
    found = [values(graph.folder / name) for name in ("run.mcap", "run_1.mcap", "run_2.mcap")]
    assert found == [list(range(10)), list(range(10, 20)), list(range(30, 40))]


def test_a_rosbag2_directory_reads_with_its_metadata(graph):
    process = recorder(graph, "output:=bag", "form:=rosbag2")
    send(graph, range(10))
    graph.call(Trigger, "recorder/split", Trigger.Request())
    send(graph, range(10, 20))
    graph.ended(process)
    with Reader(graph.folder / "bag") as reader:
        duty = [c for c in reader.connections if c.topic == "/duty"]
        assert len(list(reader.messages(duty))) == 20
    assert values(graph.folder / "bag") == list(range(20))


def test_any_installed_type_and_the_past_of_latched_topics(graph):
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL, reliability=ReliabilityPolicy.RELIABLE)
    graph.node.create_publisher(String, "description", latched).publish(String(data="a valve"))
    best_effort = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
    imu = graph.node.create_publisher(Imu, "imu", best_effort)
    process = graph.start("recorder", "output:=run.mcap", "topics:=[imu, description]")
    graph.until(lambda: imu.get_subscription_count() > 0, "a reader of imu")
    path = graph.folder / "run.mcap"

    def recorded():
        imu.publish(Imu(orientation_covariance=[1.0] * 9))
        return {"/imu", "/description"} <= so_far(path).keys()

    graph.until(recorded, "a message of both")
    graph.ended(process)
    found = messages(graph.folder / "run.mcap")
    assert [m.data for topic, m in found if topic == "/description"] == ["a valve"]
    assert next(m for topic, m in found if topic == "/imu").orientation_covariance[0] == 1.0


def test_a_bridge_that_was_open_before_is_recorded_as_open(graph):
    graph.node.create_publisher(Bool, "enabled", STATE).publish(Bool(data=False))
    process = recorder(graph, "output:=run.mcap")
    path = graph.folder / "run.mcap"
    graph.until(lambda: path.exists() and so_far(path)["/enabled"], "the state of the bridge")
    graph.ended(process)
    assert values(path, "/enabled") == [False]


def test_parameter_values_stand_in_the_file_for_people(graph):
    process = recorder(graph, "output:=run.mcap")
    graph.start("plant", "armature_resistance:=4.5")
    notes = graph.folder / "run.mcap"
    graph.until(lambda: so_far(notes)["/recorder/parameters"], "the parameter values")
    graph.ended(process)
    text = next(m.data for topic, m in messages(notes) if topic == "/recorder/parameters")
    assert yaml.safe_load(text)["plant"]["ros__parameters"]["armature_resistance"] == 4.5


def test_in_simulated_time_both_times_are_simulated(graph):
    process = recorder(graph, "output:=run.mcap", "use_sim_time:=true")
    clock = graph.node.create_publisher(Clock, "/clock", 1000)
    graph.until(lambda: clock.get_subscription_count() > 1, "readers of the clock")
    for tick in range(1, 50):
        reading = Clock()
        reading.clock.nanosec = tick * 1_000_000
        clock.publish(reading)
        graph.publisher.publish(Float64(data=float(tick)))
    assert clock.wait_for_all_acked(Duration(seconds=DEADLINE))
    assert graph.publisher.wait_for_all_acked(Duration(seconds=DEADLINE))
    graph.ended(process)
    with (graph.folder / "run.mcap").open("rb") as stream:
        found = [m for _, c, m in make_reader(stream).iter_messages() if c.topic == "/duty"]
    assert [m.log_time for m in found] == [tick * 1_000_000 for tick in range(1, 50)]
    assert [m.publish_time for m in found] == [m.log_time for m in found]


def test_nothing_is_overwritten(graph):
    (graph.folder / "run.mcap").write_text("precious")
    status, output = graph.ended(graph.start("recorder", "output:=run.mcap"), by=None)
    assert status == 2
    assert output.strip().endswith("run.mcap exists and is not overwritten; choose another output.")
    assert (graph.folder / "run.mcap").read_text() == "precious"
