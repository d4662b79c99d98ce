"""What a control engineer expects of the controller beside its law."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pierburg_ros.control import Controller, Settings

PERIOD = 0.002
SETTINGS = Settings(
    proportional_gain=1.0,
    integral_gain=5.0,
    integral_dead_zone=0.004,
    pi_output_support=0.3,
    derivative_support=200.0,
    derivative_time_constant=0.001,
    transfer_time=0.01,
)


def hall(angle):
    """Hall voltage [V] of the contract's sensor."""
    return 0.42 + 4.1 * angle / (math.pi / 2)


def settled(setpoint, hall_voltage, settings=SETTINGS, samples=100):
    """A controller that has seen the same sample many times, so that no start is left in it."""
    controller = Controller(settings)
    for _ in range(samples):
        controller.step(setpoint, hall_voltage, PERIOD)
    return controller


@given(
    st.lists(st.tuples(st.floats(0.0, math.pi / 2), st.floats(-1.0, 6.0), st.floats(-0.01, 0.1)), max_size=30),
    st.floats(-1.0, 0.0),
    st.floats(0.0, 1.0),
)
def test_the_duty_keeps_its_limits(samples, lowest, highest):
    controller = Controller(SETTINGS.with_values({"duty_minimum": lowest, "duty_maximum": highest}))
    for sample in samples:
        assert lowest <= controller.step(*sample) <= highest


@given(st.floats(0.0, math.pi / 2))
def test_no_error_gives_no_duty_and_no_derivative(setpoint):
    controller = Controller(SETTINGS)
    for _ in range(5):
        assert controller.step(setpoint, hall(setpoint), PERIOD) == pytest.approx(0.0, abs=1e-12)
    assert controller.internals.derivative == pytest.approx(0.0, abs=1e-9)


def test_the_error_is_in_hall_volts_and_positive_towards_open():
    controller = Controller(SETTINGS)
    controller.step(math.pi / 4, 0.42, PERIOD)
    assert controller.internals.error == pytest.approx(2.05)
    assert controller.internals.saturated


def test_the_first_sample_neither_kicks_nor_jumps():
    controller = Controller(SETTINGS)
    assert controller.step(1.0, 0.42, PERIOD) == 0.0
    assert controller.internals.derivative == 0.0
    second = controller.step(1.0, 0.42, PERIOD)
    assert second == pytest.approx(SETTINGS.positive * (1.0 - math.exp(-PERIOD / 0.01)))


def test_the_derivative_follows_a_ramp_of_the_error():
    controller = Controller(SETTINGS)
    for sample in range(60):
        controller.step(1.0, 1.0 + 3.0 * sample * PERIOD, PERIOD)
    assert controller.internals.derivative == pytest.approx(-3.0, rel=1e-6)


def test_the_derivative_filter_has_its_time_constant():
    controller = Controller(SETTINGS.with_values({"derivative_time_constant": 0.05}))
    fine = 1e-5
    for sample in range(5001):
        controller.step(1.0, 1.0 - 2.0 * sample * fine, fine)
    assert controller.internals.derivative == pytest.approx(2.0 * (1.0 - math.exp(-1.0)), rel=1e-3)


def test_the_integrator_adds_up_the_error_outside_its_dead_zone():
    error = 0.05
    controller = settled(0.5, hall(0.5) - error, samples=101)
    expected = SETTINGS.proportional_gain * error + SETTINGS.integral_gain * error * 100 * PERIOD
    assert controller.internals.pi_output == pytest.approx(expected)


def test_the_integrator_rests_in_its_dead_zone():
    controller = settled(0.5, hall(0.5) - 0.0039)
    assert controller.internals.pi_output == pytest.approx(0.0039)


def test_saturation_does_not_wind_the_integrator_up():
    controller = settled(1.5, 0.42, samples=2000)
    controller.step(1.5, hall(1.5) - 0.1, PERIOD)
    assert controller.internals.pi_output == pytest.approx(0.1 * SETTINGS.proportional_gain, abs=0.002)


