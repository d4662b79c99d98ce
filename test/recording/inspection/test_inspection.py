"""What is in any file, and a map of it that works as written."""

import numpy as np
import pytest
from rosbags.rosbag2 import StoragePlugin
from support.foreign_bags import T, bench_run, write_foreign

from pierburg_ros.errors import InputError
from pierburg_ros.recording import read_recording
from pierburg_ros.recording.inspection import inspect


def drafted(folder, path):
    """The recording at `path` by the map that is drafted of it."""
    (folder / "drafted.yaml").write_text(inspect(path).signals)
    return read_recording(path, signals=folder / "drafted.yaml")


@pytest.mark.parametrize("plugin", [StoragePlugin.MCAP, StoragePlugin.SQLITE3])
def test_a_bag_of_foreign_types_is_listed_and_its_draft_works(tmp_path, plugin):
    bag = write_foreign(tmp_path / "bag", bench_run(), plugin)
    found = inspect(bag)
    assert found.recording is None and "/joint_states has 2 positions" in found.problem
    topics = {topic.name: topic for topic in found.topics}
    fields = {field.path: field for field in topics["/motor/command"].fields}
    assert fields["pwm.data[2]"].could_be == "-29.88 to 29.98: duty [percent]?"
    assert fields["micros"].could_be is None
    elbow = {field.path: field for field in topics["/joint_states"].fields}["position[elbow]"]
    assert elbow.could_be == "JointState, 0 to 1.18: position [rad]?"
    assert topics["/motor/command"].rate == pytest.approx(100.0)
    assert topics["/motor/command"].clocks[0] == "stamp"
    recording = drafted(tmp_path, bag)
    np.testing.assert_allclose(recording.command.values, 0.3 * np.sin(0.3 * np.arange(60)), atol=1e-7)
    np.testing.assert_allclose(np.abs(recording.measured), 0.02 * np.arange(60), atol=1e-12)
    assert recording.supply_voltage.values[-1] == pytest.approx(13.59)


def test_a_table_of_foreign_columns_is_listed_and_its_draft_works(tmp_path):
    rows = "".join(f"{2 * k};{k / 2:.1f};{20 * k};{13 + 0.01 * k:.2f};ok\n".replace(".", ",") for k in range(100))
    path = tmp_path / "bench.csv"
    path.write_text("t;pwm;adc;U_bat;note\n" + rows)
    found = inspect(path)
    assert found.recording is None
    topics = {topic.name: topic for topic in found.topics}
    assert topics["adc"].fields[0].could_be == "0 to 1980: hall voltage [counts]?"
    assert topics["pwm"].rate == pytest.approx(500.0)
    assert topics["note"].fields[0].could_be is None
    recording = drafted(tmp_path, path)
    np.testing.assert_allclose(recording.time, 0.002 * np.arange(100), atol=1e-12)
    np.testing.assert_allclose(recording.command.values, 0.005 * np.arange(100), atol=1e-12)
    np.testing.assert_allclose(recording.measured, 20 * np.arange(100) * 3.3 / 4096, atol=1e-12)


def test_a_folder_of_tables_is_listed_and_its_draft_works(tmp_path):
    folder = tmp_path / "bench"
    folder.mkdir()
    (folder / "motor.csv").write_text("t_ms,pwm,angle\n" + "".join(f"{k},{k % 7 / 10},{k / 50}\n" for k in range(50)))
    (folder / "battery.csv").write_text("t_ms,vbat\n0,13.5\n40,13.1\n")
    found = inspect(folder)
    assert found.recording is None and "is a folder of tables, expected a signal map" in found.problem
    assert [topic.name for topic in found.topics][:2] == ["battery.csv t_ms", "battery.csv vbat"]
    recording = drafted(tmp_path, folder)
    assert recording.quantity == "position" and recording.time[-1] == pytest.approx(0.049)
    np.testing.assert_allclose(recording.supply_voltage.time, [0.0, 0.04])
    used = {topic.name: topic.read_as for topic in inspect(folder, signals=tmp_path / "drafted.yaml").topics}
    assert used["motor.csv pwm"] == "duty" and used["battery.csv vbat"] == "supply_voltage"


