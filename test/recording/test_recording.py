"""A window of a recording keeps what acts on it; a channel holds its values."""

from dataclasses import replace

import numpy as np
import pytest

from pierburg_ros.errors import InputError
from pierburg_ros.recording import Channel, Recording


@pytest.fixture
def recording():
    return Recording(
        "made",
        "hall_voltage",
        0.1 * np.arange(101),
        np.arange(101.0),
        Channel(np.array([-1.0, 2.0, 6.0]), np.array([0.1, 0.2, 0.3])),
        enabled=Channel(np.array([9.0]), np.array([0.0])),
    )


def test_a_channel_holds_each_value_until_the_next():
    channel = Channel(np.array([1.0, 2.0, 2.0]), np.array([5.0, 6.0, 7.0]))
    assert channel.at(np.array([0.0, 1.0, 1.999, 2.0, 9.0])).tolist() == [5.0, 5.0, 5.0, 7.0, 7.0]
    assert channel.at(np.array([0.0, 1.0]), before=0.0).tolist() == [0.0, 5.0]


def test_a_window_keeps_the_duty_in_force_at_its_start(recording):
    window = recording.select(4.0, 7.0)
    np.testing.assert_allclose(window.time[[0, -1]], [0.0, 3.0])
    np.testing.assert_array_equal(window.measured, np.arange(40.0, 71.0))
    np.testing.assert_allclose(window.command.time, [-2.0, 2.0])
    np.testing.assert_array_equal(window.command.values, [0.2, 0.3])
    assert window.name == "made" and window.duration == pytest.approx(3.0)


def test_a_window_holds_the_same_inputs_as_the_whole(recording):
    window = recording.select(1.0, 9.5)
    np.testing.assert_array_equal(window.command.at(window.time), recording.command.at(window.time + 1.0))
    np.testing.assert_array_equal(window.enabled.at(window.time), recording.enabled.at(window.time + 1.0))


def test_a_window_without_samples_is_refused(recording):
    with pytest.raises(InputError, match=r"made has no two samples from 20 to 30 s\. Choose a longer window"):
        recording.select(20.0, 30.0)


def test_a_sample_sent_again_counts_once(recording):
    """A plant in lockstep sends its sample again until a reply comes."""
    again = np.sort(np.concatenate([np.arange(101), [0, 0, 7]]))
    sent = replace(recording, time=recording.time[again], measured=recording.measured[again])
    np.testing.assert_array_equal(sent.time, recording.time)
    np.testing.assert_array_equal(sent.measured, recording.measured)


def test_samples_that_share_a_time_are_refused(recording):
    coarse = np.floor(recording.time)
    with pytest.raises(InputError, match=r"90 samples of hall_voltage with the time of the sample before and another"):
        replace(recording, time=coarse)
