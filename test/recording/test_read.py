"""A recording is read by the meaning of its topics, whatever their namespace, order and storage."""

from pathlib import Path

import numpy as np
import pytest
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

from pierburg_ros.errors import InputError
from pierburg_ros.recording import read_recording

XL330 = Path(__file__).parents[2] / "../shared/data/xl330"


def test_reads_hall_voltage_and_duty_under_any_namespace(write_bag, run):
    recording = read_recording(write_bag(run(hall="/bench/a/hall_voltage", duty="/bench/a/duty")))
    assert recording.quantity == "hall_voltage" and recording.unit == "V"
    np.testing.assert_allclose(recording.time, 0.01 * np.arange(50), atol=1e-9)
    np.testing.assert_array_equal(recording.measured, np.arange(50.0))
    np.testing.assert_allclose(recording.command.time, 0.01 * np.arange(50) + 0.001, atol=1e-9)
    np.testing.assert_array_equal(recording.command.values, np.arange(50) / 1000)


def test_reads_topics_that_a_person_names(write_bag, run):
    path = write_bag(run(hall="/angle_sensor", duty="/bench/pwm"))
    recording = read_recording(path, topics={"hall_voltage": "/angle_sensor", "duty": "/bench/pwm"})
    assert recording.measured[-1] == 49.0 and recording.command.values[-1] == pytest.approx(0.049)


def test_reads_position_and_every_optional_signal(write_bag, message):
    messages = [
        message("/enabled", "bool", 999.5, 999.5, 0, True),
        message("/setpoints", "float", 1000, 1000, 0, 0.7),
    ]
    for k in range(20):
        time = 1000 + 0.01 * k
        messages += [
            message("/joint_states", "joint", time, time, k, (time, 0.1 * k)),
            message("/duty", "float", time, time, k, 0.2),
            message("/supply_voltage", "float", time, time, k, 7.0 + k),
            message("/temperature", "float", time, time, k, 30.0 + k),
        ]
    messages.append(message("/enabled", "bool", 1000.2, 1000.2, 1, False))
    recording = read_recording(write_bag(messages))
    assert recording.quantity == "position" and recording.unit == "rad"
    np.testing.assert_allclose(recording.measured, 0.1 * np.arange(20))
    np.testing.assert_allclose(recording.supply_voltage.values, 7.0 + np.arange(20))
    np.testing.assert_allclose(recording.temperature.values, 30.0 + np.arange(20))
    np.testing.assert_allclose(recording.enabled.time, [-0.5, 0.2], atol=1e-9)
    np.testing.assert_array_equal(recording.enabled.values, [1.0, 0.0])
    np.testing.assert_array_equal(recording.setpoints.values, [0.7])


def test_hall_voltage_wins_over_position(write_bag, run, message):
    joints = [
        message("/joint_states", "joint", 1000 + 0.1 * k, 1000 + 0.1 * k, k, (1000 + 0.1 * k, 9.0)) for k in range(3)
    ]
    recording = read_recording(write_bag(run() + joints))
    assert recording.quantity == "hall_voltage" and recording.time.size == 50


def test_applied_duty_is_the_input_unless_a_duty_is_named(write_bag, run, message):
    applied = [message("/applied_duty", "float", 1000 + 0.01 * k, 1000 + 0.01 * k, k, 0.5) for k in range(50)]
    path = write_bag(sorted(run() + applied, key=lambda item: item.log))
    assert set(read_recording(path).command.values) == {0.5}
    assert read_recording(path, topics={"duty": "/duty"}).command.values[-1] == pytest.approx(0.049)


def test_takes_the_shaft_among_several_joints(write_bag, run, message):
    duty = [item for item in run() if item.topic == "/duty"]
    joints = [
        message("/joint_states", "joint", item.log, item.log, k, (item.log, {"arm": 5.0, "swirl_shaft": 0.01 * k}))
        for k, item in enumerate(duty)
    ]
    np.testing.assert_allclose(read_recording(write_bag(duty + joints)).measured, 0.01 * np.arange(50))
    nameless = [item._replace(value=(item.log, {"arm": 5.0, "leg": 1.0})) for item in joints]
    with pytest.raises(InputError, match=r"/joint_states has 2 positions \(joints: arm, leg\), expected one joint"):
        read_recording(write_bag(duty + nameless))


