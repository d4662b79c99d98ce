"""A simulation that is pulled to a recording."""

import math

import numpy as np
import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.plant import Inputs, Model, simulate
from pierburg_ros.plant.following import Pull, follow

NOMINAL = Model.nominal(read_actuator("pierburg"))
PENDULUM = Model.nominal(read_actuator("ak80"))
TIME = np.arange(0.0, 6.0, 0.002)
INPUTS = Inputs(np.arange(0.0, 6.0, 0.5), np.tile([0.3, 0.12, 0.24, 0.18], 3))
STILL = np.zeros(4)


def followed(model, inputs, time, measured, constant, start=STILL, inertial=False):
    pull = Pull.every(time, constant, inertial)
    return follow(model, inputs, time, measured, start, pull)


def test_without_a_pull_it_is_the_simulation():
    measured = simulate(NOMINAL, INPUTS, TIME)
    assert np.array_equal(followed(NOMINAL, INPUTS, TIME, measured + 1.0, math.inf), measured)


@pytest.mark.parametrize("constant", [0.05, 0.3, 1.0])
def test_a_right_model_stays_where_it_is(constant):
    measured = simulate(NOMINAL, INPUTS, TIME)
    assert np.max(np.abs(followed(NOMINAL, INPUTS, TIME, measured, constant) - measured)) < 1e-9


def test_an_error_of_the_start_is_gone_after_some_time_constants():
    measured = simulate(NOMINAL, INPUTS, TIME, 0.5)
    moves = TIME < 0.5
    error = np.abs(followed(NOMINAL, INPUTS, TIME, measured, 0.1, np.array([0.6, 0.0, 0.0, 0.0])) - measured)
    assert error[0] == pytest.approx(0.1 * 4.1 / (math.pi / 2), rel=1e-6)
    # the shaft's own memory, 1.15 s, shortens what the pull leaves of it
    assert error[moves][-1] < error[0] * math.exp(-(0.5 - 0.025) / 0.1)


def test_of_a_shaft_with_inertia_an_error_of_the_velocity_is_gone_too():
    inputs = Inputs(np.arange(0.0, 6.0, 0.5), np.tile([0.4, -0.3, 0.1, 0.5], 3))
    measured = simulate(PENDULUM, inputs, TIME, 0.0, 0.0)
    wrong = np.array([0.2, 2.0, 0.0, 0.0])
    error = np.abs(followed(PENDULUM, inputs, TIME, measured, 0.1, wrong, inertial=True) - measured)
    assert np.max(error[TIME > 1.5]) < 1e-4
    assert np.max(error[TIME < 0.1]) > 0.1


def test_after_a_gap_it_is_where_was_measured():
    measured = simulate(NOMINAL, INPUTS, TIME)
    kept = (TIME < 1.0) | (TIME > 2.2)
    stiff = NOMINAL.with_values({"spring_stiffness": 0.2})
    error = np.abs(followed(stiff, INPUTS, TIME[kept], measured[kept], 0.1) - measured[kept])
    back = int(np.argmax(TIME[kept] > 2.2))
    assert error[back] > 10.0 * np.max(error[back + 1 : back + 5])


def test_a_play_of_the_sensor_moves_along():
    model = NOMINAL.with_values({"sensor_hysteresis.width": 0.02, "sensor_lag.time_constant": 0.02})
    measured = simulate(model, INPUTS, TIME)
    assert np.max(np.abs(followed(model, INPUTS, TIME, measured, 0.1) - measured)) < 1e-9


def test_pulls_come_four_times_in_a_time_constant():
    pull = Pull.every(TIME, 0.4, inertial=False)
    assert np.diff(TIME[pull.last]) == pytest.approx(0.1, abs=0.0021)
    assert pull.angle == pytest.approx(1.0 - np.exp(-np.diff(TIME[np.concatenate([[0], pull.last])]) / 0.4))
