"""Regression, trends, steps, forecasts and outliers, against closed forms, scipy and drawn courses."""

import math

import numpy as np
import pytest
from scipy import optimize, stats
from support.courses import course

from pierburg_ros.fleets.ageing.discovery import discovery_rates
from pierburg_ros.fleets.ageing.forecast import forecast
from pierburg_ros.fleets.ageing.outliers import differences
from pierburg_ros.fleets.ageing.regression import regression
from pierburg_ros.fleets.ageing.step import step
from pierburg_ros.fleets.ageing.trend import line

TIME = np.linspace(0.0, 365.0, 25)


def drawn(seed, mean=0.0, scatter=0.02, stated=0.002, time=TIME, **more):
    """A course around `mean`, whose stated deviations are a tenth of the scatter."""
    random = np.random.default_rng(seed)
    return course(time, mean + scatter * random.standard_normal(time.size), np.full(time.size, stated), **more)


def test_with_equal_deviations_a_regression_is_the_ordinary_one_of_scipy():
    random = np.random.default_rng(1)
    values = 3.0 + 0.01 * TIME + random.standard_normal(TIME.size)
    found = regression(np.column_stack([np.ones(25), TIME]), values, np.full(25, 1e-6))
    other = stats.linregress(TIME, values)
    assert found.coefficients == pytest.approx([other.intercept, other.slope], rel=1e-6)
    assert math.sqrt(found.covariance[1, 1]) == pytest.approx(other.stderr, rel=1e-6)
    assert found.chance(1) == pytest.approx(other.pvalue, rel=1e-5)


def test_the_scatter_is_that_at_which_the_weighted_squares_are_as_many_as_the_degrees_of_freedom():
    random = np.random.default_rng(2)
    deviations = random.uniform(0.01, 0.3, 25)
    values = 0.2 * random.standard_normal(25) + deviations * random.standard_normal(25)
    found = regression(np.ones((25, 1)), values, deviations)

    def squares(scatter):  # the closed form of a weighted mean
        weights = 1.0 / (deviations**2 + scatter**2)
        return np.sum(weights * (values - np.average(values, weights=weights)) ** 2) - 24

    assert found.scatter == pytest.approx(optimize.brentq(squares, 0.0, 5.0), rel=1e-6)


def test_deviations_that_are_too_wide_are_left_so():
    found = regression(np.ones((5, 1)), np.array([1.0, 1.1, 0.9, 1.0, 1.0]), np.full(5, 10.0))
    assert found.scatter == 0.0
    assert math.sqrt(found.covariance[0, 0]) == pytest.approx(10.0 / math.sqrt(5.0))


def test_what_cannot_be_told_apart_has_no_regression():
    assert regression(np.column_stack([np.ones(5), np.ones(5)]), np.arange(5.0), np.ones(5)) is None
    assert regression(np.ones((1, 1)), np.ones(1), np.ones(1)) is None


def test_steady_courses_with_deviations_ten_times_too_small_show_a_trend_as_often_as_stated():
    chances = np.array([line(drawn(seed)).chance for seed in range(500)])
    assert stats.kstest(chances, "uniform").pvalue > 0.01
    low, high = stats.binom.interval(0.999, 500, 0.05)
    assert low <= np.sum(chances < 0.05) <= high


def test_the_interval_of_a_slope_holds_it_as_often_as_stated():
    held = sum(low <= 1e-4 <= high for seed in range(500) for low, high in [line(drawn(seed, 1e-4 * TIME)).interval])
    low, high = stats.binom.interval(0.999, 500, 0.95)
    assert low <= held <= high


def test_temperature_is_taken_out_of_a_trend():
    warm = 20.0 - 9.0 * np.cos(2.0 * np.pi * TIME / 365.0 + 1.0)
    found = line(drawn(1, 4.0 + 0.016 * (warm - 20.0), scatter=0.002, temperature=warm))
    without = line(drawn(1, 4.0 + 0.016 * (warm - 20.0), scatter=0.002))
    assert found.warm and not without.warm
    assert found.found.coefficients[2] == pytest.approx(0.016, abs=3e-4)
    assert abs(found.slope) < 0.1 * abs(without.slope)


