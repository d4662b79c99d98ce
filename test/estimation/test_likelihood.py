"""What counts as evidence: not the steps of a coarse converter, and each thing once."""

from dataclasses import replace

import numpy as np
import pytest
from support.recordings import NOMINAL, data_on, recording

from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.estimator import Estimator, adequate
from pierburg_ros.estimation.likelihood import (
    CLOSE,
    EXPLAINED,
    SIGNIFICANT,
    counted,
    lasting_rounding,
    repetition,
    structure,
)
from pierburg_ros.inference.explanation import Explanation


def stepped(step: float, noise: float) -> Data:
    """A nominal recording with noise, rounded to multiples of `step`."""
    given = recording({}, duration=20.0)
    clean = data_on(given).runs[0].simulated(NOMINAL)
    values = clean + noise * np.random.default_rng(1).standard_normal(clean.size)
    return data_on(replace(given, measured=np.round(values / step) * step))


@pytest.mark.parametrize(("step", "noise"), [(0.015, 0.004), (0.02, 0.002), (0.05, 0.001)])
def test_coarse_steps_are_seen(step: float, noise: float) -> None:
    assert stepped(step, noise).step == pytest.approx(step, rel=1e-6)


@pytest.mark.parametrize(("step", "noise"), [(0.00122, 0.001), (0.00122, 0.004), (0.005, 0.004), (1e-6, 0.002)])
def test_steps_that_noise_hides_are_not(step: float, noise: float) -> None:
    assert stepped(step, noise).step == 0.0


def test_where_in_a_step_the_shaft_rests_is_no_evidence() -> None:
    everywhere = np.linspace(-0.5, 0.5, 10_001)
    assert counted(everywhere, 0.5) == pytest.approx(everywhere @ everywhere, rel=1e-3)
    for place in (0.0, 0.3, -0.5):
        assert counted(np.full(10_001, place), 0.5) == pytest.approx(counted(everywhere, 0.5))
    assert counted(np.full(12, 0.7), 0.5) == pytest.approx(12 * (0.2**2 + 1 / 12))
    assert counted(everywhere, 0.0) == pytest.approx(everywhere @ everywhere)


def test_a_valve_that_rests_off_the_middle_of_steps_is_still_explained() -> None:
    fit = Estimator(stepped(0.045, 0.001), NOMINAL).fit(Explanation())
    assert np.sqrt(fit.chi2 / fit.solution.residual.size) > EXPLAINED
    assert adequate(fit)


def test_white_residuals_count_in_full() -> None:
    for seed in range(5):
        assert repetition(np.random.default_rng(seed).standard_normal(20_000)) == pytest.approx(1.0, abs=0.1)


@pytest.mark.parametrize("times", [5, 20])
def test_what_is_said_many_times_counts_once(times: int) -> None:
    """White noise, each value held for n samples, has the autocorrelation 1 - k / n: one and twice its sum is n."""
    values = np.repeat(np.random.default_rng(6).standard_normal(40_000 // times), times)
    assert repetition(values) == pytest.approx(times, rel=0.1)


def test_white_noise_of_any_size_has_no_structure() -> None:
    for seed in range(20):
        assert structure(7.0 * np.random.default_rng(seed).standard_normal(20_000)) < 0.4 * SIGNIFICANT


def test_noise_that_a_filter_smears_has_none_either() -> None:
    noise = np.random.default_rng(3).standard_normal(20_001)
    assert structure(noise[1:] + 0.3 * noise[:-1]) < SIGNIFICANT


@pytest.mark.parametrize("length", [CLOSE * 4, 400, 2000])
def test_structure_is_the_likelihood_ratio_of_random_effects(length: int) -> None:
    """With m blocks whose means vary v times as much as those of noise it is m (v - 1 - ln v)."""
    random, size = np.random.default_rng(4), 0.3
    count = 20_000 // length
    lasting = np.repeat(random.standard_normal(count), length)
    lasting *= size / np.sqrt(np.mean(lasting**2))
    varies = 1.0 + length * size**2
    found = structure(random.standard_normal(lasting.size) + lasting)
    assert found > 0.5 * count * (varies - 1.0 - np.log(varies)) > SIGNIFICANT


def test_an_error_of_the_allowed_size_is_no_structure() -> None:
    random = np.random.default_rng(5)
    lasting = 0.3 * np.repeat(random.standard_normal(100), 200)
    residual = random.standard_normal(20_000) + lasting
    assert structure(residual) > SIGNIFICANT
    assert structure(residual, allowed=0.35) < SIGNIFICANT


def test_a_residual_of_few_samples_tells_none() -> None:
    assert structure(np.ones(3)) == structure(np.ones(100)) == 0.0


@pytest.mark.parametrize("noise", [0.0, 0.1, 0.2, 0.3, 1.0])
def test_rounding_lasts_where_little_noise_carries_samples_over_the_steps(noise: float) -> None:
    """The mean of rounded samples at each of many places, less the place."""
    random = np.random.default_rng(7)
    places = np.linspace(0.0, 10.0, 2000, endpoint=False)
    samples = np.round(places[:, None] + noise * random.standard_normal((2000, 2000)))
    seen = np.sqrt(np.mean((samples.mean(axis=1) - places) ** 2))
    told = lasting_rounding([samples.ravel()[::7]], float(np.hypot(noise, np.sqrt(1.0 / 12.0))))
    assert told == pytest.approx(seen, abs=0.07)


def test_samples_off_any_grid_are_not_rounded() -> None:
    assert lasting_rounding([np.random.default_rng(8).standard_normal(500)], 1.0) == 0.0
    assert lasting_rounding([np.ones(500)], 1.0) == 0.0


def test_an_encoder_whose_steps_are_all_its_noise_leaves_no_structure() -> None:
    """A shaft that rests between its marks reads the same for long."""
    given = recording({}, duration=20.0)
    clean = data_on(given).runs[0].simulated(NOMINAL)
    step = 0.004
    data = data_on(replace(given, measured=np.round(np.round(clean / step) * step, 5)))
    fit = Estimator(data, NOMINAL).fit(Explanation())
    assert structure(fit.solution.residual) > SIGNIFICANT
    assert adequate(fit)
