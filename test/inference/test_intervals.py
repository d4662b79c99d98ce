"""Intervals of a fit against statistics with a closed form, and against recordings of known values."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import lfilter
from support.recordings import NOISE, NOMINAL, PIERBURG, changing, data_on, recording, recording_in_closed_loop

from pierburg_ros.effects import EFFECT
from pierburg_ros.inference.covariance import spread
from pierburg_ros.inference.data import data_of
from pierburg_ros.inference.explanation import AFTER, WHEN, Explanation, Variant
from pierburg_ros.inference.fit import Fit, Fitter, ladder
from pierburg_ros.inference.intervals import Interval, intervals, together
from pierburg_ros.plant import Inputs, Model
from pierburg_ros.recording import Channel

WIDE = 1e6
"""A deviation before the recording of which nothing is left beside it."""


def fitted(measured, names, values, effect=None, start=None, nominal=NOMINAL) -> Fit:
    """A fit of some drifts, and an effect, at the weakest pull of the ladder."""
    data = data_of([measured], nominal)
    variants = ()
    if effect:
        first = EFFECT[effect].variants[0]
        variants = (Variant(effect, first.free, tuple(first.fixed.items())),)
    fitter = Fitter(data, nominal, ladder(data)[-1])
    return fitter.fit(Explanation(names, variants), nominal.with_values(values).values | (start or {}))


def autoregressive(size, memory, random):
    """First-order autoregressive noise of unit innovation."""
    return lfilter([1.0], [1.0, -memory], random.standard_normal(size))


def test_white_noise_gives_the_deviations_of_linear_least_squares():
    random = np.random.default_rng(0)
    slopes = random.standard_normal((5000, 3)) @ np.array([[1.0, 0.5, 0.0], [0.0, 2.0, 0.1], [0.0, 0.0, 0.3]])
    noise = 0.7 * random.standard_normal(5000)
    residual = noise - slopes @ np.linalg.lstsq(slopes, noise, rcond=None)[0]
    found = spread(slopes, (residual,), np.full(3, WIDE))
    np.testing.assert_allclose(found.matrix, 0.49 * np.linalg.inv(slopes.T @ slopes), rtol=0.08, atol=2e-5)
    assert found.factor == pytest.approx(1.96, abs=0.001)


@pytest.mark.parametrize("memory", [0.0, 0.5, 0.9])
def test_intervals_of_a_linear_fit_hold_the_truth_in_95_percent(memory):
    """Slopes that are as slow as the noise, for which white noise would hold the truth in as few as 35 %.

    The count of 400 x 2 intervals is within 93 to 99 %: three deviations of the count below, and wider above, since the
    larger of two estimates counts.
    """
    random, inside, size = np.random.default_rng(1), [], 4000
    for _ in range(400):
        slopes = np.stack([np.ones(size), autoregressive(size, memory, random)], axis=1)
        noise = autoregressive(size, memory, random)
        error = np.linalg.lstsq(slopes, noise, rcond=None)[0]
        found = spread(slopes, (noise - slopes @ error,), np.full(2, WIDE))
        inside.append(np.abs(error) <= found.factor * np.sqrt(np.diagonal(found.matrix)))
    assert 0.93 <= np.mean(inside) <= 0.99


def test_a_quantity_without_data_keeps_the_deviation_that_it_had():
    random = np.random.default_rng(2)
    slopes = np.stack([random.standard_normal(1000), np.zeros(1000)], axis=1)
    found = spread(slopes, (random.standard_normal(1000),), np.array([1.0, 0.3]))
    assert np.sqrt(found.matrix[1, 1]) == pytest.approx(0.3)


def test_of_a_sum_each_part_is_known_as_well_as_the_other_was():
    """Only x + y shows, to 0.003; y was known to 0.1: then x is known to 0.1, and the two are tied."""
    random = np.random.default_rng(3)
    column = 10.0 * random.standard_normal(1000)
    found = spread(np.stack([column, column], axis=1), (random.standard_normal(1000),), np.array([10.0, 0.1]))
    assert np.sqrt(np.diagonal(found.matrix)) == pytest.approx([0.1, 0.1], rel=0.01)
    assert together(found.matrix, 0) == [1]
    assert together(found.matrix, 1) == [0]


def test_of_a_sum_of_three_no_two_are_tied_but_all_three():
    random = np.random.default_rng(4)
    column = 10.0 * random.standard_normal(1000)
    slopes = np.stack([column, column, column, random.standard_normal(1000)], axis=1)
    found = spread(slopes, (random.standard_normal(1000),), np.ones(4))
    assert sorted(together(found.matrix, 0)) == [1, 2]
    assert together(found.matrix, 3) == []


def coverage(make, values, names, effect=None, seeds=60) -> dict[str, float]:
    """Share of intervals that hold the truth, by quantity."""
    truth, inside = NOMINAL.with_values(values).values, {}
    for seed in range(seeds):
        for name, each in intervals(fitted(make(values, seed=seed), names, values, effect)).items():
            assert each.ci95 is not None
            inside.setdefault(name, []).append(each.ci95[0] <= truth[name] <= each.ci95[1])
    return {name: float(np.mean(each)) for name, each in inside.items()}


def test_intervals_hold_the_true_values_of_recordings():
    """Of 60 recordings 95 % is 57, and 52 are three deviations fewer."""
    names = ("armature_resistance", "spring_preload", "coulomb_friction")
    assert min(coverage(recording, {"armature_resistance": 5.2}, names).values()) >= 52 / 60


def test_intervals_hold_the_true_values_beside_an_effect_in_closed_loop():
    found = coverage(
        recording_in_closed_loop, {"input_delay.delay": 0.012}, ("spring_preload",), "input_delay", seeds=40
    )
    assert min(found.values()) >= 34 / 40


def test_a_moment_is_known_to_where_the_shaft_does_not_show_it():
    """A winding that warms up while the shaft lies on its stop without current."""
    whole, when = recording({}, duration=24.0), 10.7
    duty = np.where((whole.time > 8.0) & (whole.time < 13.0), 0.0, whole.command.values)
    after = NOMINAL.with_values({"armature_resistance": 5.0})
    volts = changing(NOMINAL, after, when, Inputs(whole.time, duty), whole.time)
    measured = volts + NOISE * np.random.default_rng(1).standard_normal(volts.size)
    data = data_of([replace(whole, measured=measured, command=Channel(whole.time, duty))], NOMINAL)
    fitter = Fitter(data, NOMINAL, ladder(data)[-1])
    moment = f"armature_resistance{WHEN}"
    start = {**NOMINAL.values, f"armature_resistance{AFTER}": 5.0, moment: 9.5}
    found = intervals(fitter.fit(Explanation(changed="armature_resistance"), start))
    low, high = found[moment].ci95
    assert 8.0 < low < when < high < 13.5
    assert high - low > 4.0


def test_what_only_a_ratio_shows_is_known_as_the_held_one_is():
    """A duty and an angle tell torques only in ratio to the spring's; its stiffness may be anywhere in its range."""
    names = ("armature_resistance", "spring_preload", "coulomb_friction")
    fit = fitted(recording({"armature_resistance": 5.2}), names, {})
    alone, beside = intervals(fit), intervals(fit, ("spring_stiffness",))
    for name in names:
        low, high = alone[name].ci95
        assert high - low < 0.001 * alone[name].value
        assert alone[name].identifiable
        assert beside[name].ci95 is None
        assert not beside[name].identifiable
        assert set(beside[name].tied_with) == {"spring_stiffness", *names} - {name}


