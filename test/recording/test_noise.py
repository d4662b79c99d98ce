"""The noise estimated from a signal alone."""

import numpy as np
import pytest

from pierburg_ros.recording.noise import noise_of


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
