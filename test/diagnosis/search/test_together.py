"""Which parameters drift together: as many as a recording tells apart, and as few as do the same."""

import itertools
from dataclasses import replace

import numpy as np
import pytest
from support.recordings import NOMINAL, data_on, recording

from pierburg_ros.diagnosis.search.candidates import drifting
from pierburg_ros.diagnosis.search.together import drifting_apart, drifting_fewer, needless
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.inference.explanation import Explanation, Variant

DRIFTS = drifting(NOMINAL)
TRUE = {"armature_resistance": 5.2, "coulomb_friction": 0.16, "sensor_lag.time_constant": 0.012}
LAG = Variant("sensor_lag", ("time_constant",))


@pytest.fixture(scope="module")
def estimator() -> Estimator:
    return Estimator(data_on(recording(TRUE)), NOMINAL)


@pytest.fixture(scope="module")
def everything(estimator: Estimator) -> Fit:
    """All that drifts and is told apart, fitted beside the lag."""
    return estimator.fit(Explanation(drifting_apart(estimator, DRIFTS).drifted, (LAG,)), TRUE)


def test_a_parameter_whose_mark_others_make_as_well_is_one_too_many(
    estimator: Estimator, monkeypatch: pytest.MonkeyPatch
) -> None:
    nominal = estimator.at(Explanation(DRIFTS))
    marks = np.random.default_rng(0).standard_normal((50, len(DRIFTS)))
    marks[:, 2] = 3.0 * marks[:, 0] - marks[:, 1]
    told = replace(nominal, solution=replace(nominal.solution, slope=lambda: marks))
    monkeypatch.setattr(estimator, "at", lambda _: told)
    apart = drifting_apart(estimator, DRIFTS).drifted
    assert len(apart) == len(DRIFTS) - 1
    assert set(DRIFTS) - set(apart) < set(DRIFTS[:3])


def test_the_fewest_that_do_the_same_come_first(estimator: Estimator, everything: Fit) -> None:
    begins = drifting_fewer(everything, estimator, DRIFTS, 2)[:3]
    ratios = [estimator.fit(*begin).ratio for begin in begins]
    true = Explanation(("armature_resistance", "coulomb_friction"), (LAG,))
    assert min(ratios) < 1.03
    assert true in [explanation for explanation, _ in begins]


def test_every_combination_is_asked_once_with_all_effects(estimator: Estimator, everything: Fit) -> None:
    for count in (0, 1, 2):
        begins = drifting_fewer(everything, estimator, DRIFTS, count)
        assert [explanation.variants for explanation, _ in begins] == [(LAG,)] * len(begins)
        asked = {explanation.drifted for explanation, _ in begins}
        assert asked == set(itertools.combinations(DRIFTS, count)) and len(asked) == len(begins)


def test_drifts_that_are_not_there_are_needless(estimator: Estimator, everything: Fit) -> None:
    """A fit of the others confirms it; products of parameters may stand in for the true ones."""
    out = needless(everything, estimator, 15.0)
    kept = tuple(name for name in everything.explanation.drifted if name not in out)
    rest = estimator.fit(Explanation(kept, (LAG,)), everything.values)
    assert len(kept) == 2
    assert rest.chi2 - everything.chi2 < 15.0 * len(out)


def test_drifts_that_are_there_are_not_needless(estimator: Estimator) -> None:
    true = estimator.fit(Explanation(("armature_resistance", "coulomb_friction"), (LAG,)), TRUE)
    assert needless(true, estimator, 15.0) == ()
    assert set(needless(true, estimator, 1e12)) == set(true.explanation.drifted)
