"""Times of samples from clocks of every pace."""

import numpy as np

from pierburg_ros.nodes.core.sample_time import SampleTime, StampTime

MS = 1_000_000


def played(clock_every, samples=2000, stops_at=None, pace=1.0):
    """Times [ms] given to samples 2 ms apart, a clock being read every `clock_every` [ms] until it stops."""
    times, found, read = SampleTime(), [], 0.0
    for k in range(samples):
        sent = 2.0 * k
        while read <= sent and (stops_at is None or read < stops_at):
            times.reading(round(read * MS) - 1000, round((1000.0 + pace * read) * MS))
            read += clock_every
        found.append(times.at(round(sent * MS)) / MS)
    return np.array(found)


def test_a_clock_that_ticks_for_every_sample_gives_its_readings_exactly():
    assert np.array_equal(played(2.0, pace=3.0), 1000.0 + 6.0 * np.arange(2000))


def test_between_the_ticks_of_a_slow_clock_time_goes_on_evenly():
    steps = np.diff(played(25.0))[100:]
    assert np.all(np.abs(steps - 2.0) < 1.1)
    assert abs(np.mean(steps) - 2.0) < 0.02


def test_slow_and_fast_simulated_time_is_followed_at_its_pace():
    steps = np.diff(played(25.0, pace=0.5))[100:]
    assert abs(np.mean(steps) - 1.0) < 0.02


def test_a_clock_that_stops_lets_time_stand():
    times = played(25.0, stops_at=2000.0)
    assert np.all(np.diff(times[1100:]) == 0.0)
    assert times[-1] < 1000.0 + 2000.0 + 30.0


def test_a_sample_sent_again_with_its_reading_has_its_time_again():
    times = SampleTime()
    for _ in range(3):
        times.reading(5 * MS, 7 * MS)
        assert times.at(6 * MS) == 7 * MS


def test_a_clock_set_back_a_long_way_goes_back():
    times = SampleTime()
    for k in range(10):
        times.reading(2 * k * MS, (5000 + 2 * k) * MS)
        times.at(2 * k * MS + 1)
    times.reading(20 * MS, 2 * MS)
    assert times.at(20 * MS + 1) == 2 * MS


def test_without_a_reading_there_is_no_time():
    assert SampleTime().at(5) is None


def test_stamps_that_are_set_back_stand_still_and_go_on():
    stamps = StampTime()
    assert [stamps.at(each) for each in (10, 12, 5, 7, 9)] == [10, 12, 12, 14, 16]
    assert stamps.steps_back == 1
