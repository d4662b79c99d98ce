"""Where simulations start, on shafts drawn by hand."""

from dataclasses import replace

import numpy as np
import pytest
from support.recordings import NOMINAL

from pierburg_ros.estimation.initial_state import InitialState, from_standstill
from pierburg_ros.estimation.run import parts_of, run_of
from pierburg_ros.plant import Inputs, simulate
from pierburg_ros.recording import Channel, Recording

NOISE = 0.003
TIME = np.arange(5000) / 500.0


def drawn(times, levels, seed=0):
    """Straight lines between `levels` [V] with noise, ten seconds at 500 Hz."""
    noise = NOISE * np.random.default_rng(seed).standard_normal(TIME.size)
    return Recording("run", "hall_voltage", TIME, np.interp(TIME, times, levels) + noise, Channel(TIME, 0.0 * TIME))


def state(recording):
    return InitialState.of(recording.time, recording.measured).state(NOMINAL, "hall_voltage")


def test_a_shaft_seen_at_a_stop_starts_exactly_there():
    assert state(drawn((0.0, 10.0), (0.4205, 0.4205))) == (0.0, 0.0, 0.0, 0.0)


def test_a_shaft_held_half_way_starts_at_the_mean_of_its_first_samples():
    angle, velocity, *_ = state(drawn((0.0, 10.0), (2.47, 2.47)))
    assert angle == pytest.approx(np.pi / 4, abs=3e-4)
    assert velocity == 0.0


@pytest.mark.parametrize("seed", range(5))
def test_one_that_rests_for_a_moment_starts_at_rest(seed):
    angle, velocity, *_ = state(drawn((0.0, 0.04, 0.5, 10.0), (2.47, 2.47, 4.0, 4.0), seed))
    assert angle == pytest.approx(np.pi / 4, abs=2e-3)
    assert velocity == 0.0


def test_a_shaft_that_moves_at_once_starts_with_its_velocity():
    time = np.arange(2000) / 500.0
    moving = 2.47 + 2.0 * time + 1e-4 * np.random.default_rng(3).standard_normal(2000)
    _, velocity, *_ = InitialState.of(time, moving).state(NOMINAL, "hall_voltage")
    assert velocity == pytest.approx(2.0 * (np.pi / 2) / 4.1, rel=0.05)


@pytest.mark.parametrize("rate", (-0.1, 0.05, 0.1))
def test_one_that_creeps_starts_with_its_velocity(rate):
    """Fifty samples, 0.1 s, tell a rate to 15 mV/s, which is 6 mrad/s."""
    recording = drawn((0.0, 0.15, 10.0), (2.0, 2.0 + 0.15 * rate, 2.0))
    angle, velocity, *_ = state(recording)
    assert velocity == pytest.approx(rate * (np.pi / 2) / 4.1, abs=0.02)
    assert angle == pytest.approx((2.0 - 0.42) * (np.pi / 2) / 4.1, abs=1.5e-3)
    assert from_standstill(recording, NOMINAL) is recording


@pytest.mark.parametrize("levels", ((0.42, 3.0, 3.0, 0.42), (4.52, 3.0, 3.0, 0.42)))
def test_one_that_sets_off_from_a_stop_loses_nothing(levels):
    recording = drawn((0.0, 0.05, 1.0, 9.0), levels)
    assert from_standstill(recording, NOMINAL) is recording


@pytest.mark.parametrize("seed", range(5))
def test_one_that_slows_down_is_taken_up_where_it_comes_to_rest(seed):
    recording = drawn((0.0, 0.05, 0.4, 2.0, 5.0, 9.0), (2.0, 2.5, 3.0, 3.0, 0.42, 4.0), seed)
    kept = from_standstill(recording, NOMINAL)
    assert 0.5 <= kept.time[0] <= 0.7
    np.testing.assert_array_equal(kept.measured, recording.measured[recording.time >= kept.time[0]])
    assert kept.duration == recording.time[-1] - kept.time[0]
    assert from_standstill(kept, NOMINAL) is kept


def test_one_that_rests_too_late_loses_nothing():
    recording = drawn((0.0, 0.05, 4.0, 6.0, 9.0), (1.0, 1.5, 3.0, 3.0, 0.42))
    assert from_standstill(recording, NOMINAL) is recording
    assert not InitialState.of(recording.time, recording.measured).known