def test_the_shaft_is_found_in_every_order_of_joints(write_bag, run, message):
    """Messages of one length, in which the same names stand in another order."""
    duty = [item for item in run() if item.topic == "/duty"]
    joints = []
    for k, item in enumerate(duty):
        values = {"arm": 5.0, "swirl_shaft": 0.01 * k}
        joints.append(message("/joint_states", "joint", item.log, item.log, k, (item.log, values)))
        if k % 2:
            joints[-1] = joints[-1]._replace(value=(item.log, dict(reversed(values.items()))))
    np.testing.assert_allclose(read_recording(write_bag(duty + joints)).measured, 0.01 * np.arange(50))


def test_reads_big_endian_messages(write_bag, run, tmp_path):
    store = get_typestore(Stores.ROS2_JAZZY)
    swapped = store.serialize_cdr(store.types["std_msgs/msg/Float64"](2.5), "std_msgs/msg/Float64", little_endian=False)
    assert bytes(swapped[:2]) == b"\x00\x00"
    with Writer(tmp_path / "bag", version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        for topic in ("/hall_voltage", "/duty"):
            connection = writer.add_connection(topic, "std_msgs/msg/Float64", typestore=store)
            for k in range(3):
                value = swapped if topic == "/hall_voltage" else b"\x00\x01\x00\x00" + bytes(8)
                writer.write(connection, 10**9 + k * 10**7, value)
    np.testing.assert_array_equal(read_recording(tmp_path / "bag").measured, [2.5, 2.5, 2.5])


@pytest.mark.parametrize("plugin", [StoragePlugin.MCAP, StoragePlugin.SQLITE3])
def test_reads_rosbag2_directories(tmp_path, plugin):
    store = get_typestore(Stores.ROS2_JAZZY)
    with Writer(tmp_path / "bag", version=9, storage_plugin=plugin) as writer:
        links = {
            t: writer.add_connection(t, "std_msgs/msg/Float64", typestore=store) for t in ("/hall_voltage", "/duty")
        }
        for k in range(10):
            for topic, value in (("/hall_voltage", 0.1 * k), ("/duty", 0.01 * k)):
                data = store.serialize_cdr(store.types["std_msgs/msg/Float64"](value), "std_msgs/msg/Float64")
                writer.write(links[topic], 10**9 + k * 10**7, data)
    recording = read_recording(tmp_path / "bag")
    np.testing.assert_allclose(recording.time, 0.01 * np.arange(10), atol=1e-9)
    np.testing.assert_allclose(recording.measured, 0.1 * np.arange(10))
    np.testing.assert_allclose(recording.command.values, 0.01 * np.arange(10))


def test_reads_what_a_killed_writer_left(write_bag, run, tmp_path):
    whole = write_bag(run(count=900), chunk_size=1024)
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(whole.read_bytes()[: whole.stat().st_size // 2])
    full, part = read_recording(whole), read_recording(cut)
    assert 300 < part.time.size < full.time.size
    np.testing.assert_array_equal(part.measured, full.measured[: part.time.size])


def test_topics_outside_the_contract_change_nothing(write_bag, run, message):
    logs = [message("/rosout", "text", 1000 + 0.01 * k, 1000 + 0.01 * k, k, "secret") for k in range(50)]
    plain = read_recording(write_bag(run(), "plain.mcap"))
    noisy = read_recording(write_bag(sorted(run() + logs, key=lambda item: item.log), "noisy.mcap"))
    np.testing.assert_array_equal(plain.measured, noisy.measured)
    np.testing.assert_array_equal(plain.command.time, noisy.command.time)


@pytest.mark.skipif(not XL330.exists(), reason="the measured XL330 runs are not beside this checkout")
def test_reads_a_measured_run():
    recording = read_recording(XL330 / "kp100_lift_and_drop.mcap")
    assert recording.quantity == "position" and 5.9 < recording.duration < 6.1
    assert set(recording.enabled.values) == {0.0, 1.0}
    assert 5.0 < recording.supply_voltage.values.min() < recording.supply_voltage.values.max() < 9.5
    step = 2 * np.pi / 4096
    np.testing.assert_allclose(recording.measured / step, np.round(recording.measured / step), atol=1e-6)
