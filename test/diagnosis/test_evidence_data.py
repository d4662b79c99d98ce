"""What the diagnosis looks at: the noise it estimates, the samples it keeps for judging."""

import numpy as np
import pytest
from recordings import NOISE, NOMINAL, PIERBURG, recording

from pierburg_ros.actuators import read_actuator
from pierburg_ros.diagnosis.evidence_data import evidence_of, noise_of, training_blocks
from pierburg_ros.errors import InputError


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


def test_a_quarter_of_the_samples_judges_in_whole_blocks() -> None:
    time = np.arange(0.0, 60.0, 0.002)
    training = training_blocks(time)
    assert np.mean(~training) == pytest.approx(0.25, abs=0.01)
    assert np.count_nonzero(np.diff(training.astype(int))) == 10


def test_the_true_model_leaves_residuals_of_size_one() -> None:
    data = evidence_of([recording({})], PIERBURG)
    assert data.noise == pytest.approx(NOISE, rel=0.03)
    assert np.std(data.residual(NOMINAL)) == pytest.approx(1.0, abs=0.03)


def test_another_actuator_is_refused() -> None:
    with pytest.raises(InputError, match=r"holds hall_voltage, but actuator xl330 measures position"):
        evidence_of([recording({})], read_actuator("xl330"))
