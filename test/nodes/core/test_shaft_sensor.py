"""Angle and velocity from Hall voltages alone."""

import math

import numpy as np
import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.nodes.core.shaft_sensor import ShaftSensor

VOLTS_PER_RADIAN = (4.52 - 0.42) / (math.pi / 2)


@pytest.fixture
def sensor():
    return ShaftSensor(read_actuator("pierburg"), 0.01)


@pytest.mark.parametrize(("voltage", "angle"), [(0.42, 0.0), (4.52, math.pi / 2), (2.47, math.pi / 4)])
def test_the_calibration_is_that_of_the_paper(sensor, voltage, angle):
    assert sensor.take(voltage, 0.0)[0] == pytest.approx(angle)


def test_velocity_approaches_the_slope_of_a_ramp_with_the_filters_time_constant(sensor):
    elapsed, speed = 1e-4, 2.0
    times = np.arange(0, 0.05, elapsed)
    velocity = [sensor.take(0.42 + speed * time * VOLTS_PER_RADIAN, elapsed)[1] for time in times]
    expected = speed * (1 - np.exp(-times / 0.01))
    np.testing.assert_allclose(velocity, expected, atol=0.02 * speed)


def test_the_first_sample_makes_no_velocity(sensor):
    assert sensor.take(4.0, 0.002)[1] == 0.0


def test_reset_forgets_the_previous_sample(sensor):
    sensor.take(0.42, 0.002)
    sensor.reset()
    assert sensor.take(4.52, 0.002)[1] == 0.0
