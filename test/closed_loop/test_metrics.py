"""The metrics of a step response against responses whose numbers are known."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pierburg_ros.closed_loop.metrics import settled_band, step_metrics

PERIOD = 0.001
TIME = np.arange(5000) * PERIOD


def first_order(start, target, time_constant):
    angle = target + (start - target) * np.exp(-TIME / time_constant)
    return step_metrics(start, target, angle, np.full(TIME.size, 0.2), PERIOD)


@pytest.mark.parametrize(("start", "target"), [(0.2, 1.2), (1.2, 0.2)])
def test_a_first_order_response(start, target):
    metrics = first_order(start, target, 0.1)
    assert metrics.rise == pytest.approx(0.1 * math.log(9.0), abs=2 * PERIOD)
    assert metrics.settling == pytest.approx(0.1 * math.log(50.0), abs=2 * PERIOD)
    assert metrics.overshoot == 0.0
    assert metrics.steady_state_error == pytest.approx(0.0, abs=1e-9)
    assert metrics.absolute_error == pytest.approx(0.1, rel=0.01)
    assert metrics.effort == pytest.approx(0.2**2 * 5.0)
    assert metrics.hunting == pytest.approx(0.0, abs=1e-8)


def test_overshoot_is_a_share_of_the_step():
    angle = np.where(TIME < 0.1, 0.55, 0.5)
    assert step_metrics(0.25, 0.5, angle, 0 * TIME, PERIOD).overshoot == pytest.approx(0.2)


def test_hunting_is_peak_to_peak_over_the_last_three_of_five_seconds():
    angle = 0.5 + 0.01 * np.sin(2 * math.pi * TIME)
    angle[:1999] += 1.0
    metrics = step_metrics(0.0, 0.5, angle, 0 * TIME, PERIOD)
    assert metrics.hunting == pytest.approx(0.02, rel=1e-4)
    assert metrics.steady_state_error == pytest.approx(0.01 * 2 / math.pi, rel=1e-3)


def test_what_leaves_the_band_late_settles_late():
    angle = np.full(TIME.size, 1.0)
    angle[4321] = 1.0 + 1.01 * settled_band(1.0)
    assert step_metrics(0.0, 1.0, angle, 0 * TIME, PERIOD).settling == pytest.approx(4.322)


def test_what_never_arrives_never_settles():
    metrics = step_metrics(0.0, 1.0, 0.5 + 0 * TIME, 0 * TIME, PERIOD)
    assert metrics.settling == pytest.approx(5.0)
    assert metrics.steady_state_error == pytest.approx(0.5)


@pytest.mark.parametrize(("degrees", "band"), [(5.0, 0.3), (15.0, 0.3), (20.0, 0.4), (80.0, 1.6)])
def test_the_band_is_two_percent_but_at_least_0_3_degree(degrees, band):
    assert math.degrees(settled_band(math.radians(-degrees))) == pytest.approx(band)


@given(st.floats(0.0, 1.5), st.floats(0.05, 1.0), st.floats(0.01, 0.3))
def test_opening_and_closing_are_judged_alike(start, size, time_constant):
    opening = first_order(start, start + size, time_constant)
    closing = first_order(start + size, start, time_constant)
    assert opening.settling == pytest.approx(closing.settling, abs=PERIOD)
    assert opening.absolute_error == pytest.approx(closing.absolute_error)
