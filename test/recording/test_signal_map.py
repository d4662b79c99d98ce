"""Any topic of any type, and any column, by a signal map: the values and times are those that were written."""

import sqlite3

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rosbags.rosbag2 import CompressionMode, StoragePlugin, Writer
from support.foreign_bags import STORE, T, bench_run, board, header, joints, stamp, write_foreign

from pierburg_ros.errors import InputError
from pierburg_ros.recording import read_recording

MAP = """duty: {topic: /motor/command, field: "pwm.data[2]", unit: percent}
position: {topic: /joint_states, field: "position[elbow]", sign: -1, offset: 1.5}
supply_voltage: {topic: /board, field: "channels[supply].volts"}
"""
FLOAT64 = "std_msgs/msg/Float64"


@pytest.fixture
def written(tmp_path):
    """Writes a map, and gives its path."""

    def write(text):
        path = tmp_path / "signals.yaml"
        path.write_text(text)
        return path

    return write


def refusal(path, signals) -> str:
    with pytest.raises(InputError) as refused:
        read_recording(path, signals=signals)
    assert "\n" not in str(refused.value)
    return str(refused.value)


@pytest.mark.parametrize("plugin", [StoragePlugin.MCAP, StoragePlugin.SQLITE3])
@pytest.mark.parametrize("packing", [CompressionMode.NONE, CompressionMode.FILE, CompressionMode.MESSAGE])
def test_nested_fields_arrays_and_names_of_foreign_types_in_every_storage(tmp_path, written, plugin, packing):
    bag = write_foreign(tmp_path / "bag", bench_run(), plugin, packing)
    recording = read_recording(bag, signals=written(MAP))
    steps = np.arange(60)
    assert recording.quantity == "position" and recording.time_source == "stamp"
    np.testing.assert_allclose(recording.time, 0.01 * steps, atol=1e-9)
    np.testing.assert_allclose(recording.measured, 1.5 - 0.02 * steps, atol=1e-12)
    np.testing.assert_allclose(recording.command.values, 0.3 * np.sin(0.3 * steps), atol=1e-7)
    np.testing.assert_allclose(recording.supply_voltage.values, 13.0 + 0.01 * steps, atol=1e-12)


@pytest.mark.parametrize("plugin", [StoragePlugin.MCAP, StoragePlugin.SQLITE3])
def test_a_bag_that_was_split_is_one_recording(tmp_path, written, plugin):
    run = bench_run()
    parts = [write_foreign(tmp_path / f"part_{k}", run[start : start + 90], plugin) for k, start in ((0, 0), (1, 90))]
    whole = tmp_path / "whole"
    whole.mkdir()
    names = []
    for part in parts:
        (file,) = (path for path in part.iterdir() if path.suffix in (".mcap", ".db3"))
        names.append(file.rename(whole / file.name).name)
    (whole / "metadata.yaml").write_text(f"rosbag2_bagfile_information: {{relative_file_paths: {names}}}\n")
    recording = read_recording(whole, signals=written(MAP))
    np.testing.assert_allclose(recording.measured, 1.5 - 0.02 * np.arange(60), atol=1e-12)
    (whole / "metadata.yaml").unlink()
    if plugin == StoragePlugin.MCAP:
        assert "without metadata.yaml and with 2 MCAP files" in refusal(whole, written(MAP))


def test_a_sqlite_file_without_definitions_reads_standard_types(tmp_path, written):
    bag = write_foreign(tmp_path / "bag", bench_run(), StoragePlugin.SQLITE3)
    database = sqlite3.connect(bag / "bag.db3")
    database.execute("DROP TABLE message_definitions")
    database.commit()
    database.close()
    standard = """duty: {topic: /joint_states, field: "velocity[elbow]", scale: 0.05}
position: {topic: /joint_states, field: "position[elbow]"}
"""
    recording = read_recording(bag, signals=written(standard))
    np.testing.assert_allclose(recording.command.values, 0.05 * 10 * recording.measured)
    assert "bench/msg/Command has no definition in the file" in refusal(bag, written(MAP))


