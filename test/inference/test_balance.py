"""The balance of torques, and what it starts fits from."""

import math

import numpy as np
import pytest
from scipy.signal import savgol_filter
from support.recordings import NOMINAL, recording, recording_in_closed_loop

from pierburg_ros.effects.static_friction import at_rests
from pierburg_ros.errors import InputError
from pierburg_ros.inference.balance import Balance
from pierburg_ros.inference.data import data_of
from pierburg_ros.inference.fit import Fitter, ladder
from pierburg_ros.inference.motion import motion_of
from pierburg_ros.inference.search import free_parameters
from pierburg_ros.inference.shortlist import balanced, independent
from pierburg_ros.plant import Model

TRUE = {"armature_resistance": 5.1, "torque_constant": 0.021, "spring_preload": 0.31, "coulomb_friction": 0.18}


def balance_of(*recordings) -> Balance:
    data = data_of(recordings, NOMINAL)
    return Balance(NOMINAL.actuator, tuple(motion_of(run, NOMINAL, ladder(data)[0]) for run in data.runs))


@pytest.fixture(scope="module")
def drifted() -> Balance:
    return balance_of(recording(TRUE))


def test_it_gives_back_base_parameters(drifted: Balance):
    values, inside = balanced(drifted, NOMINAL, tuple(TRUE), {})
    assert {name: values[name] for name in TRUE} == pytest.approx(TRUE, rel=0.03)
    assert 0.8 * drifted.size < inside.size <= drifted.size


def test_what_only_a_ratio_shows_is_held():
    # four lumps for six parameters (docs/signals.md): R and k_m, spring and friction, but for one torque and the supply
    data = data_of([recording(TRUE)], NOMINAL)
    fitter = Fitter(data, NOMINAL, ladder(data)[0])
    names = independent(fitter, balance_of(recording(TRUE)), free_parameters(NOMINAL))
    assert len(names) == 4
    assert "supply_voltage" not in names


def test_the_residual_has_the_unit_of_the_command(drifted: Balance):
    # a lost duty is missing in every sample as such
    lost = NOMINAL.with_values({**TRUE, "supply_voltage": 12.0}).values
    per_duty = drifted.residual(lost, ()) / drifted.missing(lost, ())
    torque = lost["gear_ratio"] * lost["torque_constant"] / lost["armature_resistance"] * 12.0
    assert 1.0 / per_duty == pytest.approx(np.full(per_duty.size, torque))


@pytest.mark.parametrize("derivative", [0, 1, 2])
def test_the_filter_is_that_of_savitzky_and_golay(drifted: Balance, derivative):
    whole = drifted.motions[0].whole
    expected = savgol_filter(whole.raw, whole.window, 2, derivative, whole.step, mode="nearest")
    np.testing.assert_allclose(whole.smooth(whole.raw, derivative), expected, atol=1e-9 * np.ptp(expected))


def test_a_motion_is_only_where_the_shaft_moves_off_the_stops(drifted: Balance):
    motion = drifted.motions[0]
    assert np.min(np.abs(motion.velocity)) > 0.0
    assert np.min(motion.angle) > 0.0
    assert np.max(motion.angle) < math.pi / 2


def test_recordings_too_short_together_are_refused():
    short = recording({}, duration=0.3)
    with pytest.raises(InputError, match="is too short"):
        data_of([short], NOMINAL)


def test_short_recordings_count_together():
    pieces = [recording({}, duration=1.0, seed=seed) for seed in range(8)]
    data = data_of(pieces, NOMINAL)
    assert len(data.runs) == 8
    assert data.train.sum() > 5 * data.validation.sum() > 0
    assert data.test.sum() > 0


def test_no_sample_is_fitted_and_judges():
    data = data_of([recording({}, duration=24.0)], NOMINAL)
    assert np.all(data.train.astype(int) + data.validation + data.test == 1)


def test_a_position_is_read_as_the_hall_voltage_that_shows_it():
    hall = recording({}, duration=6.0)
    angle = (hall.measured - 0.42) / 4.1 * (math.pi / 2)
    from dataclasses import replace

    as_position = replace(hall, quantity="position", measured=angle)
    run = data_of([as_position], Model.nominal(NOMINAL.actuator)).runs[0]
    assert run.measured == pytest.approx(hall.measured)


@pytest.mark.parametrize("excess", [0.0, 0.07])
def test_rests_tell_how_hard_a_shaft_sticks(excess):
    sliding = NOMINAL.values["coulomb_friction"]
    sticks = {"static_friction.breakaway_torque": sliding + excess, "static_friction.stribeck_velocity": 0.05}
    rests = balance_of(recording_in_closed_loop(sticks if excess else {})).motions[0].rests
    told, _ = at_rests(rests, NOMINAL.values)
    # a rest that ends by a step of the duty bears less before it; the filter blurs what it bears
    assert told["breakaway_torque"] == pytest.approx(excess, abs=0.1 * sliding)


def test_without_a_rest_nothing_is_told():
    assert at_rests([], NOMINAL.values) == ({"breakaway_torque": 0.0}, 0.0)
