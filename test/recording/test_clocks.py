"""The time of a sample is its stamp, else the clock's, else publish, else log time, and never a mixture."""

import numpy as np
import pytest

from pierburg_ros.errors import InputError
from pierburg_ros.recording import read_recording

STEP = 0.002


def ticks(message, count=200, epoch=1000.0, wall=1000.0, pace=1.0, lost=(), sequence=True):
    """What a plant publishes each tick: joint states stamped `epoch` + k STEP; all arrive late."""
    found = []
    for k in range(count):
        stamp, arrival = epoch + k * STEP, wall + (k * STEP + 0.0004 + 0.0003 * (k % 3)) / pace
        for topic, kind, value in (
            ("/hall_voltage", "float", float(k)),
            ("/applied_duty", "float", k / 1000),
            ("/joint_states", "joint", (stamp, 0.5)),
        ):
            if (topic, k) not in lost:
                found.append(message(topic, kind, arrival, arrival, k if sequence else 0, value))
    return found


def duties(message, count=200, start=1000.0):
    """Commands as a controller publishes them, unstamped."""
    return [message("/duty", "float", start + k * STEP + 0.001, start + k * STEP + 0.001, k, 0.9) for k in range(count)]


def by_arrival(*groups):
    return sorted((item for group in groups for item in group), key=lambda item: item.log)


@pytest.mark.parametrize("sequence", [True, False])
def test_ticks_take_the_stamp_of_their_joint_states(write_bag, message, sequence):
    recording = read_recording(write_bag(ticks(message, sequence=sequence)))
    assert recording.time_source == "stamp"
    np.testing.assert_allclose(recording.time, STEP * np.arange(200), atol=1e-9)
    np.testing.assert_allclose(recording.command.time, STEP * np.arange(200), atol=1e-9)


def test_a_lost_message_does_not_shift_the_ones_after_it(write_bag, message):
    lost = {("/hall_voltage", 20), ("/applied_duty", 50), ("/joint_states", 90), ("/joint_states", 91)}
    recording = read_recording(write_bag(ticks(message, lost=lost)))
    assert recording.time_source == "stamp"
    np.testing.assert_allclose(recording.time, STEP * recording.measured, atol=1e-9)
    np.testing.assert_allclose(recording.command.time, STEP * 1000 * recording.command.values, atol=1e-9)
    assert recording.time.size == 199 and recording.command.time.size == 199


def test_unequal_numbers_without_sequence_fall_back_to_publish_time(write_bag, message):
    path = write_bag(ticks(message, lost={("/hall_voltage", 20)}, sequence=False))
    assert read_recording(path).time_source == "publish, stamp"


def test_joint_states_at_another_rate_lend_no_stamps(write_bag, message, run):
    joints = [
        message("/joint_states", "joint", 1000 + 0.1 * k, 1000 + 0.1 * k, k, (1000 + 0.1 * k, 0.0)) for k in range(5)
    ]
    assert read_recording(write_bag(by_arrival(run(), joints))).time_source == "publish"


def test_unstamped_messages_take_the_last_clock_before_them(write_bag, message):
    messages = [message("/duty", "float", 499.0, 499.0, 0, 0.3)]
    for k in range(20):
        wall = 500 + 0.05 * k
        messages += [
            message("/clock", "clock", wall, wall, k, 3.0 + 0.01 * k),
            message("/hall_voltage", "float", wall + 0.001, wall + 0.001, k, float(k)),
            message("/duty", "float", wall + 0.002, wall + 0.002, k + 1, 0.5),
        ]
    recording = read_recording(write_bag(messages))
    assert recording.time_source == "clock"
    np.testing.assert_allclose(recording.time, 0.01 * np.arange(20), atol=1e-9)
    assert recording.command.at(np.array([-1.0, 0.0]), before=0.0).tolist() == [0.0, 0.5]
    assert read_recording(write_bag(messages), time="publish").duration == pytest.approx(0.95)


def test_log_time_serves_where_nothing_was_published_with_a_time(write_bag, run):
    recording = read_recording(write_bag([item._replace(publish=0.0) for item in run()]))
    assert recording.time_source == "log" and recording.duration == pytest.approx(0.49)


def test_two_clocks_are_refused_and_the_choice_is_named(write_bag, message):
    """Simulated stamps beside commands that only wall time dates."""
    stamped = [item for item in ticks(message, epoch=0.0) if item.topic != "/applied_duty"]
    path = write_bag(by_arrival(stamped, duties(message)))
    with pytest.raises(
        InputError,
        match=r"run.mcap has times from two clocks: /hall_voltage \(stamp\) and /duty \(publish\) differ by"
        r" 1e\+03 s, expected one clock. Choose it with --time \{stamp,clock,publish,log\}.",
    ):
        read_recording(path)
    assert read_recording(path, time="publish").time_source == "publish"
    with pytest.raises(InputError, match=r"run\.mcap: /duty has no stamp time"):
        read_recording(path, time="stamp")


def test_a_publisher_whose_clock_is_wrong_is_refused(write_bag, run):
    shifted = [item._replace(publish=item.publish + 5.0) if item.topic == "/duty" else item for item in run()]
    path = write_bag(shifted)
    with pytest.raises(InputError, match=r"two clocks: /hall_voltage \(publish\) and /duty \(publish\) differ by 5 s"):
        read_recording(path)
    assert read_recording(path, time="log").command.time[0] == pytest.approx(0.001)


def test_a_latched_setpoint_from_before_the_recording_is_no_second_clock(write_bag, message, run):
    latched = message("/setpoints", "float", 999.9, 400.0, 0, 0.4)
    recording = read_recording(write_bag([latched, *run()]))
    assert recording.setpoints.at(recording.time).tolist() == [0.4] * 50


def test_simulated_time_faster_than_the_wall_is_one_clock(write_bag, message):
    clock = [message("/clock", "clock", 1000 + k * STEP / 10, 1000 + k * STEP / 10, k, k * STEP) for k in range(200)]
    setpoints = [message("/setpoints", "float", 1000.02, 1000.02, 0, 0.4)]
    recording = read_recording(write_bag(by_arrival(clock, ticks(message, epoch=0.0, pace=10.0), setpoints)))
    assert recording.time_source == "stamp"
    assert recording.setpoints.time[0] == pytest.approx(0.2)


@pytest.mark.parametrize(("choice", "source"), [("publish", "publish"), ("log", "log"), ("stamp", "stamp")])
def test_a_chosen_clock_is_used(write_bag, message, choice, source):
    assert read_recording(write_bag(ticks(message)), time=choice).time_source == source


def test_a_clock_that_was_not_recorded_is_refused(write_bag, run):
    with pytest.raises(InputError, match=r"run\.mcap: /hall_voltage has no clock time, expected one for every message"):
        read_recording(write_bag(run()), time="clock")
