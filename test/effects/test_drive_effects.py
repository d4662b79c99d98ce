"""Delay, heat and current of the drive in closed form."""

from __future__ import annotations

import math

import numpy as np
import pytest
from independent.excitation import rich_duty
from scipy.integrate import solve_ivp

from pierburg_ros.actuators import read_actuator
from pierburg_ros.plant import Inputs, Model, simulate
from pierburg_ros.plant.signal_path import advance
from pierburg_ros.plant.state import new_state

NOMINAL = Model.nominal(read_actuator("pierburg"))
SUPPLY, RESISTANCE, CONSTANT = 13.5, 4.139, 37.3 * 0.022


@pytest.mark.parametrize("delay", (0.0005, 0.0203, 0.4))
def test_delay_shifts_the_duty(delay: float) -> None:
    time, duty = rich_duty(6.0)
    late = simulate(NOMINAL.with_values({"input_delay.delay": delay}), Inputs(time, duty), time)
    shifted = simulate(NOMINAL, Inputs(time + delay, duty), time)
    assert np.abs(late - shifted).max() < 1e-7


def test_blocked_motor_heats_as_the_equation_says() -> None:
    """Pressed against the open stop: C d(rise)/dt = V^2 / (R (1 + 0.0039 rise)) - rise / R_th."""
    model = NOMINAL.with_values(
        {"thermal_resistance.thermal_resistance": 20.0, "thermal_resistance.heat_capacity": 0.5}
    )
    record = model.record()
    state = new_state(record, math.pi / 2)
    voltage = 0.8 * SUPPLY

    def heating(time: float, rise: np.ndarray) -> np.ndarray:
        return (voltage**2 / (RESISTANCE * (1.0 + 0.0039 * rise)) - rise / 20.0) / 0.5

    expected = solve_ivp(heating, (0.0, 5.0), [0.0], rtol=1e-9, atol=1e-9).y[0, -1]
    for _ in range(2500):
        advance(record[0], state[0], 0.8, np.nan, True, 0.002)
    assert state["angle"][0] == math.pi / 2
    assert expected > 100.0
    assert state["thermal_resistance"]["rise"][0] == pytest.approx(expected, rel=1e-3)


def test_current_of_a_blocked_motor_rises_exponentially() -> None:
    record = NOMINAL.with_values({"armature_inductance.inductance": 0.002}).record()
    state = new_state(record)
    advance(record[0], state[0], -0.3, np.nan, True, 0.0007)
    final = -0.3 * SUPPLY / RESISTANCE
    assert state["angle"][0] == 0.0
    assert state["current"][0] == pytest.approx(final * (1.0 - math.exp(-RESISTANCE * 0.0007 / 0.002)), rel=1e-9)


def test_sagging_supply_slows_the_motor_to_its_equation() -> None:
    """Standing current i = d V / (R + R_s d^2), seen where the spring holds the valve."""
    source, duty = 2.0, 0.22
    time = np.arange(0.0, 20.0, 0.01)
    voltage = simulate(
        NOMINAL.with_values({"supply_sag.source_resistance": source}), Inputs(time[:1], np.array([duty])), time
    )
    torque = CONSTANT * duty * SUPPLY / (RESISTANCE + source * duty**2)
    angle = (torque - 0.29 - 0.2007) / 0.1419
    assert voltage[-1] == pytest.approx(0.42 + 4.10 * angle / (math.pi / 2), abs=1e-6)


def test_open_bridge_carries_no_current() -> None:
    """Disabled, the motor neither drives nor brakes: the spring throws the valve shut in milliseconds."""
    time = np.arange(0.0, 0.2, 0.001)
    enabled = np.array([False])
    voltage = simulate(NOMINAL, Inputs(time[:1], np.array([1.0]), enabled=enabled), time, initial_angle=1.0)
    closing = math.sqrt(0.1419 / 2.4602e-6)
    rest = (0.2007 - 0.29) / 0.1419
    expected = np.maximum(rest + (1.0 - rest) * np.cos(closing * time[:8]), 0.0)
    assert np.abs(voltage[:8] - 0.42 - 4.10 * expected / (math.pi / 2)).max() < 1e-9
    assert voltage[-1] == 0.42
