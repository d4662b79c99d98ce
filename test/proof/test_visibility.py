"""What a recording shows: known ties leave nothing, plain effects leave much, bounds scale as they must."""

from dataclasses import replace

import numpy as np
import pytest

from pierburg_ros.proof.bench import record
from pierburg_ros.proof.concealment import draw
from pierburg_ros.proof.visibility import faint, ideal, noise_floor, relative_bounds, share_holding, visibility

PLAIN = replace(draw("sensor_lag", 0, 3), duration=20.0, holdout_duration=5.0, rate=500.0, noise=0.002)


@pytest.fixture(scope="module")
def run():
    return record(PLAIN)


def test_a_plain_effect_is_shown(run):
    seen = visibility(PLAIN, run)
    assert seen.shown and seen.distance > 1e4
    assert seen.recalibrated_rms <= seen.effect_rms
    assert 0.0 < seen.share_of_time < 1.0


def test_viscous_friction_is_absorbed_by_two_drifts_but_not_by_one(run):
    viscous = replace(PLAIN, kind="viscous_friction", effects={"viscous_friction.coefficient": 0.03})
    seen = visibility(viscous, record(viscous))
    assert seen.recalibrated_rms < 0.0002
    assert seen.shown


def test_viscous_friction_beside_four_wrong_numbers_is_four_others():
    """Of the base parameters four reach every change of sliding motion's four lumps."""
    guessed = replace(draw("beside_guesses", 1, 901), duration=6.0)
    assert guessed.effect_ids == ("viscous_friction",) and len(guessed.drifted) == 4
    seen = visibility(guessed, record(guessed))
    assert seen.distance < 1e-6 and not seen.shown


def test_a_vanishing_effect_is_not_shown():
    faint = replace(PLAIN, effects={"sensor_lag.time_constant": 1e-6})
    assert not visibility(faint, record(faint)).shown


def test_of_two_effects_the_one_that_leaves_no_mark_is_faint():
    play = {"backlash.gap": 0.03, "backlash.motor_friction_share": 0.1}  # the preload keeps the flanks together
    pair = replace(PLAIN, kind="two", effects={**play, "viscous_friction.coefficient": 0.03})
    run = record(pair)
    pushed = replace(run, duty=np.full_like(run.time, 0.5))
    assert faint(pair, ideal(pair.values, pushed), pushed, 0.002) == ("backlash",)


def test_without_an_effect_there_is_nothing_to_see():
    drifted = replace(draw("drift", 0, 3), duration=5.0)
    seen = visibility(drifted, record(drifted))
    assert seen.effect_rms == 0.0 and seen.nominal_rmse > 0.0 and not seen.bounds


def test_bounds_grow_with_the_noise(run):
    quiet, loud = (relative_bounds(PLAIN, run, noise)["sensor_lag.time_constant"] for noise in (0.001, 0.004))
    assert loud == pytest.approx(4.0 * quiet)


def test_the_bound_is_what_one_parameter_in_white_noise_allows(run):
    """Shift by a lag of T: the signal changes by -T dy/dt, so the bound is noise / (T |dy/dt|)."""
    slope = np.gradient(run.ideal, run.time)
    lag = PLAIN.effects["sensor_lag.time_constant"]
    expected = 0.002 / (lag * np.sqrt(np.sum(slope**2)))
    assert relative_bounds(PLAIN, run, 0.002)["sensor_lag.time_constant"] == pytest.approx(expected, rel=0.35)


def test_the_noise_includes_the_converter():
    assert noise_floor(replace(PLAIN, noise=0.0, converter_step=0.012)) == pytest.approx(0.012 / np.sqrt(12.0))


def test_the_share_of_time_counts_the_strongest_samples():
    assert share_holding(np.array([0.0] * 90 + [1.0] * 10)) == pytest.approx(0.09, abs=0.011)
    assert share_holding(np.zeros(10)) == 0.0