def test_stamps_of_the_messages_count_and_their_way_does_not(tmp_path, written):
    bag = write_foreign(tmp_path / "bag", bench_run(late=lambda k: 0.002 + 0.003 * (k % 3)))
    np.testing.assert_allclose(read_recording(bag, signals=written(MAP)).time, 0.01 * np.arange(60), atol=1e-9)
    assert read_recording(bag, signals=written(MAP), time="log").time[1] == pytest.approx(0.013)


@pytest.mark.parametrize("field", ["header.stamp", "micros, unit: us"])
def test_the_time_may_be_any_field(tmp_path, written, field):
    bag = write_foreign(tmp_path / "bag", bench_run(late=lambda k: 0.004 * (k % 2)))
    text = MAP + f"time: {{topic: /motor/command, field: {field}}}\n"
    recording = read_recording(bag, signals=written(text))
    np.testing.assert_allclose(recording.command.time, 0.01 * np.arange(60), atol=1e-9)


def test_a_time_that_is_none_is_refused(tmp_path, written):
    bag = write_foreign(tmp_path / "bag", bench_run(5))
    text = MAP + "time: {topic: /motor/command, field: header}\n"
    assert "holds no number in header, expected one" in refusal(bag, written(text))
    wrong = text.replace("header", "micros, unit: s")
    assert "has times from two clocks: /joint_states (stamp) and /motor/command (stamp)" in refusal(bag, written(wrong))


def test_a_joint_on_a_topic_that_others_share(tmp_path, written):
    """Two drivers publish their joints on one topic: each message tells of one arm, and the order of joints differs."""
    messages = []
    for k in range(40):
        time = 1000.0 + 0.01 * k
        order = {"wrist": 5.0, "elbow": 0.1 * k} if k % 2 else {"elbow": 0.1 * k, "wrist": 5.0}
        messages.append(("/joint_states", "sensor_msgs/msg/JointState", time, joints(time, **order)))
        messages.append(("/joint_states", "sensor_msgs/msg/JointState", time + 0.001, joints(time, gripper=7.0)))
        messages.append(("/duty", FLOAT64, time, T[FLOAT64](0.1)))
    bag = write_foreign(tmp_path / "bag", messages)
    text = 'position: {topic: /joint_states, field: "position[elbow]"}\n'
    recording = read_recording(bag, signals=written(text))
    np.testing.assert_allclose(recording.measured, 0.1 * np.arange(40))
    assert recording.losses == ()
    assert "no message of /joint_states has position[elbo] (found: elbow, wrist)" in refusal(
        bag, written(text.replace("elbow", "elbo"))
    )


def test_a_topic_of_one_number_needs_no_field_and_no_type(tmp_path):
    messages = []
    for k in range(20):
        messages.append(("/pwm", "std_msgs/msg/Float32", 1000 + 0.01 * k, T["std_msgs/msg/Float32"](0.5)))
        messages.append(("/hall_voltage", "std_msgs/msg/Float32", 1000 + 0.01 * k, T["std_msgs/msg/Float32"](k / 4)))
    bag = write_foreign(tmp_path / "bag", messages)
    recording = read_recording(bag, topics={"duty": "/pwm"})
    np.testing.assert_array_equal(recording.measured, np.arange(20) / 4)


