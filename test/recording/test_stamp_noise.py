"""What stamps that are off bring into a signal."""

import numpy as np
import pytest

from pierburg_ros.recording.noise import stamp_noise

PERIOD = 0.002


def test_a_clock_that_is_even_brings_nothing():
    time = PERIOD * np.arange(5000)
    assert stamp_noise(time, 3.0 * time, 0.001) == pytest.approx(0.0, abs=1e-9)


def test_a_ramp_is_off_by_its_rate_times_the_error_of_two_stamps():
    """A ramp of 3 V/s, stamps off by 0.2 ms: 3 V/s times the root of 2 times 0.2 ms."""
    random = np.random.default_rng(0)
    true = PERIOD * np.arange(20_000)
    stamped = true + 0.0002 * random.standard_normal(true.size)
    noisy = 3.0 * true + 0.001 * random.standard_normal(true.size)
    assert stamp_noise(stamped, noisy, 0.001) == pytest.approx(3.0 * np.sqrt(2.0) * 0.0002, rel=0.03)


def test_a_shaft_at_rest_is_not_moved_by_stamps_that_are_off():
    random = np.random.default_rng(0)
    stamped = PERIOD * np.arange(20_000) + 0.0002 * random.standard_normal(20_000)
    assert stamp_noise(stamped, 0.001 * random.standard_normal(20_000), 0.001) < 2e-5


def test_a_gap_is_no_error_of_a_stamp():
    time = PERIOD * np.arange(5000)
    time[2500:] += 1.0
    assert stamp_noise(time, 3.0 * time, 0.001) == pytest.approx(0.0, abs=1e-4)
