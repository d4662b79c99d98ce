"""The last steps of a fit against where its cost is really least."""

import numpy as np
import pytest
from support.recordings import NOMINAL, recording

from pierburg_ros.inference.data import all_fitted
from pierburg_ros.inference.explanation import Explanation
from pierburg_ros.inference.fit import Fit, Fitter
from pierburg_ros.inference.intervals import intervals, slopes_at
from pierburg_ros.inference.polish import polished

NAMES = ("armature_resistance", "torque_constant", "coulomb_friction")


def searched(seed: int, iterations: int) -> Fit:
    """A search in slow steps, which tell resistance and torque constant apart only weakly."""
    measured = recording({}, seed=seed, duties=(0.05, 0.3))
    start = {"armature_resistance": 4.6, "torque_constant": 0.0245, "coulomb_friction": 0.21}
    return Fitter(all_fitted([measured], NOMINAL), NOMINAL, 1.0).fit(Explanation(NAMES), start, iterations)


def test_the_slope_of_the_cost_vanishes() -> None:
    found = searched(0, 4)
    ends = polished(found)
    assert ends.chi2 <= found.chi2
    slopes = slopes_at(ends, ends.explanation)
    move = np.linalg.lstsq(slopes, ends.fitted, rcond=None)[0]
    # what one more step would gain, in chi2: a thousandth of a standard deviation squared
    assert float(np.sum(np.square(slopes @ move))) < 1e-3


def test_the_best_stays() -> None:
    ends = polished(searched(1, 25))
    assert polished(ends).values == pytest.approx(ends.values, rel=1e-5)


def test_intervals_around_it_hold_the_true_values() -> None:
    """Of 40 x 3 intervals 95 % is 114; of 40 recordings 34 are four deviations fewer than 38."""
    inside = []
    for seed in range(40):
        known = intervals(polished(searched(seed, 25)))
        inside.append([known[name].ci95[0] <= NOMINAL.values[name] <= known[name].ci95[1] for name in NAMES])
    assert np.sum(inside, axis=0).min() >= 34


def test_nothing_free_is_as_it_is() -> None:
    fitter = searched(0, 0).fitter
    fixed = fitter.fit(Explanation(), {})
    assert polished(fixed) is fixed
