"""What one linear step promises, against problems whose answer is known."""

from dataclasses import replace

import numpy as np
import pytest
from support.recordings import NOISE, NOMINAL, data_on, recording

from pierburg_ros.diagnosis.search.candidates import starts_of
from pierburg_ros.diagnosis.search.linear import change_starts, largest_mark, promised, promised_left, redated
from pierburg_ros.estimation.data import all_training, data_of
from pierburg_ros.estimation.estimator import Estimator
from pierburg_ros.estimation.intervals import estimates
from pierburg_ros.estimation.run import Switch
from pierburg_ros.inference.explanation import AFTER, WHEN, Explanation, Variant
from pierburg_ros.recording import Recording

LAG = Variant("sensor_lag", ("time_constant",))
NOTHING = Explanation()


def estimator_on(changes: dict[str, float]) -> Estimator:
    return Estimator(data_on(recording(changes, duration=8.0)), NOMINAL)


def test_a_step_along_a_small_drift_leaves_the_noise() -> None:
    estimator = estimator_on({"spring_preload": 0.291})
    promise = promised_left(estimator.at(Explanation(("spring_preload",))))
    fit = estimator.fit(Explanation(("spring_preload",)))
    assert promise == pytest.approx(fit.chi2, rel=0.02)
    assert promise < 0.9 * estimator.at(NOTHING).chi2


def test_a_start_is_scaled_to_what_the_step_asks_for() -> None:
    """Half the lag leaves half the mark: the start of 5 ms is brought to the 10 ms that are there."""
    estimator = estimator_on({"sensor_lag.time_constant": 0.01})
    (found,) = promised(estimator, estimator.at(NOTHING), LAG, [{"time_constant": 0.005}])
    chi2, values = found
    assert values["sensor_lag.time_constant"] == pytest.approx(0.01, rel=0.1)
    assert chi2 < 0.2 * estimator.at(NOTHING).chi2


def test_starts_come_best_first_and_what_cannot_be_added_is_left_out() -> None:
    estimator = estimator_on({"static_friction.breakaway_torque": 0.26, "static_friction.stribeck_velocity": 0.1})
    base = estimator.at(NOTHING)
    for variant, starts in starts_of(estimator.data, NOMINAL).items():
        costs = [chi2 for chi2, _ in promised(estimator, base, variant, starts)]
        assert costs == sorted(costs)
        # A linear step with one free scale cannot make it worse.
        assert all(chi2 <= base.chi2 * (1.0 + 1e-9) for chi2 in costs)


def test_what_the_base_may_be_fitted_again_to_is_no_promise() -> None:
    """A second supply voltage beside a free one adds nothing; the mark of an effect shrinks beside a drift like it."""
    estimator = estimator_on({})
    alone = estimator.at(NOTHING)
    beside = estimator.at(Explanation(("armature_resistance", "torque_constant", "supply_voltage")))
    viscous = Variant("viscous_friction", ("coefficient",))
    marks = [largest_mark(estimator, base, viscous, [{"coefficient": 0.002}]) for base in (alone, beside)]
    # Viscous friction equals a joint change of resistance and torque constant, but for what is not linear.
    assert marks[1] < 0.01 * marks[0]


def test_a_change_is_dated_by_its_slope() -> None:
    plain = recording({}, duration=12.0)
    hall = (
        data_of([plain], NOMINAL)
        .runs[0]
        .simulated(NOMINAL, Switch(NOMINAL.with_values({"armature_resistance": 4.4}), 7.0))
    )
    noisy = hall + 0.003 * np.random.default_rng(2).standard_normal(hall.size)
    made = Recording("changed.mcap", "hall_voltage", plain.time, noisy, plain.command)
    estimator = Estimator(data_on(made), NOMINAL)
    plainly = estimator.at(NOTHING)
    promises, starts = zip(*change_starts(estimator, plainly, "armature_resistance", 2), strict=True)
    assert promises[0] < promises[1] < plainly.chi2
    assert starts[0]["armature_resistance" + WHEN] == pytest.approx(7.0, abs=0.7)
    assert starts[0]["armature_resistance"] == pytest.approx(NOMINAL.values["armature_resistance"], rel=0.02)
    assert starts[0]["armature_resistance" + AFTER] == pytest.approx(4.4, rel=0.05)
    apart = abs(starts[0]["armature_resistance" + WHEN] - starts[1]["armature_resistance" + WHEN])
    assert apart > 0.05 * 12.0 * 0.99


@pytest.mark.parametrize("off", [-6.0, 2.0, 6.0])
def test_a_change_is_dated_across_the_steps_of_the_cost(off: float) -> None:
    """A descent from so many seconds beside the moment stays there; from step to step the moment is found."""
    name, true = "spring_stiffness", 1.13 * NOMINAL.values["spring_stiffness"]
    plain = recording({}, duration=40.0)
    hall = data_of([plain], NOMINAL).runs[0].simulated(NOMINAL, Switch(NOMINAL.with_values({name: true}), 15.0))
    noisy = hall + NOISE * np.random.default_rng(0).standard_normal(hall.size)
    made = replace(plain, measured=noisy)
    estimator = Estimator(all_training(data_of([made], NOMINAL)), NOMINAL)
    beside = estimator.fit(Explanation(changed=name), {**NOMINAL.values, name + AFTER: true, name + WHEN: 15.0 + off})
    assert beside.ratio > 2.0
    dated = redated(estimator, beside)
    assert dated.ratio < 1.05
    assert dated.values[name + AFTER] == pytest.approx(true, rel=0.01)
    when = estimates(estimator, dated)[name + WHEN]
    assert when.low <= 15.0 <= when.high
