"""The covariance of a fit against statistics with a closed form."""

import numpy as np
import pytest

from pierburg_ros.inference.covariance import at_least_effective, correlation_length, covariance_of


def autoregressive(size, memory, seed):
    """First-order autoregressive noise of unit innovation."""
    innovation = np.random.default_rng(seed).standard_normal(size)
    noise = np.empty(size)
    noise[0] = innovation[0]
    for index in range(1, size):
        noise[index] = memory * noise[index - 1] + innovation[index]
    return noise


def test_white_noise_gives_the_classical_deviation_of_a_mean():
    residual = 0.003 * np.random.default_rng(0).standard_normal(20_000)
    found = covariance_of(-np.ones((residual.size, 1)), (residual,))
    assert found.white
    assert np.sqrt(found.matrix[0, 0]) == pytest.approx(0.003 / np.sqrt(20_000), rel=0.02)


def test_correlated_noise_widens_the_deviation_as_theory_says():
    memory, size = 0.9, 100_000
    residual = autoregressive(size, memory, 1)
    residual -= residual.mean()
    found = covariance_of(-np.ones((size, 1)), (residual,))
    # Variance of the mean of first-order autoregressive noise: innovation / (1 - memory)^2 / size.
    expected = 1.0 / (1.0 - memory) / np.sqrt(size)
    assert not found.white
    assert np.sqrt(found.matrix[0, 0]) == pytest.approx(expected, rel=0.15)


def test_white_noise_has_no_correlation_length_and_slow_noise_a_long_one():
    assert correlation_length(np.random.default_rng(3).standard_normal(10_000)) == 1
    # 0.9^28 is below 0.05.
    assert 15 <= correlation_length(autoregressive(100_000, 0.9, 4)) <= 45


def test_a_direction_without_data_is_undetermined():
    random = np.random.default_rng(5)
    column = random.standard_normal(1000)
    jacobian = np.column_stack([column, 2.0 * column, random.standard_normal(1000)])
    found = covariance_of(jacobian, (random.standard_normal(1000),))
    assert found.undetermined.tolist() == [True, True, False]


def test_what_two_recordings_say_is_not_mixed():
    """Slow noise within each of many recordings, none between them: the mean is known by their number."""
    lines = np.random.default_rng(6).standard_normal(400)
    parts = tuple(np.full(50, level) for level in lines - lines.mean())
    found = covariance_of(-np.ones((400 * 50, 1)), parts)
    assert not found.white
    assert found.blocks == 400
    assert np.sqrt(found.matrix[0, 0]) == pytest.approx(np.std(lines, ddof=1) / np.sqrt(400), rel=0.01)


def test_few_blocks_leave_more_doubt():
    """Student's factor for 95 % is 2.57 with 5 degrees of freedom, and 1.96 with many."""
    lines = np.random.default_rng(7).standard_normal(6)
    few = covariance_of(-np.ones((300, 1)), tuple(np.full(50, level) for level in lines - lines.mean()))
    assert few.factor == pytest.approx(2.571, abs=0.001)
    assert covariance_of(-np.ones((300, 1)), (np.random.default_rng(8).standard_normal(300),)).factor < 1.97


def test_sums_over_a_single_block_do_not_make_a_value_exact():
    """One transient in a recording: at the minimum its sum with each slope is zero, whatever it did to the value."""
    time = np.linspace(0.0, 6.0, 3000)
    transient = 40.0 * np.exp(-time / 0.9)
    slopes = np.stack([np.ones(time.size), np.sin(3.0 * time)], axis=1)
    left = transient - slopes @ np.linalg.lstsq(slopes, transient, rcond=None)[0]
    few, kept = covariance_of(slopes, (left,)), at_least_effective(slopes, (left,))
    assert few.blocks <= 3
    assert np.diagonal(few.matrix).max() < 1e-9
    # the transient moves the values by some units, which no noise could do
    assert np.sqrt(np.diagonal(kept.matrix)).min() > 0.3


def test_where_blocks_vary_more_the_sandwich_stays():
    random = np.random.default_rng(9)
    slow = autoregressive(50_000, 0.9, 9)
    slopes = np.stack([autoregressive(50_000, 0.9, 10), random.standard_normal(50_000)], axis=1)
    found, classical = covariance_of(slopes, (slow,)), at_least_effective(slopes, (slow,))
    assert found.matrix[0, 0] <= classical.matrix[0, 0] * 1.0001
