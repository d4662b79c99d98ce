"""What is laid over a recording lies at the times of its messages, whatever clock it was read by."""

from pathlib import Path

import numpy as np
import pytest
from mcap.reader import make_reader
from rosbags.typesys import Stores, get_typestore
from support.reports import result, thinned

import pierburg_ros
from pierburg_ros.diagnosis.result import Exhibits
from pierburg_ros.library.diagnosing import Diagnosis
from pierburg_ros.library.overlays import of_diagnosis
from pierburg_ros.recording import Channel, Recording, read_recording
from pierburg_ros.recording.file_times import FileTimes
from pierburg_ros.viewers.mcap_overlay import write_mcap
from pierburg_ros.viewers.overlay import Window, window_share

TYPES = get_typestore(Stores.ROS2_JAZZY)
START = 1_700_000_000.0
"""When the recordings here begin [s since 1970]."""


def messages_of(path: Path) -> dict[str, list]:
    """The messages of every topic, in the order of the file."""
    found: dict[str, list] = {}
    with path.open("rb") as stream:
        for _, channel, message in make_reader(stream).iter_messages():
            found.setdefault(channel.topic, []).append(message)
    return found


def values_of(messages: list) -> np.ndarray:
    return np.array([TYPES.deserialize_cdr(each.data, "std_msgs/msg/Float64").data for each in messages])


@pytest.fixture
def late(write_bag, message) -> Path:
    """A valve at rest: published 0.3 to 0.7 ms after the stamp of its joint states, logged 1 to 3 ms later."""
    random = np.random.default_rng(3)
    found = []
    for k in range(500):
        stamp = START + 0.01 * k
        sent = stamp + random.uniform(0.0003, 0.0007)
        logged = sent + random.uniform(0.001, 0.003)
        value = 0.42 + 0.003 * random.standard_normal()
        found.append(message("/hall_voltage", "float", logged, sent, k, value))
        found.append(message("/applied_duty", "float", logged, sent, k, 0.0))
        found.append(message("/joint_states", "joint", logged, sent, k, (stamp, 0.0)))
    return write_bag(found)


def test_prediction_and_residual_have_the_times_of_the_measured_messages(late, tmp_path):
    comparison = pierburg_ros.compare(late, pierburg_ros.Model.nominal("pierburg"))
    assert comparison.recording.time_source == "stamp"
    comparison.save(tmp_path / "out")
    original, laid = messages_of(late)["/hall_voltage"], messages_of(tmp_path / "out" / "replay.mcap")
    for name in ("measured", "simulated", "residual", "window_share"):
        times = [(each.log_time, each.publish_time) for each in laid[f"/replay/{name}"]]
        assert times == [(each.log_time, each.publish_time) for each in original]
    np.testing.assert_array_equal(values_of(laid["/replay/measured"]), values_of(original))
    np.testing.assert_array_equal(values_of(laid["/replay/residual"]), comparison.residual)


def test_no_topic_is_called_like_one_of_the_recording(late, tmp_path):
    pierburg_ros.compare(late, pierburg_ros.Model.nominal("pierburg")).save(tmp_path / "out")
    assert set(messages_of(late)).isdisjoint(messages_of(tmp_path / "out" / "replay.mcap"))


def test_remarks_are_log_messages_at_the_windows(late, tmp_path):
    comparison = pierburg_ros.compare(late, pierburg_ros.Model.nominal("pierburg"))
    comparison.save(tmp_path / "out")
    first, window = messages_of(tmp_path / "out" / "replay.mcap")["/replay/remarks"]
    said = [TYPES.deserialize_cdr(each.data, "rcl_interfaces/msg/Log") for each in (first, window)]
    assert "RMSE" in said[0].msg and said[1].msg.startswith("window 1 of 1")
    assert said[1].stamp.sec * 10**9 + said[1].stamp.nanosec == window.log_time
    at = int(np.searchsorted(comparison.recording.time, comparison.found.worst.start))
    assert window.log_time == messages_of(late)["/hall_voltage"][at].log_time


def test_a_table_lies_at_the_times_of_its_column(tmp_path):
    time = START + 0.01 * np.arange(200)
    rows = "\n".join(f"{each:.3f},0,0.42" for each in time)
    (tmp_path / "bench.csv").write_text(f"time,duty,hall_voltage\n{rows}\n")
    log_time, publish_time = read_recording(tmp_path / "bench.csv").file_times.at([0.0, 1.0])
    np.testing.assert_allclose((log_time * 1e-9, publish_time * 1e-9), [[START, START + 1.0]] * 2, atol=1e-6)


@pytest.mark.parametrize("first", [-5.0, 1e12, float("inf"), float("nan")])
def test_a_table_whose_times_no_file_can_have_counts_from_its_first_sample(first):
    assert FileTimes.of_column(np.arange(3.0), first) is None


