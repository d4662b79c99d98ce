"""The recorder when the disk does not take what it writes, and beside a source of time that waits for it."""

import resource
import signal
import sys
from threading import Event
from types import SimpleNamespace

import pytest

pytest.importorskip("rclpy")

from diagnostic_msgs.msg import DiagnosticArray
from mcap.reader import make_reader
from rclpy.duration import Duration
from rosbags.rosbag2 import Reader
from rosgraph_msgs.msg import Clock
from std_msgs.msg import Float64
from std_srvs.srv import SetBool, Trigger
from support.ros_graph import DEADLINE

from pierburg_ros.nodes.graph import messages
from pierburg_ros.nodes.recording.held_back import HeldBack
from pierburg_ros.recording.formats.recover import is_whole, recover
from pierburg_ros.recording.loss import LOSSES

pytestmark = pytest.mark.ros
FULL = 30_000
"""Bytes after which no file grows, as on a full disk; fewer than a recorder wants to begin with."""


def limited(process, size):
    """Let no file of a process grow beyond `size`, or any again."""
    resource.prlimit(process.pid, resource.RLIMIT_FSIZE, (size, resource.RLIM_INFINITY))


def recorder(graph, *parameters):
    """A running recorder that reads `duty`."""
    process = graph.start("recorder", "flush_interval:=0.02", *parameters)
    graph.publisher = graph.node.create_publisher(Float64, "duty", 10_000)
    graph.until(lambda: graph.publisher.get_subscription_count() > 0, "the recorder")
    graph.until(lambda: any(graph.folder.rglob("*.mcap")), "its file")
    return process


def send(graph, numbers):
    """Publish numbers on `duty` one after another."""
    for number in numbers:
        graph.publisher.publish(Float64(data=float(number)))
    assert graph.publisher.wait_for_all_acked(Duration(seconds=DEADLINE))


def told(graph):
    """What the recorder says of itself on `/diagnostics`: level, text and values of each report."""
    reports = graph.watch("/diagnostics", DiagnosticArray)

    def found():
        return [
            (status.level, status.message, {v.key: v.value for v in status.values})
            for report in reports
            for status in report.status
            if status.name.startswith("recorder")
        ]

    return found


def fill(graph, reports, numbers):
    """Send until the recorder says that its file is cut."""

    def cut():
        send(graph, [next(numbers) for _ in range(500)])
        return any("is cut" in text for _, text, _ in reports())

    graph.until(cut, "the end of the disk")


def counted():
    """1, 2, 3 and so on."""
    yield from range(1, 10**9)


def test_a_full_disk_is_said_at_once_the_file_marked_and_the_error_over_when_there_is_room(graph):
    reports = told(graph)
    process = recorder(graph, "output:=run.mcap")
    limited(process, FULL)
    fill(graph, reports, counted())
    answer = graph.call(SetBool, "recorder/record", SetBool.Request(data=True))
    assert not answer.success
    assert "cannot be written (File too large); make room" in answer.message
    limited(process, resource.RLIM_INFINITY)
    graph.until(lambda: "is cut" not in reports()[-1][1] and reports()[-1][2]["file"].endswith("_1.mcap"), "a new file")
    send(graph, [0.25, 0.5])
    status, output = graph.ended(process)
    assert status == 0
    assert "Traceback" not in output
    assert sorted(path.name for path in graph.folder.glob("*.mcap")) == ["run.cut.mcap", "run_1.mcap"]
    mended = graph.folder / "mended.mcap"
    assert recover(graph.folder / "run.cut.mcap", mended).messages > 100
    assert is_whole(graph.folder / "run_1.mcap")


def test_a_full_disk_at_the_end_is_one_line_and_status_2(graph):
    process = recorder(graph, "output:=run.mcap", "flush_interval:=10.0")
    send(graph, range(2000))
    limited(process, 2000)
    status, output = graph.ended(process)
    assert status == 2
    assert "Traceback" not in output
    assert "run.cut.mcap is cut: File too large." in output


def test_a_rosbag2_folder_has_its_metadata_from_the_start_and_after_a_cut(graph):
    reports = told(graph)
    process = recorder(graph, "output:=bag", "form:=rosbag2")
    assert (graph.folder / "bag" / "metadata.yaml").exists()
    limited(process, FULL)
    fill(graph, reports, counted())
    limited(process, resource.RLIM_INFINITY)
    graph.until(lambda: reports()[-1][2]["file"].endswith("_1.mcap"), "a new file")
    assert graph.ended(process)[0] == 0
    recover(graph.folder / "bag", graph.folder / "mended")
    with Reader(graph.folder / "mended") as reader:
        assert reader.message_count > 100


def test_two_recorders_that_start_in_one_second_write_two_files(graph):
    code = (
        "import datetime, pierburg_ros.nodes.recorder as recorder\n"
        "class Fixed(datetime.datetime):\n"
        "    now = classmethod(lambda cls: cls(2030, 1, 2, 3, 4, 5))\n"
        "recorder.datetime = Fixed\n"
        "recorder.main()"
    )
    command = [sys.executable, "-c", code, "--ros-args", "-p", "output:=out/"]
    processes = [graph.run([*command, "-r", f"__node:=recorder_{number}"]) for number in (1, 2)]
    graph.until(lambda: len(list(graph.folder.glob("out/*.mcap"))) == 2, "two files")
    graph.until(lambda: len([n for n in graph.node.get_node_names() if "recorder" in n]) == 2, "two recorders")
    assert [graph.ended(process)[0] for process in processes] == [0, 0]
    names = sorted(path.name for path in graph.folder.glob("out/*.mcap"))
    assert names == ["2030-01-02T03-04-05.mcap", "2030-01-02T03-04-05_1.mcap"]


