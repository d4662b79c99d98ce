"""Fixtures: recordings whose parameters are known, made without the simulator where a closed form exists."""

import numpy as np
import pytest
from support.closed_form import NOISE, sliding

from pierburg_ros.actuators import read_actuator
from pierburg_ros.identification.experiment.excitation import duty_sequence
from pierburg_ros.identification.experiment.synthetic import synthetic_recording
from pierburg_ros.plant import Model
from pierburg_ros.recording import Channel, Recording


@pytest.fixture(scope="session")
def nominal():
    return Model.nominal(read_actuator("pierburg"))


@pytest.fixture(scope="session")
def rich_recording(nominal):
    time = np.arange(20_000) / 500.0
    return synthetic_recording(nominal, time, duty_sequence("rich", nominal, time), NOISE, seed=1)


@pytest.fixture(scope="session")
def closed_form_recording():
    """Opening steps from rest and stairs down, from the solution of first-order sliding motion."""
    levels = [0.0, 0.22, 0.25, 0.10, 0.07, 0.05, 0.23, 0.09, 0.06, 0.0, 0.24, 0.255, 0.08]
    angles = sliding(levels, hold=2.0, rate=500)
    noise = NOISE * np.random.default_rng(5).standard_normal(angles.size)
    duty = Channel(2.0 * np.arange(len(levels)), np.array(levels))
    volts = 0.42 + 4.1 / (np.pi / 2) * angles + noise
    return Recording("closed form", "hall_voltage", np.arange(angles.size) / 500, volts, duty)