def test_a_small_range_of_what_is_held_is_a_small_interval():
    """The stiffness was known to 1 % (two deviations), and so are all torques then, but for a digit of 1.96."""
    names = ("armature_resistance", "spring_preload", "coulomb_friction")
    held = replace(PIERBURG.parameters["spring_stiffness"], minimum=0.99 * 0.1419, maximum=1.01 * 0.1419)
    described = replace(PIERBURG, parameters={**PIERBURG.parameters, "spring_stiffness": held})
    fit = fitted(recording({"armature_resistance": 5.2}), names, {}, nominal=Model.nominal(described))
    for each in intervals(fit, ("spring_stiffness",)).values():
        assert each.ci95[1] - each.ci95[0] == pytest.approx(0.02 * each.value * 0.98, rel=0.02)
        assert each.identifiable
        assert "spring_stiffness" in each.tied_with


def test_two_free_quantities_of_which_only_a_ratio_shows_are_unknown():
    names = ("armature_resistance", "spring_stiffness", "spring_preload", "coulomb_friction")
    for name, each in intervals(fitted(recording({}), names, {})).items():
        assert each.ci95 is None
        assert not each.identifiable
        assert set(each.tied_with) == {*names} - {name}


def test_a_quantity_that_ends_on_a_bound_has_no_interval():
    measured = recording({"armature_resistance": 5.2})
    fit = fitted(measured, ("armature_resistance",), {}, "viscous_friction", {"viscous_friction.coefficient": 0.0})
    assert intervals(fit)["viscous_friction.coefficient"].ci95 is None
    assert not intervals(fit)["viscous_friction.coefficient"].identifiable


def test_a_level_counted_from_another_keeps_the_order_of_the_two():
    """The breakaway torque is searched as what it exceeds Coulomb friction by; its interval counts both."""
    values = {"static_friction.breakaway_torque": 0.27, "static_friction.stribeck_velocity": 0.3}
    fit = fitted(recording(values), ("coulomb_friction",), values, "static_friction")
    found = intervals(fit)["static_friction.breakaway_torque"]
    assert found.ci95 is not None
    assert found.ci95[0] < found.value < found.ci95[1]
    assert found.value == pytest.approx(0.27, rel=0.05)


def test_nothing_free_has_no_interval():
    assert intervals(fitted(recording({}), (), {})) == {}


def test_an_interval_says_all_there_is():
    found = intervals(fitted(recording({}), ("spring_preload",), {}))["spring_preload"]
    assert isinstance(found, Interval)
    assert found.identifiable
    assert not found.at_bound
    assert found.tied_with == ()


def test_a_coarse_converter_leaves_values_as_uncertain_as_its_steps():
    """Within a step nothing of an error shows: what is left beyond it is far less than the error is."""
    hidden = {"armature_resistance": 4.6, "coulomb_friction": 0.22}
    inside = 0
    for seed in range(6):
        one = recording(hidden, duration=12.0, seed=seed)
        data = data_on(replace(one, measured=0.05 * np.round(one.measured / 0.05)))
        assert data.step == pytest.approx(0.05)
        known = intervals(Fitter(data, NOMINAL, ladder(data)[0]).fit(Explanation(tuple(hidden)), NOMINAL.values))
        inside += sum(low <= hidden[name] <= high for name, each in known.items() for low, high in [each.ci95])
    assert inside >= 11
