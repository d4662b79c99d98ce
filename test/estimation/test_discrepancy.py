"""The discrepancy in the likelihood: white noise stays as it is, what wanders is found and whitened."""

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.optimize import minimize
from support.recordings import data_on, recording

from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.discrepancy import Discrepancy, Kalman, evidence, way
from pierburg_ros.estimation.likelihood import repetition


@pytest.fixture(scope="module")
def data() -> Data:
    return data_on(recording({}, duration=24.0))


@pytest.fixture(scope="module")
def kalman(data: Data) -> Kalman:
    return Kalman(data, data.train)


def wandering(kalman: Kalman, size: float, memory: float, reach: float, seed: int = 1) -> np.ndarray:
    """White noise of 1 beside what two equal poles make of white noise, drawn step by step with matrix exponentials."""
    random, root = np.random.default_rng(seed), np.sqrt(3.0)
    poles, lasting = np.array([[0.0, 1.0], [-3.0, -2.0 * root]]), size**2 * np.diag([1.0, 3.0])
    elapsed = np.minimum(kalman.steps / memory + kalman.way / reach, 50.0)
    state, values = np.zeros(2), np.empty(elapsed.size)
    for k, kept in enumerate(expm(poles * elapsed[:, None, None])):
        added = lasting - kept @ lasting @ kept.T
        state = kept @ state + random.multivariate_normal(np.zeros(2), added, method="eigh", check_valid="ignore")
        values[k] = state[0]
    return values + random.standard_normal(elapsed.size)


def test_without_size_a_residual_stays_as_it_is(kalman):
    residual = np.random.default_rng(0).standard_normal(kalman.seen.size)
    filtered = kalman.filtered(Discrepancy(0.0, 1.0, 100.0))
    np.testing.assert_array_equal(filtered(residual), residual[kalman.seen])
    assert filtered.log_spread == 0.0


def test_what_wanders_is_whitened(kalman):
    residual = wandering(kalman, 8.0, 3.0, 2000.0)
    innovations = kalman.filtered(Discrepancy(8.0, 3.0, 2000.0))(residual)
    assert np.std(innovations) == pytest.approx(1.0, abs=0.03)
    assert repetition(residual[kalman.seen]) > 50.0 and repetition(innovations) < 1.1


def test_the_likelihood_is_that_of_the_joint_normal_distribution(kalman, data):
    """Against the covariance matrix of the first samples, factored as a whole."""
    first, (size, memory, reach) = 60, (3.0, 0.2, 500.0)
    clock = np.cumsum(np.append(0.0, (kalman.steps / memory + kalman.way / reach)[1:first]))
    apart = np.sqrt(3.0) * np.abs(clock[:, None] - clock)
    covariance = size**2 * (1.0 + apart) * np.exp(-apart) + np.eye(first)
    residual = np.zeros(kalman.seen.size)
    residual[:first] = np.random.default_rng(2).standard_normal(first)
    few = Kalman(data, np.arange(kalman.seen.size) < first)
    expected = residual[:first] @ np.linalg.solve(covariance, residual[:first]) + np.linalg.slogdet(covariance)[1]
    own = Discrepancy(size, memory, reach)
    assert evidence(few.filtered(own), residual) == pytest.approx(expected, rel=1e-9)
    assert few.evidence(own, residual) == pytest.approx(expected, rel=1e-9)


def test_the_evidence_in_one_pass_is_that_of_the_innovations(kalman):
    """Also beyond the product of variances at which its logarithm is taken."""
    own = Discrepancy(800.0, 100.0, 3e4)
    residual = wandering(kalman, own.size, own.memory, own.reach)
    assert kalman.evidence(own, residual) == pytest.approx(evidence(kalman.filtered(own), residual), rel=1e-9)


def test_the_most_likely_one_is_no_less_likely_than_the_true_one(kalman):
    true = Discrepancy(8.0, 3.0, 2000.0)
    residual = wandering(kalman, true.size, true.memory, true.reach)
    found = kalman.most_likely(residual)
    assert evidence(kalman.filtered(found), residual) <= evidence(kalman.filtered(true), residual) + 0.5


def test_from_a_known_one_nearby_the_search_ends_as_low(kalman):
    true = Discrepancy(8.0, 3.0, 2000.0)
    residual = wandering(kalman, true.size, true.memory, true.reach)
    far, near = kalman.most_likely(residual), kalman.most_likely(residual, near=Discrepancy(16.0, 1.5, 1000.0))
    assert kalman.evidence(near, residual) == pytest.approx(kalman.evidence(far, residual), abs=0.5)


@pytest.mark.parametrize("seed", [4, 5, 10])
def test_another_search_that_goes_on_from_there_gains_next_to_nothing(kalman, seed):
    """By conjugate directions. Of these three, one simplex alone stops 6.5 too high in the last."""
    random = np.random.default_rng(seed)
    true = (float(10 ** random.uniform(low, high)) for low, high in ((0.0, 2.0), (-1.5, 1.5), (1.0, 4.0)))
    residual = wandering(kalman, *true, seed=seed)
    found = kalman.most_likely(residual)

    def cost(point):
        return kalman.evidence(Discrepancy(*np.exp(point)), residual)

    begin = np.log([found.size, found.memory, found.reach])
    lower = minimize(cost, begin, method="Powell", options={"xtol": 1e-3, "ftol": 1e-7}).fun
    assert cost(begin) - lower < 2.0


def test_the_way_is_that_of_the_movement_and_not_of_the_noise():
    random = np.random.default_rng(3)
    ramp = np.concatenate([np.zeros(2000), np.arange(1000.0), np.full(2000, 999.0)])
    assert way(ramp + random.standard_normal(ramp.size)).sum() == pytest.approx(999.0, rel=0.1)
