"""Fits to simulated recordings: known values come back, also from other starts, other sensors and spoilt samples."""

from dataclasses import replace

import numpy as np
import pytest
from support.recordings import NOISE, NOMINAL, data_on, recording

from pierburg_ros.estimation.data import data_of
from pierburg_ros.estimation.estimator import Estimator
from pierburg_ros.estimation.run import Switch
from pierburg_ros.inference.explanation import AFTER, WHEN, Explanation, Variant

DRIFTS = Explanation(("armature_resistance", "spring_preload"))
TRUE = {"armature_resistance": 4.6, "spring_preload": 0.31}
LAG = Variant("sensor_lag", ("time_constant",))


@pytest.fixture(scope="module")
def drifted() -> Estimator:
    return Estimator(data_on(recording(TRUE, duration=12.0)), NOMINAL)


def test_known_values_are_found_again(drifted: Estimator) -> None:
    fit = drifted.fit(DRIFTS)
    assert fit.ratio == pytest.approx(1.0, abs=0.03)
    for name, value in TRUE.items():
        assert fit.values[name] == fit.model.values[name] == pytest.approx(value, rel=0.003)


def test_an_effect_is_found_beside_a_drift() -> None:
    both = Explanation(("spring_preload",), (LAG,))
    true = {"spring_preload": 0.31, "sensor_lag.time_constant": 0.015}
    fit = Estimator(data_on(recording(true, duration=12.0)), NOMINAL).fit(both, {"sensor_lag.time_constant": 0.005})
    assert fit.model.active_effects == ("sensor_lag",)
    for name, value in true.items():
        assert fit.values[name] == pytest.approx(value, rel=0.01)


def test_what_is_held_stays_and_the_others_give_way(drifted: Estimator) -> None:
    fit = drifted.fit(DRIFTS, {"spring_preload": 0.33}, held="spring_preload")
    assert fit.values["spring_preload"] == pytest.approx(0.33, rel=1e-12)
    free = drifted.fit(DRIFTS)
    assert fit.chi2 > free.chi2
    # More preload closes the valve: less resistance, more torque for the same duty, opens it.
    assert fit.values["armature_resistance"] < free.values["armature_resistance"]


def test_no_quantity_goes_beyond_its_reach(drifted: Estimator) -> None:
    """Nominal values stand at 0 in coordinates of the logarithm, where a search begins."""
    free, bound = drifted.fit(DRIFTS), drifted.fit(DRIFTS, reach=0.02)
    assert np.max(np.abs(free.solution.point)) > 0.02
    assert np.max(np.abs(bound.solution.point)) == pytest.approx(0.02, rel=1e-9)
    assert bound.chi2 > free.chi2


def test_a_fit_that_forgives_is_not_led_astray_by_a_slip() -> None:
    """For two seconds of twelve the signal is off by half a volt: least squares give in to that, logarithms do not."""
    plain = recording(TRUE, duration=12.0)
    slip = np.where((plain.time > 5.0) & (plain.time < 7.0), 0.5, 0.0)
    estimator = Estimator(data_on(replace(plain, measured=plain.measured + slip)), NOMINAL)
    strict, forgiving = estimator.fit(DRIFTS), estimator.fit(DRIFTS, forgiving=True)
    errors = [max(abs(fit.values[name] / value - 1.0) for name, value in TRUE.items()) for fit in (strict, forgiving)]
    assert errors[0] > 0.02
    assert errors[1] < 0.005


def test_a_change_in_the_middle_is_found_with_its_time() -> None:
    plain = recording({}, duration=12.0)
    data = data_of([plain], NOMINAL)
    (run,) = data.runs
    hall = run.simulated(NOMINAL, Switch(NOMINAL.with_values({"armature_resistance": 4.9}), 7.4))
    noise = NOISE * np.random.default_rng(7).standard_normal(hall.size)
    estimator = Estimator(data_on(replace(plain, measured=hall + noise)), NOMINAL)
    name = "armature_resistance"
    fit = estimator.fit(Explanation(changed=name), {name + AFTER: 4.5, name + WHEN: 7.2})
    assert fit.ratio == pytest.approx(1.0, abs=0.03)
    assert fit.values[name] == pytest.approx(NOMINAL.values[name], rel=0.005)
    assert fit.values[name + AFTER] == pytest.approx(4.9, rel=0.005)
    assert fit.values[name + WHEN] == pytest.approx(7.4, abs=0.1)


@pytest.mark.parametrize("begin", [0.0, 2.42, 3.34])
def test_a_model_of_other_hall_ends_starts_at_the_angle_that_it_reads(begin: float) -> None:
    """Decoded by the nominal sensor the valve would begin 2 to 3 degrees off, and rest elsewhere for long."""
    ends = {"hall_voltage_closed": 0.55, "hall_voltage_open": 4.4}
    other = NOMINAL.with_values(ends)
    made = recording(ends, duration=12.0).select(begin, 12.0)
    fit = Estimator(data_of([made], other), other).at(Explanation())
    first = fit.solution.residual[:1000]
    assert np.sqrt(np.mean(first**2)) < 1.1
    assert fit.ratio < 1.05


def test_the_slope_to_a_hall_end_is_the_share_of_the_travel_left() -> None:
    """Hall = closed + (open - closed) share: measured minus simulated falls by 1 - share for each volt."""
    estimator = Estimator(data_on(recording({}, duration=6.0)), NOMINAL)
    fit = estimator.at(Explanation(("hall_voltage_closed",)))
    (run,) = estimator.data.runs
    share = (run.simulated(NOMINAL)[run.train] - 0.42) / 4.1
    expected = -0.42 * (1.0 - share) / estimator.data.noise
    np.testing.assert_allclose(estimator.slopes(fit, np.full(1, 1e-4))[:, 0], expected, rtol=1e-6, atol=1e-6)


def test_the_cost_at_given_values_is_that_of_their_fit(drifted: Estimator) -> None:
    fit = drifted.at(DRIFTS, TRUE)
    assert {name: fit.values[name] for name in TRUE} == pytest.approx(TRUE)
    assert drifted.chi2_at(DRIFTS, TRUE) == pytest.approx(fit.chi2)
    assert fit.chi2 == pytest.approx(float(np.sum(drifted.data.residual(fit.model)[drifted.data.train] ** 2)))


def test_a_fit_is_restated_on_other_samples(drifted: Estimator) -> None:
    brief = Estimator(drifted.data.cut(4.0), NOMINAL)
    fit = brief.restated(drifted.at(DRIFTS, TRUE))
    assert fit.solution.residual.size == fit.solution.jacobian.shape[0] == np.count_nonzero(brief.data.train)
    assert {name: fit.values[name] for name in TRUE} == pytest.approx(TRUE)


def test_samples_that_do_not_train_change_no_fit(drifted: Estimator) -> None:
    (run,) = drifted.data.runs
    spoilt = replace(run, measured=np.where(run.train, run.measured, 2.0))
    again = Estimator(replace(drifted.data, runs=(spoilt,)), NOMINAL)
    assert again.fit(DRIFTS).values == drifted.fit(DRIFTS).values
    assert again.validation_misfit(drifted.at(DRIFTS, TRUE)) > 100.0 * drifted.validation_misfit(
        drifted.at(DRIFTS, TRUE)
    )


def test_without_anything_to_validate_nothing_speaks_against_a_fit() -> None:
    estimator = Estimator(data_of([recording({}, duration=5.0)], NOMINAL), NOMINAL)
    assert estimator.validation_misfit(estimator.at(Explanation())) == 0.0