def test_a_step_is_dated_between_its_recordings_and_measured():
    found = step(drawn(3, np.where(TIME >= 200.0, -0.2, 0.0)))
    assert found.after < 200.0 <= found.before
    assert found.first <= found.after and found.before <= found.last
    assert found.interval[0] < -0.2 < found.interval[1]
    assert found.chance < 1e-6


def test_steps_are_found_in_steady_courses_no_more_often_than_stated():
    found = [step(drawn(seed)) for seed in range(100)]
    false = sum(each is not None and each.chance < 0.05 for each in found)
    assert false <= stats.binom.ppf(0.999, 100, 0.05)


def test_a_bend_is_no_step():
    found = step(drawn(4, 0.3 * (TIME / 365.0) ** 2))
    assert found is None or found.chance > 0.05


def test_steady_ageing_beside_a_repair_keeps_its_slope():
    mean = 1e-3 * np.where(TIME >= 200.0, TIME - 200.0, TIME)
    ageing = drawn(5, mean)
    found = line(ageing, (step(ageing).before,))
    low, high = found.interval
    assert low < 1e-3 < high
    assert found.at(365.0)[0] == pytest.approx(0.165, abs=0.05)


def test_a_forecast_is_the_closed_form_of_fieller():
    found = line(drawn(6, 4.0 + 1e-3 * TIME))
    told = forecast(found, 5.0, 0.0, 365.0)
    (a, b), covariance, square = found.found.coefficients, found.found.covariance, found.found.quantile**2
    polynomial = [
        b**2 - square * covariance[1, 1],
        2.0 * ((a - 5.0) * b - square * covariance[0, 1]),
        (a - 5.0) ** 2 - square * covariance[0, 0],
    ]
    first, last = sorted(found.middle + np.roots(polynomial))
    assert told.time == pytest.approx(found.middle + (5.0 - a) / b)
    assert (told.first, told.last) == pytest.approx((first, last))
    assert told.first < told.time < told.last and not told.reached


def test_intervals_of_forecasts_hold_the_day_as_often_as_stated():
    held = 0
    for seed in range(500):
        told = forecast(line(drawn(seed, 4.0 + 1e-3 * TIME)), 5.0, 0.0, 365.0)
        held += told.first <= 1000.0 <= told.last
    low, high = stats.binom.interval(0.999, 500, 0.95)
    assert low <= held <= high


def test_a_quantity_that_moves_away_or_not_at_all_never_reaches_its_limit_for_sure():
    away = forecast(line(drawn(7, 4.0 - 1e-3 * TIME)), 5.0, 0.0, 365.0)
    assert away.time is None and away.first == away.last == math.inf
    still = forecast(line(drawn(8, 4.0)), 5.0, 0.0, 365.0)
    assert still.first > 365.0 and still.last == math.inf
    beyond = forecast(line(drawn(9, 4.8 + 1e-3 * TIME)), 5.0, 0.0, 365.0)
    assert beyond.reached and beyond.first == 365.0


def test_false_discovery_rates_are_those_of_scipy():
    chances = np.random.default_rng(1).uniform(size=50) ** 3
    assert discovery_rates(chances) == pytest.approx(stats.false_discovery_control(chances))


def test_two_units_that_differ_do_not_hide_each_other():
    random = np.random.default_rng(1)
    levels = np.append(4.0 + 0.02 * random.standard_normal(20), [4.4, 4.5])
    away, chance = differences(levels, np.full(22, 0.005))
    assert np.all(chance[-2:] < 1e-4) and np.all(away[-2:] > 5.0)
    assert np.all(chance[:-2] > 1e-3)


def test_units_alike_differ_as_seldom_as_stated():
    random = np.random.default_rng(2)
    chances = np.concatenate([differences(random.standard_normal(20), np.full(20, 0.1))[1] for _ in range(100)])
    assert np.mean(chances < 0.01) <= 0.02


def test_of_a_few_units_none_can_differ():
    assert np.all(np.isnan(differences(np.arange(5.0), np.ones(5))[1]))
