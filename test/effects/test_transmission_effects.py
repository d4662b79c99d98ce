"""Play and elasticity of the gear against closed forms, SciPy and the books of energy."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from pierburg_ros.actuators import read_actuator
from pierburg_ros.plant import Inputs, Model, simulate
from pierburg_ros.plant.signal_path import advance
from pierburg_ros.plant.state import new_state

NOMINAL = Model.nominal(read_actuator("pierburg"))
SUPPLY, RESISTANCE, CONSTANT, INERTIA = 13.5, 4.139, 37.3 * 0.022, 2.4602e-6
BRAKING = CONSTANT**2 / RESISTANCE
COULOMB, PRELOAD, STIFFNESS = 0.2007, 0.29, 0.1419


def departure(model: Model, duty: float) -> float:
    """Seconds from switching to `duty` until the valve leaves its closed stop, 1 s after negative duty."""
    time = np.arange(0.0, 1.5, 1e-4)
    signal = np.where(time < 0.2, 0.0, np.where(time < 1.2, -0.2, duty))
    voltage = simulate(model, Inputs(time, signal), time)
    return float(time[np.argmax(voltage > 0.42)]) - 1.2


def test_play_delays_the_departure_by_the_time_the_motor_needs_to_cross_it() -> None:
    """Backed off, the motor crosses the gap alone, against its share of the friction."""
    gap, share, duty = 0.08, 0.2, 0.3
    model = NOMINAL.with_values({"backlash.gap": gap, "backlash.motor_friction_share": share})
    torque = CONSTANT * duty * SUPPLY / RESISTANCE - share * COULOMB
    pole, speed = BRAKING / INERTIA, torque / BRAKING
    crossing = gap / speed + 1.0 / pole
    assert departure(model, duty) - departure(NOMINAL, duty) == pytest.approx(crossing, abs=2e-4)


def test_preload_hides_the_play() -> None:
    """As long as duty is never negative the flanks stay together: bit for bit the plant without play."""
    time = np.arange(0.0, 6.0, 0.002)
    duty = np.abs(np.sin(time)) * 0.3
    model = NOMINAL.with_values({"backlash.gap": 0.1, "backlash.motor_friction_share": 0.2})
    apart = simulate(model, Inputs(time, duty), time) - simulate(NOMINAL, Inputs(time, duty), time)
    assert np.abs(apart).max() < 1e-9


def test_parted_shaft_closes_at_the_speed_of_its_own_damping() -> None:
    """The motor backs off at full duty; the shaft follows more slowly: viscous w = spring - friction."""
    model = NOMINAL.with_values({"backlash.gap": 0.4, "viscous_friction.coefficient": 0.2})
    record = model.record()
    state = new_state(record, 0.9)
    for _ in range(20):
        advance(record[0], state[0], -1.0, np.nan, True, 0.001)
    rate = STIFFNESS / 0.2
    rest = (COULOMB - PRELOAD) / STIFFNESS
    expected = rest + (0.9 - rest) * math.exp(-rate * 0.02)
    assert state["motor_angle"][0] < state["angle"][0] - 0.1
    assert state["angle"][0] == pytest.approx(expected, abs=2e-4)


def test_elastic_gear_follows_the_balance_of_motor_and_shaft() -> None:
    """Opening from rest: three first-order equations, stiff, by SciPy's Radau."""
    stiffness, damping, duty = 10.0, 0.02, 0.3
    drive = CONSTANT * duty * SUPPLY / RESISTANCE

    def sliding(time: float, state: np.ndarray) -> list[float]:
        motor, velocity, shaft = state
        held = PRELOAD + STIFFNESS * shaft + COULOMB
        shaft_velocity = velocity + (stiffness * (motor - shaft) - held) / damping
        teeth = stiffness * (motor - shaft) + damping * (velocity - shaft_velocity)
        return [velocity, (drive - BRAKING * velocity - teeth) / INERTIA, shaft_velocity]

    def standing(time: float, state: np.ndarray) -> list[float]:
        teeth = stiffness * state[0] + damping * state[1]
        return [state[1], (drive - BRAKING * state[1] - teeth) / INERTIA, 0.0]

    def loose(time: float, state: np.ndarray) -> float:
        return stiffness * state[0] + damping * state[1] - PRELOAD - COULOMB

    loose.terminal = True  # type: ignore[attr-defined]
    options = {"method": "Radau", "rtol": 1e-9, "atol": 1e-11}
    held = solve_ivp(standing, (0.0, 1.0), [0.0, 0.0, 0.0], events=loose, **options)
    time = np.arange(0.0, 0.3, 0.002)
    after = time[time > held.t[-1]]
    free = solve_ivp(sliding, (held.t[-1], 0.3), held.y[:, -1], t_eval=after, **options)
    expected = np.concatenate([np.zeros(time.size - after.size), free.y[2]])
    model = NOMINAL.with_values({"gear_compliance.stiffness": stiffness, "gear_compliance.damping": damping})
    voltage = simulate(model, Inputs(time[:1], np.array([duty])), time)
    assert expected[-1] > 0.3
    assert np.abs(voltage - 0.42 - 4.10 * expected / (math.pi / 2)).max() < 0.2e-3


def test_elastic_gear_twists_by_the_torque_it_holds() -> None:
    """Pressed against the open stop: the motor stands beyond the shaft by torque / stiffness."""
    record = NOMINAL.with_values({"gear_compliance.stiffness": 5.0, "gear_compliance.damping": 0.01}).record()
    state = new_state(record, math.pi / 2)
    for _ in range(1000):
        advance(record[0], state[0], 0.9, np.nan, True, 0.002)
    torque = CONSTANT * 0.9 * SUPPLY / RESISTANCE
    assert state["angle"][0] == math.pi / 2
    assert state["motor_angle"][0] - state["angle"][0] == pytest.approx(torque / 5.0, rel=1e-6)


@pytest.mark.parametrize("gap", (0.0, 0.05))
def test_elastic_gear_gives_back_no_more_than_it_was_given(gap: float) -> None:
    """Supply off and bridge open: kinetic, spring and twist energy together only fall."""
    stiffness = 8.0
    values = {"gear_compliance.stiffness": stiffness, "gear_compliance.damping": 0.01, "backlash.gap": gap}
    record = NOMINAL.with_values(values).record()
    state = new_state(record, 1.2)
    energies = []
    for _ in range(4000):
        advance(record[0], state[0], 0.0, np.nan, False, 2e-5)
        angle, twist = state["angle"][0], state["motor_angle"][0] - state["angle"][0]
        deflection = twist if twist > 0.0 else min(twist + gap, 0.0)
        energies.append(
            0.5 * INERTIA * state["motor_velocity"][0] ** 2
            + PRELOAD * angle
            + 0.5 * STIFFNESS * angle**2
            + 0.5 * stiffness * deflection**2
        )
    assert energies[-1] < 0.5 * energies[0]
    assert np.diff(energies).max() < 1e-6
