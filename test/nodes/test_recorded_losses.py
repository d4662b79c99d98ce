"""What the recorder says of losses is what happened, and a file ends after what was sent before it was to end."""

import signal
from collections import Counter

import pytest

pytest.importorskip("rclpy")

from mcap.reader import make_reader
from rclpy.duration import Duration
from std_msgs.msg import Float64
from std_srvs.srv import SetBool
from support.ros_graph import DEADLINE

from pierburg_ros.recording.loss import LOSSES

pytestmark = pytest.mark.ros


def contents(path):
    """Numbers of `/duty` in the order of the file, how many messages by topic, and the note of all losses."""
    with path.open("rb") as stream:
        reader = make_reader(stream)
        found = [(m.sequence, c.topic) for _, c, m in reader.iter_messages(log_time_order=False)]
        note = next(m.metadata for m in reader.iter_metadata() if m.name == LOSSES)
    return [number for number, topic in found if topic == "/duty"], Counter(topic for _, topic in found), note


def test_publishers_that_come_and_go_have_lost_nothing_and_the_note_matches_the_contents(graph):
    process = graph.start("recorder", "output:=run.mcap")
    path = graph.folder / "run.mcap"
    sent = 0

    def publisher():
        made = graph.node.create_publisher(Float64, "duty", 10_000)
        graph.until(lambda: made.get_subscription_count() > 0, "the recorder")
        return made

    def send(*publishers, times=1):
        nonlocal sent
        for number in range(times):
            for each in publishers:
                each.publish(Float64(data=float(number)))
                sent += 1
        assert all(each.wait_for_all_acked(Duration(seconds=DEADLINE)) for each in publishers)

    lasting, second = publisher(), publisher()
    send(lasting, second, times=50)
    send(lasting, times=300)
    for _ in range(4):
        graph.node.destroy_publisher(second)
        second = publisher()
        send(second, lasting, times=100)
    answer = graph.call(SetBool, "recorder/record", SetBool.Request(data=False))
    graph.ended(process)
    numbers, counts, note = contents(path)
    assert counts["/duty"] == sent
    assert numbers == list(range(1, sent + 1))
    assert note == {topic: f"0 of {count}" for topic, count in counts.items()}
    assert f"{sum(counts.values())} messages, 0 lost" in answer.message


def test_what_was_sent_before_the_call_is_in_the_file(graph):
    """The recorder stands still while more is sent than fits on the way to it, and is then told to end the file."""
    process = graph.start("recorder", "output:=run.mcap")
    publisher = graph.node.create_publisher(Float64, "duty", 20_000)
    graph.until(lambda: publisher.get_subscription_count() > 0, "the recorder")
    client = graph.node.create_client(SetBool, "recorder/record")
    graph.until(client.service_is_ready, "the recorder's services")
    for number in range(8000):
        if number == 100:
            assert publisher.wait_for_all_acked(Duration(seconds=DEADLINE))
            process.send_signal(signal.SIGSTOP)
        publisher.publish(Float64(data=float(number)))
    answer = client.call_async(SetBool.Request(data=False))
    process.send_signal(signal.SIGCONT)

    def answered():
        publisher.publish(Float64(data=-1.0))
        return answer.done()

    graph.until(answered, "an answer")
    assert answer.result().success
    graph.ended(process)
    numbers, counts, note = contents(graph.folder / "run.mcap")
    assert counts["/duty"] >= 8000
    assert numbers == list(range(1, counts["/duty"] + 1))
    assert note["/duty"] == f"0 of {counts['/duty']}"
    assert "0 lost" in answer.result().message
