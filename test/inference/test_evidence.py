"""How residuals count."""

import numpy as np
import pytest
from scipy.signal import lfilter

from pierburg_ros.inference.evidence import (
    beyond,
    certainty,
    coarse_step,
    grid,
    lasting_rounding,
    probability,
    repetition,
    structure,
)

RANDOM = np.random.default_rng(5)
WHITE = RANDOM.standard_normal(20_000)


def test_a_sample_of_white_noise_counts_as_one():
    assert repetition(WHITE) == pytest.approx(1.0, abs=0.1)


def test_a_sample_of_correlated_noise_counts_less():
    # of a first-order process with coefficient a, (1 + a) / (1 - a) samples count as one
    slow = lfilter([1.0], [1.0, -0.8], WHITE)
    assert repetition(slow) == pytest.approx(9.0, rel=0.2)


def test_half_the_blocks_better_and_half_worse_is_not_sure():
    block = np.repeat(np.arange(40), 500)
    mixed = WHITE * np.where(block % 2 == 0, 1.2, 1 / 1.2)
    assert abs(certainty(mixed, WHITE, block)) < 2.0
    assert certainty(1.2 * WHITE, WHITE, block) > 10.0


def test_probability_is_that_of_a_normal_variable():
    assert probability(0.0) == 0.5
    assert probability(1.96) == pytest.approx(0.975, abs=1e-4)


def test_white_noise_has_no_structure_and_a_wave_has():
    assert structure(WHITE) < 20.0
    assert structure(WHITE + 0.2 * np.sin(np.arange(WHITE.size) / 500.0)) > 200.0


def test_an_allowed_error_is_no_structure():
    waved = WHITE + 0.2 * np.sin(np.arange(WHITE.size) / 500.0)
    assert structure(waved, allowed=0.2) < 20.0


def test_half_a_step_is_no_evidence():
    assert beyond(np.array([-0.7, 0.3, 0.5, 2.0]), 0.5) == pytest.approx([-0.2, 0.0, 0.0, 1.5])


def test_a_coarse_step_is_seen_and_a_fine_one_is_not():
    values = np.cumsum(RANDOM.standard_normal(2000))
    assert coarse_step([0.5 * np.round(values / 0.5)], 0.15, 0.01) == pytest.approx(0.5)
    assert coarse_step([values], 0.15, 0.01) == 0.0
    assert grid(np.array([1.0, 1.5, 2.5])) == pytest.approx(0.5)


def test_rounding_without_noise_lasts():
    values = 0.1 * np.round(np.sin(np.arange(500) / 50.0) / 0.1)
    assert lasting_rounding([values], 0.1 / np.sqrt(12.0)) == pytest.approx(0.1 / np.sqrt(12.0))
