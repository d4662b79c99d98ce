"""Whatever a sensor, a clock or a person sends, the control law stays usable."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pierburg_ros.control import Controller, Settings
from pierburg_ros.control.linear import step as linear_step

ANY = st.floats(allow_nan=True, allow_infinity=True)
EXTREME = st.sampled_from([1e306, -1e306, 1.7e308, -1.7e308, 5e-324, 1e-6, 0.0, -0.0])
SEQUENCES = st.lists(st.tuples(ANY | EXTREME, ANY | EXTREME, ANY | EXTREME), max_size=30)
VALVE = Settings()
PREDICTING = VALVE.with_values({"predictor_delay": 0.02, "predictor_lag": 0.005, "predictor_speed": 43.0})


def healthy(controller):
    """Duties for samples of a shaft at rest below its setpoint, after whatever came before."""
    return [controller.step(0.8, 0.42 + 0.001 * (k % 2), 0.002) for k in range(4000)]


def is_finite(controller):
    """Whether everything the law remembers is a finite number."""
    return all(np.all(np.isfinite(controller._state[name])) for name in controller._state.dtype.names)


@pytest.mark.parametrize("valve", [VALVE, PREDICTING], ids=["plain", "predicting"])
@given(sequence=SEQUENCES)
@settings(max_examples=300, deadline=None)
def test_no_sequence_of_floats_makes_state_or_duty_other_than_finite_and_within_limits(valve, sequence):
    controller = Controller(valve)
    for hall_voltage, dt, setpoint in sequence:
        assert VALVE.duty_minimum <= controller.step(setpoint, hall_voltage, dt) <= VALVE.duty_maximum
        assert is_finite(controller)
        controller.change(valve.with_values({"proportional_gain": 100.0, "integral_gain": 1e4}))
        assert is_finite(controller)


@given(SEQUENCES)
@settings(max_examples=20, deadline=None)
def test_after_any_sequence_it_controls_again_as_if_nothing_had_been(sequence):
    controller = Controller(VALVE)
    for hall_voltage, dt, setpoint in sequence:
        controller.step(setpoint, hall_voltage, dt)
    assert healthy(controller)[-1] == pytest.approx(healthy(Controller(VALVE))[-1], abs=1e-9)


@given(SEQUENCES)
@settings(max_examples=100, deadline=None)
def test_the_plain_pid_stays_finite_too(sequence):
    from pierburg_ros.control import law

    state = law.new_state()
    for values in sequence:
        if np.all(np.isfinite(values)):
            hall_voltage, dt, setpoint = values
            assert math.isfinite(linear_step(VALVE.record(), state, setpoint, hall_voltage, dt))
            assert all(np.all(np.isfinite(state[name])) for name in state.dtype.names)


def test_one_absurd_sample_costs_no_more_than_itself():
    controller = Controller(VALVE)
    controller.step(0.8, 0.42, 0.002)
    controller.step(0.8, 1e306, 0.002)
    assert math.isfinite(controller.step(0.8, 0.42, 0.002))
    assert healthy(controller)[-1] > 0.5
