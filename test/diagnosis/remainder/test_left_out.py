"""What recordings left out of a fit say, worked out by hand."""

import math

import numpy as np
import pytest
from support.recordings import NOMINAL, data_on, recording

from pierburg_ros.diagnosis.remainder.left_out import FOLDS, Parts, by_chance, folds_of, gain, helps, parts_of, said_of
from pierburg_ros.estimation.data import all_training
from pierburg_ros.estimation.estimator import Estimator
from pierburg_ros.inference.explanation import Explanation, Variant


def parts(*errors: float, stretches: float = 10.0, improbable: float = 0.0) -> Parts:
    return Parts(np.array(errors), np.full(len(errors), stretches), improbable)


def test_the_gain_is_that_of_so_many_normal_variables_and_of_the_prior() -> None:
    without, beside = parts(2.0, 4.0, improbable=1.0), parts(1.0, 4.0, improbable=6.0)
    assert gain(without, beside) == pytest.approx(2.0 * 10.0 * math.log(2.0) - 5.0)


def test_the_largest_of_many_squares_of_normal_variables_is_about_what_chance_gains() -> None:
    squares = np.random.default_rng(4).standard_normal((20000, 20)) ** 2
    assert by_chance(20) == pytest.approx(np.median(squares.max(axis=1)), rel=0.35)


def test_an_effect_has_to_gain_more_than_chance_and_a_tenth_of_the_error() -> None:
    before = parts(1.0, 1.0, 1.0, stretches=1000.0)
    assert helps(before, parts(0.89, 0.89, 0.89, stretches=1000.0), 20)
    assert not helps(before, parts(0.92, 0.92, 0.92, stretches=1000.0), 20)
    assert not helps(before, parts(0.8, 0.8, 0.8, stretches=1.0), 20)
    assert not helps(before, parts(0.5, 0.5, 0.5, stretches=10.0, improbable=40.0), 20)


@pytest.mark.parametrize(("time", "plausible"), [(0.01, True), (2.0, False)])
def test_values_that_no_actuator_has_are_told(time: float, plausible: bool) -> None:
    data = all_training(data_on(*(recording({}, duration=2.0, seed=seed) for seed in range(2))))
    lag = Explanation(variants=(Variant("sensor_lag", ("time_constant",)),))
    fit = Estimator(data, NOMINAL).at(lag, {"sensor_lag.time_constant": time})
    assert parts_of(NOMINAL, folds_of(data), fit).plausible == plausible


def test_every_recording_is_left_out_once() -> None:
    data = data_on(*(recording({}, duration=1.0, seed=seed) for seed in range(FOLDS + 1)))
    folds = folds_of(data)
    left = sorted(run.number for _, out in folds for run in out.runs)
    assert len(folds) == FOLDS and left == [0, 1, 2, 3, 4]
    for fitted, out in folds:
        assert not {run.number for run in fitted.runs} & {run.number for run in out.runs}


def test_what_is_said_counts_the_parts_that_an_effect_helped() -> None:
    data = data_on(*(recording({}, duration=1.0, seed=seed) for seed in range(2)))
    said = said_of(folds_of(data), parts(2.0, 8.0), parts(1.0, 9.0))
    assert (said.helped, said.parts) == (1, 2)
    assert said.without == pytest.approx(4.0 * data.noise)
    assert said.beside == pytest.approx(3.0 * data.noise)
