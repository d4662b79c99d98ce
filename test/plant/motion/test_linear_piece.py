"""The closed-form pieces against SciPy's matrix exponential."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from scipy.linalg import expm

from pierburg_ros.plant.motion.linear_piece import responses, turning_time
from pierburg_ros.plant.motion.third_order import factors, third_responses


def exponents(low: float, high: float) -> st.SearchStrategy[float]:
    return st.floats(low, high).map(lambda exponent: 10.0**exponent)


def impulse_responses(coefficients: list[float], step: float, integrals: int = 2) -> np.ndarray:
    """Derivatives, impulse response and integrals of x^(n) + ... = 0, by matrix exponential in units of `step`."""
    order = len(coefficients)
    chain = np.diag(np.ones(order + 2), 1)
    scaled = [c * step ** (order - k) for k, c in enumerate(reversed(coefficients))]
    chain[order - 1, :order] = [-value for value in scaled]
    grown = expm(chain)
    column = [grown[k, order - 1] for k in range(order - 1, -1, -1)] + list(grown[0, order : order + integrals])
    return np.array(column) * step ** np.arange(order + integrals)


@given(exponents(-2, 4), exponents(-2, 6), exponents(-6, -2), st.sampled_from((-1.0, 1.0)))
def test_second_order_piece(damping: float, stiffness: float, step: float, sign: float) -> None:
    expected = impulse_responses([damping, sign * stiffness], step)
    found = responses(damping, sign * stiffness, step)[:4]
    scale = [1.0, step, step**2, step**3]
    # the difference of two exponentials cancels: up to 3e-7 of the second integral was seen
    assert np.abs((np.array(found) - expected) / scale).max() < 1e-6


@given(exponents(-3.2, 1), exponents(-12, 0), st.sampled_from((-1.0, 0.0, 1.0)))
@example(1.165e-3, 7.7e-9, 1.0)
def test_second_order_piece_with_nearly_one_root(damping: float, apart: float, sign: float) -> None:
    """As of a pendulum whose weight pulls level: all integrals, for the third puts right what a line has missed."""
    stiffness = 0.25 * damping**2 - sign * min(apart, 0.25 * damping**2)
    expected = impulse_responses([damping, stiffness], 1.0, integrals=3)
    assert responses(damping, stiffness, 1.0) == pytest.approx(expected, abs=3e-8)


@given(exponents(-4, -2), exponents(-6, -3), exponents(-2, 3), exponents(-4, -2))
def test_third_order_piece(inductance: float, inertia: float, stiffness: float, step: float) -> None:
    """Coefficients as the plant has them: winding, body and load torque that follows the angle."""
    a = 4.139 / inductance + 0.03 / inertia
    b = (0.82**2 + 4.139 * 0.03) / (inertia * inductance) + stiffness / inertia
    c = 4.139 * stiffness / (inertia * inductance)
    expected = impulse_responses([a, b, c], step)
    found = third_responses(a, b, c, step)
    scale = [1.0, step, step**2, step**3, step**4]
    assert np.abs((np.array(found) - expected) / scale).max() < 1e-5


@given(st.floats(-50, 50), st.floats(-500, 500), st.floats(-5000, 5000))
def test_cubic_is_the_product_of_its_factors(a: float, b: float, c: float) -> None:
    root, p, q = factors(a, b, c)
    size = 1.0 + abs(a) + abs(b) + abs(c)
    assert p - root == pytest.approx(a, abs=1e-6 * size)
    assert q - root * p == pytest.approx(b, abs=1e-6 * size)
    assert -root * q == pytest.approx(c, abs=1e-6 * size)


def test_velocity_of_a_swing_turns_when_its_acceleration_is_zero() -> None:
    damping, stiffness, acceleration, jerk = 3.0, 400.0, 2.0, -5.0
    frequency = math.sqrt(stiffness - 0.25 * damping**2)
    moment = turning_time(damping, stiffness, acceleration, jerk)
    swing = acceleration * math.cos(frequency * moment)
    swing += (jerk + 0.5 * damping * acceleration) / frequency * math.sin(frequency * moment)
    assert 0.0 < moment < math.pi / frequency + 1e-3
    assert swing == pytest.approx(0.0, abs=1e-9)


def test_overdamped_motion_never_turns() -> None:
    assert turning_time(100.0, 4.0, 1.0, -1.0) == math.inf
