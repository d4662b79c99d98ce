"""The noise estimated from a signal alone."""

import numpy as np
import pytest

from pierburg_ros.recording.noise import noise_of, rounding_of, white_part


@pytest.mark.parametrize("noise", [0.001, 0.004])
def test_noise_of_a_moving_signal_is_found(noise: float) -> None:
    time = np.arange(0.0, 20.0, 0.002)
    signal = 2.0 + np.abs(np.sin(time)) + noise * np.random.default_rng(3).standard_normal(time.size)
    assert noise_of(time, signal) == pytest.approx(noise, rel=0.03)


def test_noise_of_a_rounded_signal_includes_the_rounding() -> None:
    time = np.arange(0.0, 20.0, 0.002)
    step = 0.00122
    signal = np.round((2.0 + np.sin(time) + 0.001 * np.random.default_rng(4).standard_normal(time.size)) / step) * step
    assert noise_of(time, signal) == pytest.approx(np.hypot(0.001, step / np.sqrt(12.0)), rel=0.05)


def test_gaps_do_not_count_as_noise() -> None:
    time = np.arange(0.0, 20.0, 0.002)
    kept = np.random.default_rng(5).random(time.size) > 0.1
    signal = 2.0 + np.sin(3.0 * time) + 0.003 * np.random.default_rng(6).standard_normal(time.size)
    assert noise_of(time[kept], signal[kept]) == pytest.approx(0.003, rel=0.05)


def test_a_converter_does_not_bend_the_estimate() -> None:
    """Third differences of a rounded signal are whole steps: many are alike where the farthest tenth begins."""
    time = np.arange(0.0, 60.0, 0.002)
    step, noise = 5.0 / 4096.0, 0.002
    found = []
    for seed in range(8):
        white = noise * np.random.default_rng(seed).standard_normal(time.size)
        found.append(noise_of(time, np.round((2.0 + np.sin(time) + white) / step) * step))
    assert np.mean(found) == pytest.approx(np.hypot(noise, step / np.sqrt(12.0)), rel=0.015)


def test_the_white_part_is_what_changes_from_sample_to_sample() -> None:
    slow = np.sin(np.arange(20000) / 200.0)
    white = 0.01 * np.random.default_rng(1).standard_normal(slow.size)
    assert white_part(slow + white) == pytest.approx(0.01, rel=0.03)
    assert white_part(np.zeros(100)) == 0.0
    assert white_part(np.zeros(3)) == 0.0


def test_rounding_is_that_of_the_smallest_step() -> None:
    assert rounding_of(np.array([0.0, 0.3, 0.1, 0.3])) == pytest.approx(0.1 / np.sqrt(12.0))
    assert rounding_of(np.ones(5)) == 0.0
