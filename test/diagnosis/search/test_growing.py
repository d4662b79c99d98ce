"""Explanations with one quantity more: what was fitted in the place of something else is begun anew beside it."""

from support.recordings import NOMINAL, data_on, recording

from pierburg_ros.diagnosis.search.candidates import starts_of
from pierburg_ros.diagnosis.search.growing import anew, grown
from pierburg_ros.diagnosis.search.scored import estimator_beside, scored
from pierburg_ros.estimation.estimator import Estimator
from pierburg_ros.estimation.explanation import Explanation, Variant
from pierburg_ros.workers import workers

STICKS = Variant("static_friction", ("breakaway_torque", "stribeck_velocity"))
TRUE = {"spring_preload": 0.31, "static_friction.breakaway_torque": 0.3, "static_friction.stribeck_velocity": 0.1}
BOTH = Explanation(("spring_preload",), (STICKS,))


def test_an_effect_whose_events_jump_leaves_the_minimum_that_it_had_without_what_is_added():
    """Friction that breaks away at a third more torque stands for a preload; a descent from there does not return."""
    data = data_on(recording(TRUE, duration=16.0))
    base = scored(data, Estimator(data, NOMINAL).at(Explanation()))
    estimator = estimator_beside(data, NOMINAL, base.discrepancy)
    stuck = {**TRUE, "static_friction.breakaway_torque": 0.4, "static_friction.stribeck_velocity": 0.01}
    fit = estimator.fit(BOTH, stuck)
    free = anew(estimator, fit, {STICKS: starts_of(data, fit.model)[STICKS]})
    assert abs(fit.values["static_friction.breakaway_torque"] - 0.3) > 0.05
    assert free.chi2 < fit.chi2 - 100.0 and abs(free.values["static_friction.breakaway_torque"] - 0.3) < 0.01


def test_an_effect_without_events_is_left_as_it_is():
    data = data_on(recording({"sensor_lag.time_constant": 0.02}, duration=8.0))
    lag = Variant("sensor_lag", ("time_constant",))
    estimator = Estimator(data, NOMINAL)
    fit = estimator.at(Explanation((), (lag,)), {"sensor_lag.time_constant": 0.01})
    assert anew(estimator, fit, {lag: starts_of(data, fit.model)[lag]}) is fit


def test_what_makes_a_recording_likeliest_comes_first():
    data = data_on(recording({"sensor_lag.time_constant": 0.02}, duration=8.0))
    base = scored(data, Estimator(data, NOMINAL).at(Explanation()))
    with workers(1) as pool:
        found = grown(data, NOMINAL, base, pool, lambda _: None)
    assert found[0].fit.explanation.effects == ("sensor_lag",)
    assert [each.cost for each in found] == sorted(each.cost for each in found)
