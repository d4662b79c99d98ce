"""Larger explanations: what was fitted in the place of something else is begun anew beside it."""

import pytest
from support.recordings import NOMINAL, data_on, disturbed, recording

from pierburg_ros.diagnosis.search.candidates import starts_of
from pierburg_ros.diagnosis.search.growing import anew, drifted, grown
from pierburg_ros.diagnosis.search.scored import estimator_beside, scored, settled
from pierburg_ros.diagnosis.search.selection import PROMISING
from pierburg_ros.estimation.estimator import Estimator
from pierburg_ros.inference.explanation import Explanation, Variant
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


@pytest.mark.parametrize(
    ("name", "value"), [("armature_resistance", 4.9), ("coulomb_friction", 0.226), ("spring_preload", 0.344)]
)
def test_a_drift_is_found_though_a_discrepancy_explains_all_that_it_makes(name, value):
    """Beside that discrepancy a descent does not move, and a dead band or heat would come first."""
    data = data_on(disturbed({name: value}, 0))
    base = scored(data, Estimator(data, NOMINAL).at(Explanation()))
    with workers(1) as pool:
        found = grown(data, NOMINAL, base, pool, lambda _: None)[0]
    assert found.fit.explanation == Explanation((name,))
    assert found.fit.values[name] == pytest.approx(value, rel=0.02)


def test_two_drifts_at_once_are_found_that_neither_alone_makes_likely():
    """More friction and less preload: what a Coulomb difference between the directions does."""
    true = {"spring_preload": 0.27, "coulomb_friction": 0.22}
    data = data_on(disturbed(true, 0))
    base = scored(data, Estimator(data, NOMINAL).at(Explanation()))
    with workers(1) as pool:
        found = drifted(data, NOMINAL, base, pool, lambda _: None)
    assert found[0].fit.explanation == Explanation(("spring_preload", "coulomb_friction"))
    assert {name: found[0].fit.values[name] for name in true} == pytest.approx(true, rel=0.02)


def test_what_a_linear_step_promises_less_of_is_found_as_likely():
    """Inductance of the winding, and a gear that twists: three others promise more than the former."""
    data = data_on(disturbed({"armature_inductance.inductance": 0.025}, 0))
    base = scored(data, Estimator(data, NOMINAL).at(Explanation()))
    with workers(1) as pool:
        found = grown(data, NOMINAL, base, pool, lambda _: None)
    cost = {each.fit.explanation.effects: each.cost for each in found}
    assert len(cost) == len(found)
    assert cost["armature_inductance",] == pytest.approx(cost["gear_compliance",], abs=PROMISING)


def test_a_fit_is_settled_when_its_own_discrepancy_moves_it_no_further():
    """What remains gets smaller with each time, and then a descent moves again."""
    stop = Variant("stop_compliance", ("stiffness", "damping"))
    true = {"coulomb_friction": 0.226, "stop_compliance.stiffness": 12.0, "stop_compliance.damping": 0.02}
    data = data_on(disturbed(true, 0))
    begun = {"stop_compliance.stiffness": 8.4, "stop_compliance.damping": 0.014}
    found = settled(data, NOMINAL, Estimator(data, NOMINAL).at(Explanation(("coulomb_friction",), (stop,)), begun))
    assert found.cost - settled(data, NOMINAL, found.fit).cost < PROMISING
    assert found.fit.values["coulomb_friction"] == pytest.approx(0.226, rel=0.02)
