"""Recordings are cut where the shaft rests, and begin again from there."""

from itertools import product

import numpy as np
import pytest
from support.recordings import NOMINAL, data_on, recording

from pierburg_ros.estimation.estimator import Estimator
from pierburg_ros.estimation.initial_state import EVEN, rests_of
from pierburg_ros.estimation.rests import cut_at_rests
from pierburg_ros.inference.explanation import Explanation, Variant

STICTION = Explanation((), (Variant("static_friction", ("breakaway_torque", "stribeck_velocity")),))
TRUTH = {"static_friction.breakaway_torque": 0.27, "static_friction.stribeck_velocity": 0.1}
NOISE = 0.003


def noisy(*levels: float | np.ndarray) -> np.ndarray:
    """Stretches of 400 samples around levels, with noise."""
    course = np.concatenate([np.broadcast_to(level, 400) for level in levels])
    return course + NOISE * np.random.default_rng(1).standard_normal(course.size)


def test_a_rest_is_its_middle_half() -> None:
    move = np.linspace(1.0, 2.0, 400)
    first, second = rests_of(noisy(1.0, move, 2.0), NOISE)
    assert (first.start, first.stop) == (100, 300)
    assert (second.start, second.stop) == (900, 1100)


@pytest.mark.parametrize("creep", [30.0, -30.0])
def test_what_creeps_does_not_rest(creep: float) -> None:
    """By 30 noises in 400 samples: each stretch of 50 lies within the span of a standstill, and yet moves."""
    assert rests_of(noisy(1.0 + creep * NOISE * np.linspace(0.0, 1.0, 400)), NOISE) == []


def test_a_recording_too_short_for_a_rest_has_none() -> None:
    assert rests_of(np.ones(EVEN + 3), NOISE) == []
    assert rests_of(np.ones(3), NOISE) == []


def test_samples_stay_and_the_truth_fits_between_rests() -> None:
    data = data_on(recording(TRUTH))
    cut = cut_at_rests(data)
    assert len(cut.runs) > 5
    np.testing.assert_array_equal(np.concatenate([run.measured for run in cut.runs]), data.runs[0].measured)
    np.testing.assert_array_equal(cut.train, data.train)
    assert Estimator(cut, NOMINAL).at(STICTION, TRUTH).ratio == pytest.approx(1.0, abs=0.03)


def test_descents_that_begin_between_rests_come_to_the_truth_from_more_starts() -> None:
    """Of 36 around it: one slip that comes early displaces all that follows."""
    estimator = Estimator(data_on(recording({**TRUTH, "static_friction.breakaway_torque": 0.26})), NOMINAL)
    found = {"directly": 0, "between rests": 0}
    for torque, velocity in product((0.24, 0.25, 0.26, 0.27, 0.28, 0.29), (0.07, 0.08, 0.09, 0.11, 0.12, 0.14)):
        start = {"static_friction.breakaway_torque": torque, "static_friction.stribeck_velocity": velocity}
        smooth = estimator.between_rests.fit(STICTION, start, forgiving=True).values
        for way, begin in (("directly", start), ("between rests", smooth)):
            found[way] += estimator.fit(STICTION, begin).ratio < 1.1
    assert found["between rests"] > found["directly"]