def test_a_recording_that_reads_already_reads_the_same_by_its_draft(tmp_path, write_bag, run):
    path = write_bag(run())
    plain, again = read_recording(path), drafted(tmp_path, path)
    np.testing.assert_array_equal(plain.time, again.time)
    np.testing.assert_array_equal(plain.measured, again.measured)
    np.testing.assert_array_equal(plain.command.values, again.command.values)


def test_a_picture_does_not_take_the_memory_and_is_counted(tmp_path):
    image = T["sensor_msgs/msg/CompressedImage"]
    stamped = T["std_msgs/msg/Header"](T["builtin_interfaces/msg/Time"](1, 0), "")
    pictures = [
        ("/camera", "sensor_msgs/msg/CompressedImage", 1000 + 0.1 * k, image(stamped, "png", np.zeros(10**6, np.uint8)))
        for k in range(5)
    ]
    bag = write_foreign(tmp_path / "bag", sorted(pictures + bench_run(20), key=lambda message: message[2]))
    camera = {topic.name: topic for topic in inspect(bag).topics}["/camera"]
    assert camera.count == 5 and camera.rate == pytest.approx(10.0) and camera.fields == ()
    with pytest.raises(InputError, match="/camera has messages of more than 16 KiB"):
        read_recording(bag, signals={"position": {"topic": "/camera", "field": "data[0]"}})


def test_what_nothing_speaks_for_is_said_in_the_draft(tmp_path):
    path = tmp_path / "run.csv"
    path.write_text("a,b\n3,7\n1,7\n2,7\n")
    text = inspect(path).signals
    assert "# Nothing looks like an input" in text and "# Nothing looks like a measured signal" in text
    assert "# time: no column rises from row to row." in text


@pytest.mark.parametrize("head", ["stamp,pwm,u_1,x\n-,%,mV,deg\n", "stamp,pwm [%],u_1 (mV),x [deg]\n"])
@pytest.mark.parametrize("zone", ["", "Z"])
def test_units_and_stamps_of_a_table_are_in_its_draft(tmp_path, head, zone):
    """What is in percent, mV and degrees is less than 1 here: no range would say so."""
    rows = "".join(f"2026-03-01 12:00:0{k // 10}.{k % 10}{zone},{k / 50},{k / 40},{k / 30}\n" for k in range(50))
    path = tmp_path / "bench.csv"
    path.write_text(head + rows)
    topics = {topic.name.split()[0]: topic for topic in inspect(path).topics}
    assert topics["stamp"].fields[0].could_be == "0 to 4.9: time, stamps?"
    assert topics["pwm"].fields[0].could_be == "0 to 0.98: duty [percent]?"
    assert topics["u_1"].fields[0].could_be == "0 to 1.225: hall voltage [mV]?"
    recording = drafted(tmp_path, path)
    np.testing.assert_allclose(recording.time, 0.1 * np.arange(50), atol=1e-9)
    np.testing.assert_allclose(recording.command.values, np.arange(50) / 5000, atol=1e-12)
    np.testing.assert_allclose(recording.measured, np.arange(50) / 40_000, atol=1e-12)


def test_columns_with_units_are_read_by_their_bare_names(tmp_path):
    path = tmp_path / "run.csv"
    path.write_text("time [ms],duty [%],position (deg)\n0,0,0\n2,50,90\n")
    assert [topic.read_as for topic in inspect(path).topics] == ["time", "duty", "position"]


def test_counts_that_a_table_states_get_the_scale_of_a_converter(tmp_path):
    path = tmp_path / "run.csv"
    path.write_text("time,duty,hall\ns,1,counts\n" + "".join(f"{k / 100},{k / 100},{20 * k}\n" for k in range(50)))
    assert drafted(tmp_path, path).measured[-1] == pytest.approx(980 * 3.3 / 1024)
