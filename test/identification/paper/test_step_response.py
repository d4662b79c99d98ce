"""Equations (10) to (12) against scipy's linear systems and the closed form."""

import numpy as np
import pytest
from scipy import signal
from support.closed_form import TIME_CONSTANT

from pierburg_ros.identification.paper.static_characteristic import static_characteristic
from pierburg_ros.identification.paper.step_response import (
    primitive_parameters,
    second_order,
    step_response,
    steps_from_rest,
)


def test_equation_11_is_the_step_response_of_its_transfer_function():
    slow, fast = 0.9, 7.0
    time = np.linspace(0.0, 5.0, 200)
    system = signal.TransferFunction([slow * fast], [1.0, slow + fast, slow * fast])
    _, expected = signal.step(system, T=time)
    assert second_order(time, slow, fast) == pytest.approx(expected, abs=1e-6)


@pytest.fixture(scope="module")
def fitted(nominal, closed_form_recording):
    static = static_characteristic([closed_form_recording], nominal.actuator)
    return static, step_response([closed_form_recording], nominal.actuator, static, 13.5)


def test_only_steps_from_rest_are_used(nominal, closed_form_recording):
    steps = steps_from_rest(closed_form_recording, nominal.actuator)
    assert [step.duty for step in steps] == [0.22, 0.24]


def test_gain_and_slow_pole_of_the_primitive_rows(fitted):
    _, response = fitted
    assert response.gain == pytest.approx(37.3 * 0.022 / (4.139 * 0.1419), rel=0.005)
    assert response.slow_pole == pytest.approx(1.0 / TIME_CONSTANT, rel=0.01)


def test_the_fast_pole_is_only_bounded_from_below(fitted):
    _, response = fitted
    assert 100.0 < response.fast_pole_bound < 66_000.0


def test_primitive_parameters_follow_as_in_the_paper(fitted, nominal):
    static, response = fitted
    found = primitive_parameters(response, static, nominal.values)
    expected = {
        "torque_constant": 0.022,
        "spring_stiffness": 0.1419,
        "spring_preload": 0.29,
        "coulomb_friction": 0.2007,
    }
    assert found == pytest.approx(expected, rel=0.02)
