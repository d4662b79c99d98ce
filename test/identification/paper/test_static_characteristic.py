"""The static characteristic against the closed form and equation (9)."""

import numpy as np
import pytest
from support.closed_form import GAIN, NOISE, TIME_CONSTANT

from pierburg_ros.actuators import read_actuator
from pierburg_ros.identification.paper.static_characteristic import static_characteristic
from pierburg_ros.recording import Channel, Recording

# Equation (9): torque R / (V k_g k_m).
D_C = 0.2007 * 4.139 / (13.5 * 37.3 * 0.022)
D_PRE = 0.29 * 4.139 / (13.5 * 37.3 * 0.022)


def test_equation_9_from_the_settled_angles(nominal, closed_form_recording):
    found = static_characteristic([closed_form_recording], nominal.actuator)
    assert found.coulomb_duty.value == pytest.approx(D_C, rel=0.002)
    assert found.preload_duty.value == pytest.approx(D_PRE, rel=0.002)
    assert found.gain.value == pytest.approx(GAIN, rel=0.002)
    assert found.time_constant == pytest.approx(TIME_CONSTANT, rel=0.01)
    low, high = found.coulomb_duty.ci95
    assert low < D_C < high


def test_branches_are_two_friction_duties_apart(nominal, closed_form_recording):
    found = static_characteristic([closed_form_recording], nominal.actuator)
    apart = found.angle(0.15, -1) - found.angle(0.15, 1)
    assert apart == pytest.approx(2 * 0.2007 / 0.1419, rel=0.005)


def test_a_recording_without_holds_has_none(nominal):
    time = np.arange(5000) / 500.0
    duty = Channel(time, 0.2 + 0.05 * np.sin(time))
    measured = 1.0 + 0.5 * np.sin(time) + NOISE * np.random.default_rng(0).standard_normal(5000)
    recording = Recording("wavy", "hall_voltage", time, measured, duty)
    assert static_characteristic([recording], nominal.actuator) is None


def test_a_pendulum_has_none(closed_form_recording):
    recording = Recording(
        "bench",
        "position",
        closed_form_recording.time,
        closed_form_recording.measured,
        closed_form_recording.command,
    )
    assert static_characteristic([recording], read_actuator("xl330")) is None
