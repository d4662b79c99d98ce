"""What stands beside a remainder becomes the explanation of all where it leaves nothing."""

from dataclasses import replace

import pytest
from support.fits import found_among, made_up
from support.recordings import NOMINAL, data_on, recording

from pierburg_ros.deadline import Deadline
from pierburg_ros.diagnosis.diagnose import explains_all
from pierburg_ros.diagnosis.remainder.standing import Standing
from pierburg_ros.diagnosis.search.found import Found, settled_on
from pierburg_ros.diagnosis.verdict.conclusion import conclude, verdict_on
from pierburg_ros.inference.explanation import Explanation, Variant

RUBS = Explanation(variants=(Variant("load_dependent_friction", ("coefficient",)),))
CUBIC = Variant("nonlinear_spring", ("cubic_stiffness",))
TRUE = {"load_dependent_friction.coefficient": 0.05}


@pytest.fixture
def stopped() -> Found:
    """A search of a valve whose gear rubs with the load, stopped before it came to that."""
    data = data_on(recording(TRUE, duration=6.0))
    nominal = made_up(Explanation(), 5.0, NOMINAL)
    return replace(found_among(data, nominal), recalibrated=nominal)


def standing(found: Found, values: dict[str, float]) -> Standing:
    return Standing(found.estimator, found.estimator.at(RUBS, values))


def test_what_stands_and_leaves_nothing_is_the_verdict(stopped):
    fit = explains_all(standing(stopped, {"load_dependent_friction.coefficient": 0.0499}), stopped)
    assert fit is not None
    settled = settled_on(stopped, fit, 1, Deadline())
    assert verdict_on(stopped.chosen) == "unexplained"
    assert verdict_on(settled.chosen) == "missing_physics"
    assert settled.final.values["load_dependent_friction.coefficient"] == pytest.approx(0.05, rel=0.01)
    assert "load_dependent_friction.coefficient" in settled.estimates
    assert conclude(settled).verdict == "missing_physics"


def test_values_from_beside_a_remainder_are_fitted_first(stopped):
    fit = explains_all(standing(stopped, {"load_dependent_friction.coefficient": 0.02}), stopped)
    assert fit is not None
    assert fit.values["load_dependent_friction.coefficient"] == pytest.approx(0.05, rel=0.01)


def test_what_leaves_something_stays_beside_a_remainder(stopped):
    bends = Explanation(variants=(CUBIC,))
    named = Standing(stopped.estimator, stopped.estimator.at(bends, {"nonlinear_spring.cubic_stiffness": 0.01}))
    assert explains_all(named, stopped) is None


def test_another_form_of_an_effect_may_explain_all():
    """A knee was chosen before the lag was there; with it, a cube leaves nothing."""
    true = {"nonlinear_spring.cubic_stiffness": 0.03, "sensor_lag.time_constant": 0.01}
    data = data_on(recording(true, duration=20.0))
    found = found_among(data, made_up(Explanation(), 5.0, NOMINAL))
    lag = Variant("sensor_lag", ("time_constant",))
    knee = Explanation(variants=(Variant("nonlinear_spring", ("knee_stiffness", "knee_angle")), lag))
    begin = {
        "nonlinear_spring.knee_stiffness": 0.08,
        "nonlinear_spring.knee_angle": 0.6,
        "sensor_lag.time_constant": 0.01,
    }
    own = found.estimator.fit(knee, begin)
    assert own.ratio > 1.5
    fit = explains_all(Standing(found.estimator, own), found)
    assert fit is not None
    assert fit.explanation.variants == (CUBIC, lag)
    assert fit.values["nonlinear_spring.cubic_stiffness"] == pytest.approx(0.03, rel=0.01)


def test_where_nothing_stands_nothing_is_settled(stopped):
    assert explains_all(Standing(stopped.estimator), stopped) is None


def test_without_time_for_intervals_the_values_are_those_that_stood(stopped):
    fit = stopped.estimator.fit(RUBS, TRUE)
    settled = settled_on(stopped, fit, 1, Deadline(0.0))
    assert settled.chosen is settled.final is fit
    assert not settled.estimates