def test_the_angle_is_that_of_the_model_that_is_simulated():
    """2.47 V is half way between 0.42 V and 4.52 V, and a third of the way between 1.42 V and 4.57 V."""
    found = InitialState.of(TIME, np.full(TIME.size, 2.47))
    other = NOMINAL.with_values({"hall_voltage_closed": 1.42, "hall_voltage_open": 4.57})
    assert found.state(NOMINAL, "hall_voltage") == (pytest.approx(np.pi / 4), 0.0, 0.0, 0.0)
    assert found.state(other, "hall_voltage") == (pytest.approx(np.pi / 6), 0.0, 0.0, 0.0)
    assert found.state(NOMINAL, "position") == (np.pi / 2, 0.0, 0.0, 0.0)


def test_a_slow_sensor_is_behind_a_shaft_that_gathers_speed():
    """What follows an even acceleration with a first-order lag is behind by lag times velocity less its own change."""
    angle, velocity, acceleration, lag, volts = 0.8, 2.0, 30.0, 0.02, 4.1 / (np.pi / 2)
    shown = angle - lag * (velocity - lag * acceleration)
    start = InitialState(
        0.42 + volts * shown, volts * (velocity - lag * acceleration), NOISE, True, curvature=volts * acceleration
    )
    slow = NOMINAL.with_values({"sensor_lag.time_constant": lag})
    assert start.state(slow, "hall_voltage") == pytest.approx((angle, velocity, acceleration, 0.0))
    begun = simulate(slow, Inputs(np.zeros(1), np.zeros(1)), np.zeros(1), angle, velocity, acceleration)
    assert begun[0] == pytest.approx(0.42 + volts * shown)


@pytest.mark.parametrize(("levels", "came"), (((2.0, 2.2, 3.0, 3.0, 3.0), 1.0), ((4.0, 3.8, 3.0, 3.0, 3.0), -1.0)))
def test_a_sensor_with_play_trails_behind_the_way_by_which_the_shaft_came(levels, came):
    whole = drawn((0.0, 0.05, 0.4, 2.0, 10.0), levels)
    (part,), _ = parts_of(whole, NOMINAL)
    start, play = run_of(part, NOMINAL, whole=whole).start, 0.02
    loose = NOMINAL.with_values({"sensor_hysteresis.width": play})
    angle, _, _, direction = start.state(loose, "hall_voltage")
    assert part.time[0] > 0.3
    assert direction == came
    assert angle - start.state(NOMINAL, "hall_voltage")[0] == pytest.approx(0.5 * play * came)
    begun = simulate(loose, Inputs(np.zeros(1), np.zeros(1)), np.zeros(1), angle, 0.0, 0.0, direction)
    assert begun[0] == pytest.approx(start.level)


@pytest.mark.parametrize(
    "effect",
    (
        {},
        {"sensor_hysteresis.width": 0.02},
        {"presliding.stiffness": 15.0, "presliding.damping": 0.05},
        {"gear_compliance.stiffness": 17.6, "gear_compliance.damping": 0.061},
        {"thermal_resistance.thermal_resistance": 30.0, "thermal_resistance.heat_capacity": 0.1},
    ),
    ids=("nominal", "play", "bristles", "compliance", "heat"),
)
def test_what_is_taken_up_at_a_rest_goes_on_as_it_would_have(effect):
    """Opening has ended in a rest at 2.2 s; the simulation begun there has to be that begun on the stop."""
    model = NOMINAL.with_values(effect)
    inputs = Inputs(np.array([0.0, 0.2, 0.7, 2.5, 4.0, 6.0]), np.array([0.0, 0.3, 0.23, 0.3, 0.1, 0.25]))
    expected = simulate(model, inputs, TIME)
    noisy = expected + 0.001 * np.random.default_rng(1).standard_normal(TIME.size)
    whole = Recording("run", "hall_voltage", TIME, noisy, Channel(inputs.time, inputs.command))
    begun = TIME >= 2.2
    part = replace(whole, time=TIME[begun], measured=noisy[begun])
    assert NOMINAL.actuator.lower_stop + 0.1 < (expected[begun][0] - 0.42) / 4.1 * np.pi / 2 < 1.4
    np.testing.assert_allclose(run_of(part, model, whole=whole).simulated(model), expected[begun], atol=0.001)
