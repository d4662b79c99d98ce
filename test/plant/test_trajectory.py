"""The nominal trajectory: closed form, sampling that does not matter, pieces that go on."""

from __future__ import annotations

import math

import numpy as np
import pytest
from independent.excitation import rich_duty

from pierburg_ros.actuators import read_actuator
from pierburg_ros.plant import Inputs, Model, simulate

NOMINAL = Model.nominal(read_actuator("pierburg"))
RESISTANCE, CONSTANT, STIFFNESS, INERTIA = 4.139, 37.3 * 0.022, 0.1419, 2.4602e-6


def test_step_response_is_equation_11() -> None:
    """With exp(-p t) and p1 + p2 = 2 xi omega_n, as the audit of the paper finds it must be meant."""
    time = np.arange(0.0, 5.0, 0.01)
    voltage = simulate(NOMINAL, Inputs(time[:1], np.array([0.2])), time)
    damping, pull = CONSTANT**2 / RESISTANCE / INERTIA, STIFFNESS / INERTIA
    fast = 0.5 * damping + math.sqrt(0.25 * damping**2 - pull)
    slow = pull / fast
    gain = (0.2 * 13.5 * CONSTANT / RESISTANCE - 0.29 - 0.2007) / STIFFNESS
    angle = gain * (1.0 - (fast * np.exp(-slow * time) - slow * np.exp(-fast * time)) / (fast - slow))
    assert slow == pytest.approx(0.872, rel=1e-2)
    assert np.abs(voltage - 0.42 - 4.10 * angle / (math.pi / 2)).max() < 1e-9


@pytest.mark.parametrize("every", (2, 5, 25, 125))
def test_sparse_samples_lie_on_the_dense_trajectory(every: int) -> None:
    time, duty = rich_duty()
    dense = simulate(NOMINAL, Inputs(time, duty), time)
    sparse = simulate(NOMINAL, Inputs(time, duty), time[::every])
    assert np.abs(sparse - dense[::every]).max() < 1e-7


def test_uneven_samples_lie_on_the_even_trajectory() -> None:
    time, duty = rich_duty()
    extra = np.sort(np.random.default_rng(3).uniform(0.0, time[-1], 5000))
    both = np.unique(np.concatenate([time, extra]))
    voltage = simulate(NOMINAL, Inputs(time, duty), both)[np.searchsorted(both, time)]
    assert np.abs(voltage - simulate(NOMINAL, Inputs(time, duty), time)).max() < 1e-7


def test_swinging_plant_does_not_depend_on_sampling() -> None:
    """With the bridge open the valve swings at 240 rad/s: a long step must not jump over a reversal."""
    loose = NOMINAL.with_values({"coulomb_friction": 0.001, "spring_preload": 0.0})
    time = np.arange(0.0, 0.4, 1e-4)
    inputs = Inputs(time[:1], np.zeros(1), enabled=np.array([False]))
    dense = simulate(loose, inputs, time, initial_angle=0.5)
    sparse = simulate(loose, inputs, time[::400], initial_angle=0.5)
    assert np.abs(sparse - dense[::400]).max() < 1e-9


def test_repeated_runs_are_identical() -> None:
    time, duty = rich_duty(4.0)
    first = simulate(NOMINAL, Inputs(time, duty), time)
    assert np.array_equal(first, simulate(NOMINAL, Inputs(time, duty), time))


def test_supply_voltage_scales_the_duty() -> None:
    time, duty = rich_duty(4.0)
    half = Inputs(time, duty, supply_voltage=np.full(time.size, 6.75))
    halved = simulate(NOMINAL, Inputs(time, 0.5 * duty), time)
    assert np.abs(simulate(NOMINAL, half, time) - halved).max() < 1e-12


def test_pendulum_swings_with_its_period() -> None:
    """No stops, no friction, open bridge: small swings at sqrt(gravity_torque / inertia), measured in rad."""
    pendulum = Model.nominal(read_actuator("xl330"))
    free = pendulum.with_values({"coulomb_friction": 0.0, "viscous_friction.coefficient": 0.0})
    time = np.arange(0.0, 3.0, 0.005)
    angle = simulate(free, Inputs(time[:1], np.zeros(1), enabled=np.array([False])), time, initial_angle=0.02)
    gravity = free.values["gravity_torque"] / free.values["total_inertia"]
    slower = 1.0 - 0.02**2 / 16.0
    assert np.abs(angle - 0.02 * np.cos(math.sqrt(gravity) * slower * time)).max() < 2e-5