def test_a_limited_duty_does_not_wind_the_integrator_up():
    controller = settled(1.0, hall(1.0) - 0.1, SETTINGS.with_values({"duty_maximum": 0.1}), samples=2000)
    assert controller.internals.saturated
    assert controller.internals.pi_output < 0.15


@given(
    st.floats(0.1, 10.0),
    st.floats(0.1, 1.0),
    st.floats(0.3, 0.95),
    st.floats(-0.25, 0.25),
    st.floats(50.0, 900.0),
)
def test_a_change_of_settings_does_not_move_the_duty(gain, support, centre, error, derivative_support):
    controller = settled(0.7, hall(0.7) - error, samples=20)
    before = controller.step(0.7, hall(0.7) - error, PERIOD)
    changed = {
        "proportional_gain": gain,
        "pi_output_support": support,
        "positive": centre,
        "derivative_support": derivative_support,
        "integral_gain": 0.0,
        "transfer_time": 10.0,
    }
    controller.change(SETTINGS.with_values(changed))
    after = controller.step(0.7, hall(0.7) - error, PERIOD)
    assert after == pytest.approx(before, abs=1e-3)


def test_a_gain_change_at_rest_stays_without_effect():
    controller = settled(0.7, hall(0.7) - 0.05)
    before = controller.step(0.7, hall(0.7) - 0.05, PERIOD)
    controller.change(SETTINGS.with_values({"proportional_gain": 2.0, "integral_gain": 0.0}))
    for _ in range(200):
        after = controller.step(0.7, hall(0.7) - 0.05, PERIOD)
    assert after == pytest.approx(before, abs=1e-9)


def test_settings_can_change_before_the_first_sample():
    controller = Controller(SETTINGS)
    controller.change(SETTINGS.with_values({"proportional_gain": 2.0}))
    controller.step(0.1, hall(0.1) - 0.01, PERIOD)
    assert controller.internals.pi_output == pytest.approx(0.02)


def test_disabled_it_gives_zero_and_enabled_it_leaves_from_zero():
    controller = settled(0.7, hall(0.2))
    controller.enable(False)
    assert not controller.enabled
    assert controller.step(0.7, hall(0.2), PERIOD) == 0.0
    controller.enable(True)
    duties = [controller.step(0.7, hall(0.2), PERIOD) for _ in range(100)]
    assert duties[0] == 0.0
    assert np.all(np.diff(duties) > -1e-12)
    assert duties[-1] == pytest.approx(SETTINGS.positive, abs=1e-6)


def test_enabling_an_enabled_controller_changes_nothing():
    controller = settled(0.7, hall(0.5))
    before = controller.step(0.7, hall(0.5), PERIOD)
    controller.enable(True)
    assert controller.step(0.7, hall(0.5), PERIOD) == pytest.approx(before, abs=1e-3)


def test_a_restart_forgets_the_past():
    controller = settled(0.7, hall(0.5))
    controller.restart()
    assert controller.step(0.7, hall(0.5), PERIOD) == 0.0


@pytest.mark.parametrize(
    "sample",
    [(math.nan, 1.0, PERIOD), (0.5, math.nan, PERIOD), (0.5, math.inf, PERIOD), (0.5, 1.0, math.nan)],
)
def test_passes_over_a_sample_that_is_not_finite(sample):
    controller = settled(0.7, hall(0.6))
    duty = controller.step(0.7, hall(0.6), PERIOD)
    internals = controller.internals
    assert controller.step(*sample) == duty
    assert controller.internals == internals


def test_a_clock_that_stands_or_steps_back_integrates_nothing():
    controller = settled(0.7, hall(0.69))
    before = controller.internals
    controller.step(0.7, hall(0.69), 0.0)
    controller.step(0.7, hall(0.69), -5.0)
    assert controller.internals == before