def test_a_split_that_finds_no_room_goes_on_in_the_old_file(graph):
    process = recorder(graph, "output:=run.mcap")
    send(graph, range(10))
    limited(process, FULL)
    answer = graph.call(Trigger, "recorder/split", Trigger.Request())
    assert not answer.success
    send(graph, range(10, 20))
    assert graph.ended(process)[0] == 0
    assert [path.name for path in graph.folder.glob("*.mcap")] == ["run.mcap"]
    with (graph.folder / "run.mcap").open("rb") as stream:
        found = [m for _, c, m in make_reader(stream).iter_messages() if c.topic == "/duty"]
    assert len(found) == 20


def test_what_is_lost_is_counted_in_the_answer_on_diagnostics_and_in_the_file(graph):
    reports = told(graph)
    process = recorder(graph, "output:=run.mcap")
    graph.until(lambda: reports(), "a report")
    send(graph, range(10))
    process.send_signal(signal.SIGSTOP)
    for number in range(30_000):  # three times what publisher and reader keep
        graph.publisher.publish(Float64(data=float(number)))
    process.send_signal(signal.SIGCONT)
    graph.until(lambda: int(reports()[-1][2]["lost_messages"]) > 0, "a loss")
    graph.until(lambda: "messages lost" in reports()[-1][1], "a warning")
    assert graph.publisher.wait_for_all_acked(Duration(seconds=DEADLINE))
    answer = graph.call(SetBool, "recorder/record", SetBool.Request(data=False))
    graph.ended(process)
    with (graph.folder / "run.mcap").open("rb") as stream:
        reader = make_reader(stream)
        sequence = [m.sequence for _, c, m in reader.iter_messages() if c.topic == "/duty"]
        notes = {each.name: each.metadata for each in reader.iter_metadata()}
    lost = sequence[-1] - sequence[0] + 1 - len(sequence)
    assert lost > 0
    assert f", {lost} lost" in answer.message
    assert notes[LOSSES]["/duty"] == f"{lost} of {lost + len(sequence)}"


def test_ten_seconds_of_messages_wait_for_a_recorder_that_is_stopped(graph):
    process = recorder(graph, "output:=run.mcap")
    process.send_signal(signal.SIGSTOP)
    for number in range(5000):
        graph.publisher.publish(Float64(data=float(number)))
    process.send_signal(signal.SIGCONT)
    send(graph, [-1.0])
    graph.ended(process)
    with (graph.folder / "run.mcap").open("rb") as stream:
        found = [m.sequence for _, c, m in make_reader(stream).iter_messages() if c.topic == "/duty"]
    assert found == list(range(1, 5002))


class Source:
    """A source of time that ticks whenever it may."""

    PERIOD = 2_000_000

    def __init__(self, graph):
        self.ticks = 0
        self.warnings = []
        diagnostics = SimpleNamespace(begin=lambda *said: self.warnings.append(said[2]), end=lambda _: None)
        self.held_back = HeldBack(graph.node, diagnostics, Event())
        self._publisher = graph.node.create_publisher(Clock, "/clock", 10_000)
        graph.until(lambda: self._publisher.get_subscription_count() > 1, "readers of the clock")
        graph.until(lambda: self.tick() and self.ticks > 3000, "ticks")

    def waits(self):
        """Whether the source is held back."""
        return self.held_back.must_wait(self.ticks * self.PERIOD, self.PERIOD)

    def tick(self):
        """Tick up to 200 times, as long as it may; True in any case."""
        for _ in range(200):
            if self.waits():
                break
            self.ticks += 1
            self._publisher.publish(messages.clock(self.ticks * self.PERIOD))
        return True


def test_the_source_of_time_waits_for_a_stopped_recorder_and_nothing_is_lost(graph):
    process = graph.start("recorder", "output:=run.mcap", "use_sim_time:=true")
    source = Source(graph)
    process.send_signal(signal.SIGSTOP)
    graph.until(lambda: source.tick() and source.waits(), "a source that waits")
    standing = source.ticks
    process.send_signal(signal.SIGCONT)
    graph.until(lambda: source.tick() and source.ticks > standing + 3000, "ticks again")
    graph.ended(process)
    with (graph.folder / "run.mcap").open("rb") as stream:
        found = [m.sequence for _, c, m in make_reader(stream).iter_messages() if c.topic == "/clock"]
    assert len(found) > standing
    assert found == list(range(found[0], found[-1] + 1))


def test_a_recorder_that_leaves_is_not_waited_for_and_a_killed_one_not_for_ever(graph):
    process = graph.start("recorder", "output:=run.mcap", "use_sim_time:=true")
    source = Source(graph)
    graph.ended(process)
    graph.until(lambda: source.tick() and source.ticks > 6000, "ticks without a recorder")
    process = graph.start("recorder", "output:=again.mcap", "use_sim_time:=true")
    path = graph.folder / "again.mcap"
    graph.until(lambda: source.tick() and path.exists() and path.stat().st_size > 10_000, "a second recorder")
    process.kill()
    graph.ended(process, by=None)
    graph.until(lambda: source.tick() and source.waits(), "a source that waits")
    standing = source.ticks
    graph.until(lambda: source.tick() and source.ticks > standing + 3000, "ticks again")
    assert "a recorder does not follow and is not waited for" in source.warnings
