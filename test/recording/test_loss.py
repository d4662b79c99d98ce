"""What is missing in a recording, and nothing where nothing is."""

from pathlib import Path

import numpy as np
import pytest

from pierburg_ros.recording import Channel, Recording, read_recording
from pierburg_ros.recording.loss import Loss, are_numbered, merged, pauses, silences
from pierburg_ros.recording.write import write_simulated

PERIOD = 0.002
TIME = np.arange(0.0, 10.0, PERIOD)
SHARED = Path(__file__).parents[3] / "shared"


def table(path, time, duty, measured):
    """A CSV of these rows."""
    rows = (f"{t:.6f},{d:.9g},{m:.9g}\n" for t, d, m in zip(time, duty, measured, strict=True))
    path.write_text("time,duty,position\n" + "".join(rows))
    return path


def steps(time):
    """A duty of steps every 0.6 s, as an experiment sends it at every sample."""
    return np.round(np.random.default_rng(1).uniform(-0.3, 0.6, 20)[(time / 0.6).astype(int)], 3)


def test_a_gap_in_the_numbers_of_the_duty_is_a_stretch_without_a_known_input(bag_with_a_gap):
    recording = read_recording(bag_with_a_gap)
    assert recording.losses == (Loss("duty", 10, 100, recording.unknown_input),)
    assert recording.unknown_input == (pytest.approx((0.291, 0.401)),)
    assert recording.missing_samples == ()
    assert recording.warning.startswith("Messages are missing: duty 10 of 100 messages. The duty is unknown in 1 ")


def test_a_window_of_a_recording_keeps_what_is_missing_in_it(bag_with_a_gap):
    recording = read_recording(bag_with_a_gap)
    assert recording.select(0.35, 0.8).unknown_input == (pytest.approx((0.0, 0.051)),)
    assert recording.select(0.5, 0.8).losses == ()


def test_a_fifth_lost_at_random_is_counted_to_the_message(write_bag, run):
    random = np.random.default_rng(3)
    kept = [m for m in run(500) if m.sequence in (0, 499) or random.random() > 0.2]
    sent = {topic: 500 - sum(m.topic == topic for m in kept) for topic in ("/hall_voltage", "/duty")}
    found = {loss.signal: loss.lost for loss in read_recording(write_bag(kept)).losses}
    assert found == {"hall_voltage": sent["/hall_voltage"], "duty": sent["/duty"]}


def test_numbers_that_count_all_topics_of_a_file_say_nothing_of_one(write_bag, run):
    shared = [m._replace(sequence=place) for place, m in enumerate(run(100))]
    assert read_recording(write_bag(shared)).losses == ()
    rows = [m._replace(sequence=7 * m.sequence) for m in run(100)]
    assert read_recording(write_bag(rows)).losses == ()


def test_a_publisher_that_was_started_again_has_lost_nothing_by_that(write_bag, run):
    again = [m._replace(sequence=m.sequence % 150) for m in run(300)]
    assert read_recording(write_bag(again)).losses == ()
    assert not are_numbered(np.array([1, 501, 2, 502, 3, 503]))


@pytest.mark.parametrize("unnumbered", [True, False])
def test_three_seconds_without_rows_are_found_in_a_table(tmp_path, unnumbered):
    kept = (TIME < 4.0) | (TIME > 7.0)
    duty = steps(TIME) if unnumbered else np.sin(TIME)
    recording = read_recording(table(tmp_path / "run.csv", TIME[kept], duty[kept], np.sin(TIME)[kept]))
    assert recording.unknown_input == (pytest.approx((3.998, 7.002)),)
    assert recording.missing_samples == recording.unknown_input


def test_a_duty_that_stops_while_samples_go_on_is_unknown_if_it_was_sent_regularly():
    kept = (TIME < 4.0) | (TIME > 7.0)
    assert silences(TIME[kept], steps(TIME)[kept], ()) == (pytest.approx((3.998, 7.002)),)


def test_a_duty_that_is_sent_on_change_is_known_between_its_changes(tmp_path):
    duty = steps(TIME)
    changes = np.flatnonzero(np.diff(duty, prepend=np.nan) != 0.0)
    ramp = np.concatenate([TIME[:200], TIME[[1000, 3000]]])
    assert silences(TIME[changes], duty[changes], ()) == ()
    assert silences(ramp, np.sin(ramp), ()) == ()
    write_simulated(tmp_path / "run.mcap", TIME, Channel(TIME[changes], duty[changes]), np.sin(TIME))
    assert read_recording(tmp_path / "run.mcap").losses == ()


def test_rows_that_an_even_clock_lacks_are_missing(tmp_path):
    kept = np.random.default_rng(3).random(TIME.size) >= 0.1
    kept[[0, 1, -2, -1]] = True
    recording = read_recording(table(tmp_path / "run.csv", TIME[kept], steps(TIME)[kept], np.sin(TIME)[kept]))
    gaps = np.flatnonzero(np.diff(np.flatnonzero(kept)) > 1)
    assert len(pauses(TIME[kept])) == gaps.size and recording.unknown_input == recording.missing_samples
    unknown = sum(end - start for start, end in recording.unknown_input)
    assert unknown == pytest.approx(PERIOD * (gaps.size + np.count_nonzero(~kept)))
    uneven = TIME + 0.1 * PERIOD * np.random.default_rng(4).standard_normal(TIME.size)
    assert pauses(np.sort(uneven)[kept]) == ()


def test_skipped_ticks_of_a_busy_machine_are_no_gap():
    random = np.random.default_rng(0)
    uneven = np.cumsum(PERIOD * random.geometric(0.5, 5000))
    assert pauses(uneven) == ()


def test_spans_that_overlap_are_one():
    assert merged(((2.0, 3.0), (0.0, 1.0), (0.5, 1.5), (3.0, 4.0))) == ((0.0, 1.5), (2.0, 4.0))


def test_a_recording_made_of_arrays_lacks_nothing():
    recording = Recording("run", "position", TIME, TIME, Channel(TIME, steps(TIME)))
    assert (recording.unknown_input, recording.warning) == ((), "")


@pytest.mark.parametrize("folder", ["practice", "data/xl330"])
def test_no_false_gap_in_whole_recordings(tmp_path, folder):
    files = sorted((SHARED / folder).rglob("*.mcap"))[::6]
    if not files:
        pytest.skip(f"no recordings in {folder}")
    for file in files:
        recording = read_recording(file)
        assert recording.losses == ()
        duty = recording.command.at(recording.time, before=0.0)
        as_table = table(tmp_path / "run.csv", recording.time, duty, recording.measured)
        assert read_recording(as_table).losses == ()