@given(
    scale=st.floats(1e-3, 1e3),
    offset=st.floats(-10.0, 10.0),
    sign=st.sampled_from((1, -1)),
    unit=st.sampled_from((("V", 1.0), ("mV", 1e-3), ("kV", 1e3))),
    decimal=st.booleans(),
)
def test_a_map_undoes_what_was_done_to_the_numbers(tmp_path_factory, scale, offset, sign, unit, decimal):
    """Written as (value - offset) / (sign unit scale) and read by the map: the plain recording to rounding."""
    folder = tmp_path_factory.mktemp("property")
    values = np.linspace(0.42, 4.52, 25)
    raw = (values - offset) / (sign * unit[1] * scale)
    rows = [f"{10 * k};{0.5 * k!r};{number!r}" for k, number in enumerate(raw.tolist())]
    text = "t;pwm;adc\n" + "\n".join(rows)
    path = folder / "run.csv"
    path.write_text(text.replace(".", ",") if decimal else text)
    (folder / "map.yaml").write_text(
        f"time: {{column: t, unit: ms}}\nduty: {{column: pwm, unit: percent}}\n"
        f"hall_voltage: {{column: adc, unit: {unit[0]}, scale: {scale!r}, offset: {offset!r}, sign: {sign}}}\n"
    )
    recording = read_recording(path, signals=folder / "map.yaml")
    np.testing.assert_allclose(recording.measured, values, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(recording.time, 0.01 * np.arange(25), atol=1e-12)
    np.testing.assert_allclose(recording.command.values, 0.005 * np.arange(25), atol=1e-15)


@given(
    scale=st.floats(1e-3, 1e3),
    offset=st.floats(-10.0, 10.0),
    sign=st.sampled_from((1, -1)),
    unit=st.sampled_from((("rad", 1.0), ("deg", np.pi / 180), ("mrad", 1e-3), ("rev", 2 * np.pi))),
)
@settings(max_examples=20)
def test_a_map_of_a_bag_gives_the_plain_recording(tmp_path_factory, scale, offset, sign, unit):
    folder = tmp_path_factory.mktemp("property")
    plain, raw = [], []
    for k in range(25):
        time, angle = 1000.0 + 0.01 * k, 0.06 * k
        number = (angle - offset) / (sign * unit[1] * scale)
        duty = ("/duty", FLOAT64, time, T[FLOAT64](0.01 * k))
        plain += [("/position", FLOAT64, time, T[FLOAT64](angle)), duty]
        raw += [("/encoder", "bench/msg/Board", time, board(number, 0)), duty]
    first = read_recording(write_foreign(folder / "plain", plain))
    entry = {"topic": "/encoder", "field": "channels[supply].volts", "unit": unit[0]}
    signals = {"position": {**entry, "scale": scale, "offset": offset, "sign": sign}}
    second = read_recording(write_foreign(folder / "raw", raw), signals=signals)
    np.testing.assert_allclose(second.measured, first.measured, rtol=1e-12, atol=1e-12)
    np.testing.assert_array_equal(second.time, first.time)
    np.testing.assert_array_equal(second.command.values, first.command.values)


def test_what_a_map_does_not_name_changes_nothing(tmp_path, written):
    text = "std_msgs/msg/String"
    logs = [
        (topic, text, 1000.0 + 0.05 * k, T[text]("armature_resistance 4.7"))
        for k in range(12)
        for topic in ("/rosout", "/parameter_events", "/diagnostics")
    ]
    few = write_foreign(tmp_path / "few", bench_run())
    many = write_foreign(tmp_path / "many", sorted(bench_run() + logs, key=lambda message: message[2]))
    plain, noisy = (read_recording(bag, signals=written(MAP)) for bag in (few, many))
    np.testing.assert_array_equal(plain.measured, noisy.measured)
    np.testing.assert_array_equal(plain.command.values, noisy.command.values)
    np.testing.assert_array_equal(plain.time, noisy.time)
    assert plain.losses == noisy.losses


@pytest.mark.parametrize(
    ("unit", "first", "step"),
    [("s", 0.0, 0.01), ("ms", 5.0, 10.0), ("us", 1.7e15, 1e4), ("ns", 1.7e18, 1e7), ("s", 1.7e9, 0.01)],
)
def test_times_in_every_unit_from_zero_or_since_1970(tmp_path, written, unit, first, step):
    rows = "".join(f"{first + step * k:.6f},{k / 100},{k}\n" for k in range(30))
    (tmp_path / "run.csv").write_text("stamp,duty,hall_voltage\n" + rows)
    recording = read_recording(tmp_path / "run.csv", signals=written(f"time: {{column: stamp, unit: {unit}}}\n"))
    np.testing.assert_allclose(recording.time, 0.01 * np.arange(30), atol=1e-6)


def test_stamps_of_ros_in_two_columns(tmp_path, written):
    nanoseconds = 990_000_000 + 5_000_000 * np.arange(30)
    rows = "".join(
        f"{1700000000 + each // 10**9},{each % 10**9},0.1,{k}\n" for k, each in enumerate(nanoseconds.tolist())
    )
    (tmp_path / "run.csv").write_text("stamp.sec,stamp.nanosec,duty,hall_voltage\n" + rows)
    recording = read_recording(tmp_path / "run.csv", signals=written("time: {column: [stamp.sec, stamp.nanosec]}\n"))
    np.testing.assert_allclose(recording.time, 0.005 * np.arange(30), atol=1e-9)


def test_signals_in_files_of_their_own_and_in_parts(tmp_path, written):
    folder = tmp_path / "bench"
    folder.mkdir()
    for part in range(3):
        rows = "".join(f"{0.1 * k:.1f},0.5,{k}\n" for k in range(10 * part, 10 * part + 10))
        (folder / f"run_{part}.csv").write_text("time,pwm,hall\n" + rows)
    (folder / "battery.csv").write_text("time,vbat\n0.0,13.5\n1.5,12.5\n")
    parts = "file: [run_0.csv, run_1.csv, run_2.csv]"
    text = (
        f"duty: {{column: pwm, {parts}}}\nhall_voltage: {{column: hall, {parts}}}\n"
        "supply_voltage: {column: vbat, file: battery.csv}\n"
    )
    recording = read_recording(folder, signals=written(text))
    np.testing.assert_array_equal(recording.measured, np.arange(30))
    np.testing.assert_allclose(recording.supply_voltage.time, [0.0, 1.5])
    beside = read_recording(
        folder / "run_0.csv",
        signals=written("duty: {column: pwm}\nhall_voltage: {column: hall}\n" + text.splitlines()[2] + "\n"),
    )
    np.testing.assert_allclose(beside.supply_voltage.at(beside.time), 13.5)
    assert "has a clock running backwards" in refusal(
        folder, written(text.replace("[run_0.csv, run_1.csv", "[run_1.csv, run_0.csv"))
    )
    assert "names no file, and a folder is given" in refusal(folder, written(text.replace(f"pwm, {parts}", "pwm")))
    assert "run_9.csv does not exist" in refusal(folder, written(text.replace("run_0.csv", "run_9.csv")))


@pytest.mark.parametrize(
    ("entry", "said"),
    [
        ("{topic: /motor/comand, field: x}", "has no topic /motor/comand for duty (found: /board, /joint_states"),
        ("{topic: /motor/comand, field: x}", "Did you mean /motor/command?"),
        ("{column: pwm}", "signals.yaml line 1: duty names a column, bag has topics"),
        ("{topic: /motor/command}", "holds several numbers, expected one. Say which with field: one of"),
        ("{topic: /motor/command, field: pmw.data}", "has no field pmw, expected one of"),
        ("{topic: /motor/command, field: pmw.data}", "Did you mean pwm.data[]?"),
        ("{topic: /motor/command, field: pwm}", "holds several numbers in pwm, expected one"),
        ("{topic: /motor/command, field: pwm.data}", "has 4 elements in pwm.data, expected one. Choose it, as"),
        ("{topic: /motor/command, field: 'pwm.data[9]'}", "has fewer elements than pwm.data[9] asks for"),
        ("{topic: /motor/command, field: 'micros[2]'}", "micros of /motor/command is no array"),
        ("{topic: /motor/command, field: header.frame_id}", "header.frame_id of /motor/command is a text"),
        ("{topic: /board, field: channels}", "channels of /board is a list of bench/msg/Channel, expected one number"),
        ("{topic: /board, field: 'channels[x].volts'}", "no message of /board has channels[x].volts (found: spare"),
        ("{topic: /joint_states, field: position}", "has 2 elements in position (shoulder, elbow), expected one."),
        ("{topic: /joint_states}", "holds several numbers, expected one"),
    ],
)
def test_what_a_map_asks_for_and_a_bag_has_not(tmp_path, written, entry, said):
    bag = write_foreign(tmp_path / "bag", bench_run(5))
    text = f'duty: {entry}\nposition: {{topic: /joint_states, field: "position[elbow]"}}\n'
    assert said in refusal(bag, written(text))


def test_the_time_may_be_a_clock(tmp_path, written):
    messages = []
    for k in range(40):
        log, simulated = 1000 + 0.02 * k, stamp(5.0 + 0.01 * k)
        messages.append(("/sim/time", "rosgraph_msgs/msg/Clock", log, T["rosgraph_msgs/msg/Clock"](simulated)))
        messages += [(topic, FLOAT64, log + 0.001, T[FLOAT64](0.1)) for topic in ("/duty", "/hall_voltage")]
    bag = write_foreign(tmp_path / "bag", messages)
    recording = read_recording(bag, signals=written("time: {topic: /sim/time, field: clock}\n"))
    assert recording.time_source == "clock"
    np.testing.assert_allclose(recording.time, 0.01 * np.arange(40), atol=1e-9)


def test_joints_of_others_do_not_matter_beside_what_a_person_chose(tmp_path, written):
    messages = []
    for k in range(20):
        time = 1000 + 0.01 * k
        for arm in ("/left/joint_states", "/right/joint_states"):
            messages.append((arm, "sensor_msgs/msg/JointState", time, joints(time, elbow=1.0)))
        messages += [(topic, FLOAT64, time, T[FLOAT64](0.1)) for topic in ("/bench/pwm", "/bench/angle")]
    bag = write_foreign(tmp_path / "bag", messages)
    recording = read_recording(bag, signals=written("duty: {topic: /bench/pwm}\nposition: {topic: /bench/angle}\n"))
    assert recording.time.size == 20 and recording.time_source == "publish"
    hall = "duty: {topic: /bench/pwm}\nhall_voltage: {topic: /bench/angle}\n"
    assert read_recording(bag, signals=written(hall)).time.size == 20
    with pytest.raises(InputError, match="has 2 topics for joint_states"):
        read_recording(bag)


def test_stamps_that_no_signal_shares_are_refused(tmp_path, written):
    messages = [("/other", "std_msgs/msg/Header", 1000 + k / 7, header(1000 + k / 7)) for k in range(9)]
    for k in range(20):
        messages += [(topic, FLOAT64, 1000 + 0.01 * k, T[FLOAT64](0.1)) for topic in ("/duty", "/hall_voltage")]
    bag = write_foreign(tmp_path / "bag", messages)
    said = refusal(bag, written("time: {topic: /other, field: stamp}\n"))
    assert "names stamps of /other, which no signal shares" in said


def test_a_message_that_is_not_of_its_type_is_named(tmp_path, written):
    with Writer(tmp_path / "bag", version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        connection = writer.add_connection("/motor/command", "bench/msg/Command", typestore=STORE)
        writer.write(connection, 10**9, b"\x00\x01\x00\x00" + bytes(7))
    assert "/motor/command: message 0 is not the bench/msg/Command that the file defines" in refusal(
        tmp_path / "bag", written('position: {topic: /motor/command, field: "pwm.data[0]"}\n')
    )


def test_a_chosen_signal_without_values_is_refused(tmp_path, write_bag, run):
    bag = write_bag(run(), battery="float")
    with pytest.raises(InputError, match=r"signals: supply_voltage: run.mcap has no messages on /battery, expected"):
        read_recording(bag, signals={"supply_voltage": {"topic": "/battery"}})
    (tmp_path / "run.csv").write_text("time,duty,position,vbat\n0,0,0,\n1,0,1,\n")
    with pytest.raises(InputError, match=r"^run.csv has nothing in the column vbat, expected values of supply_voltage"):
        read_recording(tmp_path / "run.csv", topics={"supply_voltage": "vbat"})
    assert read_recording(bag, signals={"supply_voltage": None, "temperature": None}).supply_voltage is None


def test_one_decimal_mark_a_table(tmp_path, written):
    (tmp_path / "run.csv").write_text("time;duty;hall_voltage\n0,0;0,5;1.25\n0,1;0,5;1,5\n")
    with pytest.raises(InputError, match=r"has '1.25' in row 2 and '0,0' in row 2, expected one mark before"):
        read_recording(tmp_path / "run.csv")
