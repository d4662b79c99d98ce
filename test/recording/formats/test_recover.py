"""A cut recording made whole: at every kind of place where it may be cut, for every reader."""

import random
import shutil

import pytest
import yaml
from mcap.reader import make_reader
from rosbags.highlevel import AnyReader
from rosbags.rosbag2 import Reader

from pierburg_ros.errors import InputError
from pierburg_ros.recording import read_recording
from pierburg_ros.recording.formats.mcap_file import read_mcap
from pierburg_ros.recording.formats.mcap_writer import McapWriter
from pierburg_ros.recording.formats.messages import Bag
from pierburg_ros.recording.formats.recover import is_whole, recover
from pierburg_ros.recording.loss import LOSSES


@pytest.fixture
def whole(write_bag, run):
    """A file of 400 messages in some twenty chunks."""
    return write_bag(run(200), chunk_size=512)


def messages(path):
    """Topic, times, number and bytes of all messages, as the mcap library finds them by the index."""
    with path.open("rb") as stream:
        reader = make_reader(stream)
        assert reader.get_summary().chunk_indexes
        found = reader.iter_messages(log_time_order=False)
        return [(c.topic, m.log_time, m.publish_time, m.sequence, m.data) for _, c, m in found]


def stream_count(path):
    """How many messages the project's own reader finds in a file that may be cut."""
    bag = Bag(path.name, lambda _: True)
    read_mcap(path, bag)
    return bag.count


@pytest.mark.parametrize("seed", range(40))
def test_a_file_cut_anywhere_keeps_every_message_that_is_there_in_full(tmp_path, whole, seed):
    content = whole.read_bytes()
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(content[: random.Random(seed).randrange(1200, len(content) - 1)])
    before = cut.read_bytes()
    target = tmp_path / "mended.mcap"
    found = recover(cut, target)
    assert cut.read_bytes() == before
    assert is_whole(target)
    assert messages(target) == messages(whole)[: found.messages]
    assert found.messages == stream_count(cut) == stream_count(target)
    with AnyReader([target]) as reader:
        assert len(list(reader.messages())) == found.messages


def test_a_file_that_only_lacks_its_end_reads_the_same_afterwards(tmp_path, whole):
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(whole.read_bytes()[:-100])
    recover(cut, tmp_path / "mended.mcap")
    first, second = read_recording(whole), read_recording(tmp_path / "mended.mcap")
    assert (first.time == second.time).all()
    assert (first.measured == second.measured).all()
    assert (first.command.values == second.command.values).all()


def test_a_damaged_chunk_is_left_out_and_the_rest_stays(tmp_path, whole):
    content = bytearray(whole.read_bytes())
    with whole.open("rb") as stream:
        chunk = make_reader(stream).get_summary().chunk_indexes[5]
    content[chunk.chunk_start_offset + chunk.chunk_length - 5] ^= 0xFF
    damaged = tmp_path / "damaged.mcap"
    damaged.write_bytes(content[:-100])
    found = recover(damaged, tmp_path / "mended.mcap")
    assert found.damaged == 1
    assert 300 < found.messages < 400
    assert set(messages(tmp_path / "mended.mcap")) < set(messages(whole))


def test_what_was_lost_before_stands_in_the_recovered_file(tmp_path, write_bag, run):
    lossy = write_bag([m for m in run(100) if not (m.topic == "/duty" and m.sequence in (30, 31))])
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(lossy.read_bytes()[:-60])
    recover(cut, tmp_path / "mended.mcap")
    with (tmp_path / "mended.mcap").open("rb") as stream:
        notes = {each.name: each.metadata for each in make_reader(stream).iter_metadata()}
    assert notes[LOSSES] == {"/hall_voltage": "0 of 100", "/duty": "2 of 100"}


def test_a_rosbag2_folder_without_metadata_opens_again(tmp_path):
    bag = tmp_path / "bag"
    bag.mkdir()
    for number in (0, 1, 10, 2):
        with (bag / f"bag_{number}.mcap").open("wb") as stream, McapWriter(stream) as writer:
            writer.declare("/duty", "std_msgs/msg/Float64")
            writer.write("/duty", b"\0\1\0\0" + bytes(8), number, number, number)
    last = (bag / "bag_10.mcap").read_bytes()
    (bag / "bag_10.mcap").write_bytes(last[:-30])
    assert not is_whole(bag)
    assert recover(bag, tmp_path / "mended").messages == 4
    assert is_whole(tmp_path / "mended")
    with Reader(tmp_path / "mended") as reader:
        assert [time for _, time, _ in reader.messages()] == [0, 1, 2, 10]
    listed = yaml.safe_load((tmp_path / "mended" / "metadata.yaml").read_text())["rosbag2_bagfile_information"]
    assert listed["relative_file_paths"] == ["bag_0.mcap", "bag_1.mcap", "bag_2.mcap", "bag_10.mcap"]
    shutil.rmtree(bag)


def test_nothing_is_written_where_nothing_can_be_saved(tmp_path, whole):
    stump = tmp_path / "stump.mcap"
    stump.write_bytes(whole.read_bytes()[:60])
    with pytest.raises(InputError, match="holds no whole message"):
        recover(stump, tmp_path / "mended.mcap")
    other = tmp_path / "other.mcap"
    other.write_bytes(b"no magic at all")
    with pytest.raises(InputError, match="is not an MCAP file"):
        recover(other, tmp_path / "mended.mcap")
    with pytest.raises(InputError, match="exists"):
        recover(whole, stump)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["other.mcap", "run.mcap", "stump.mcap"]