def test_times_between_and_beyond_messages():
    stamps = np.array([10**18, 10**18 + 2 * 10**9, 10**18 + 3 * 10**9])
    times = FileTimes.of(np.array([0.0, 1.0, 2.0]), stamps, np.zeros(3, np.int64))
    log_time, publish_time = times.at([-1.0, 0.0, 0.5, 1.0, 2.0, 4.0])
    since = (log_time - stamps[0]) * 1e-9
    np.testing.assert_allclose(since, [-1.0, 0.0, 1.0, 2.0, 3.0, 5.0], rtol=0, atol=1e-9)
    np.testing.assert_array_equal(publish_time, log_time)
    np.testing.assert_array_equal(times.since(1.0).at(0.0)[0], stamps[1])


def test_a_part_of_a_recording_keeps_the_times_of_its_messages(late):
    whole = read_recording(late)
    part = whole.select(2.0, 4.0)
    np.testing.assert_array_equal(part.file_times.at(part.time), whole.file_times.at(whole.time[200:401]))


def test_a_window_holds_its_share():
    share = window_share(np.arange(6.0), [Window(1.0, 2.0, 0.6, ""), Window(4.0, 4.5, 0.3, "")])
    np.testing.assert_array_equal(share, [0.0, 0.6, 0.6, 0.0, 0.3, 0.0])


def recorded(view, start: float) -> Recording:
    """A recording that shows a view of a diagnosis, in a file whose clock begins at `start` [s]."""
    stamps = np.round((start + view.time) * 1e9).astype(np.int64)
    times = FileTimes(view.time, stamps, stamps)
    return Recording("run", "hall_voltage", view.time, view.measured, Channel([0.0], [0.0]), file_times=times)


def test_a_diagnosis_lays_both_models_their_residuals_and_its_windows_over_each_recording(tmp_path):
    found = thinned(result(recordings=["first.mcap", "second.mcap"]))
    views = found.exhibits.views
    recordings = [recorded(view, 100.0 * (number + 1)) for number, view in enumerate(views)]
    for number, overlay in enumerate(of_diagnosis(found, recordings)):
        path = tmp_path / f"{number}.mcap"
        write_mcap(path, overlay)
        laid = messages_of(path)
        values = {name: values_of(laid[f"/diagnosis/{name}"]) for name in overlay.signals}
        np.testing.assert_array_equal(values["residual"], views[number].errors["final"])
        np.testing.assert_allclose(values["corrected"] + values["residual"], views[number].measured, atol=1e-12)
        np.testing.assert_allclose(values["nominal"] + values["nominal_residual"], views[number].measured, atol=1e-12)
        assert laid["/diagnosis/measured"][0].log_time == 100 * (number + 1) * 10**9
        inside = values["window_share"] > 0.0
        assert inside.any() == (number == 0)
    place = found.diagnosis.locations[0]
    share = of_diagnosis(found, recordings)[0].signals["window_share"]
    within = share[0][share[1] == place.share]
    assert place.start <= within[0] < place.start + 0.05 and place.end - 0.05 < within[-1] <= place.end


def test_where_nothing_is_concluded_the_recordings_are_shown_with_the_reason():
    found = thinned(result())
    recordings = [recorded(view, 5.0) for view in found.exhibits.views]
    bare = type(found)(found.diagnosis, found.model, (), found.signals, Exhibits())
    overlays = of_diagnosis(bare, recordings)
    assert [set(each.signals) for each in overlays] == [{"measured", "command", "window_share"}] * len(recordings)
    assert overlays[0].remarks[0][1] == found.diagnosis.summary


def test_without_rerun_one_line_says_what_to_install(late, tmp_path, monkeypatch):
    monkeypatch.setattr("pierburg_ros.viewers.rerun_overlay.find_spec", lambda _: None)
    comparison = pierburg_ros.compare(late, pierburg_ros.Model.nominal("pierburg"))
    with pytest.raises(pierburg_ros.InputError, match=r"pip install 'pierburg_ros\[rerun\]'"):
        comparison.write_rerun(tmp_path / "run.rrd")
    assert [path.name for path in tmp_path.iterdir()] == ["run.mcap"]


def test_a_file_for_rerun_holds_every_signal(tmp_path):
    pytest.importorskip("rerun")
    found = thinned(result(recordings=["first.mcap", "second.mcap"]))
    recordings = [recorded(view, 100.0) for view in found.exhibits.views]
    Diagnosis(found, tuple(recordings)).write_rerun(tmp_path / "run.rrd")
    content = (tmp_path / "run.rrd").read_bytes()
    assert content.startswith(b"RRF")
    for number in range(len(recordings)):
        for name in ("measured", "corrected", "residual", "window_share", "remarks"):
            assert f"/recording_{number + 1}/{name}".encode() in content
