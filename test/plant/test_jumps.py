"""Jumps are resolved, not smeared: breaking loose, meeting flanks, hitting stops, in steps far above their duration."""

from __future__ import annotations

import math

import numpy as np
import pytest
from independent.event_driven import COULOMB, Valve, trajectory

from pierburg_ros.actuators import read_actuator
from pierburg_ros.plant import Inputs, Model, simulate
from pierburg_ros.plant.signal_path import advance
from pierburg_ros.plant.state import new_state

NOMINAL = Model.nominal(read_actuator("pierburg"))
SUPPLY, RESISTANCE, CONSTANT = 13.5, 4.139, 37.3 * 0.022


@pytest.mark.parametrize("interval", (0.0005, 0.002, 0.01, 0.05))
def test_breaking_loose_on_a_falling_stribeck_curve(interval: float) -> None:
    """The jump lasts about 0.1 ms; where it leads must not depend on the sample interval."""
    breakaway, scale = 0.29, 0.05
    values = {"static_friction.breakaway_torque": breakaway, "static_friction.stribeck_velocity": scale}
    steps = np.array([0.0, 0.1, 1.0])
    duty = np.array([0.0, 0.218, 0.0])
    time = np.arange(0.0, 1.5, interval)
    valve = Valve(level=lambda a, w, d, m: COULOMB + (breakaway - COULOMB) * math.exp(-((w / scale) ** 2)))
    expected = 0.42 + 4.10 * trajectory(valve, steps, duty, time) / (math.pi / 2)
    found = simulate(NOMINAL.with_values(values), Inputs(steps, duty), time)
    assert np.ptp(expected) > 0.1
    assert np.abs(found - expected).max() < 0.2e-3


def test_breakaway_that_fades_at_once_is_a_jump() -> None:
    """Stribeck velocity 0: held up to the breakaway torque, then sliding at T_c from the first moment."""
    values = {"static_friction.breakaway_torque": 0.27, "static_friction.stribeck_velocity": 0.0}
    time = np.arange(0.0, 0.5, 0.002)
    torque = 0.29 + 0.27
    duty = torque * RESISTANCE / (CONSTANT * SUPPLY)
    held = simulate(NOMINAL.with_values(values), Inputs(time[:1], np.array([duty * 0.999])), time)
    loose = simulate(NOMINAL.with_values(values), Inputs(time[:1], np.array([duty * 1.001])), time)
    sliding = simulate(NOMINAL, Inputs(time[:1], np.array([duty * 1.001])), time)
    assert np.ptp(held) == 0.0
    assert np.abs(loose - sliding).max() < 1e-5


def test_flanks_meet_when_the_motor_has_crossed_the_gap() -> None:
    """One call over a whole second, meeting and departure within it, equals a thousand short ones."""
    model = NOMINAL.with_values({"backlash.gap": 0.06, "backlash.motor_friction_share": 0.2})
    ends = []
    for parts in (1, 1000):
        record = model.record()
        state = new_state(record)
        for duty in (-0.2, 0.2):
            for _ in range(parts):
                advance(record[0], state[0], duty, np.nan, True, 0.3 / parts)
        ends.append((state["angle"][0], state["motor_angle"][0]))
    assert ends[0][0] > 0.05
    assert ends[0] == pytest.approx(ends[1], abs=1e-7)


def test_stop_is_hit_at_its_moment() -> None:
    """Full speed into the open stop within one long call: the shaft stands exactly on it."""
    record = NOMINAL.record()
    state = new_state(record)
    advance(record[0], state[0], 1.0, np.nan, True, 3.0)
    assert (state["angle"][0], state["velocity"][0]) == (math.pi / 2, 0.0)


def test_elastic_stop_is_entered_at_its_edge() -> None:
    """Against SciPy with the contact as an event of its own, sampled twice a contact time."""
    stiffness, damping = 60.0, 0.02

    def load(time: float, angle: float, velocity: float) -> float:
        spring = 0.29 + 0.1419 * angle
        beyond = angle - math.pi / 2
        return spring + (max(0.0, stiffness * beyond + damping * velocity) if beyond > 0.0 else 0.0)

    time = np.arange(0.0, 0.6, 0.005)
    steps, duty = np.array([0.0, 0.4]), np.array([1.0, 0.2])
    valve = Valve(load=load, stops=(-math.inf, math.inf))
    expected = 0.42 + 4.10 * trajectory(valve, steps, duty, time, start=0.3) / (math.pi / 2)
    model = NOMINAL.with_values({"stop_compliance.stiffness": stiffness, "stop_compliance.damping": damping})
    found = simulate(model, Inputs(steps, duty), time, initial_angle=0.3)
    assert np.abs(found - expected).max() < 0.2e-3
