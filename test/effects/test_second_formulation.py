"""Every effect against the textbook formulation of `proof`, which shares no code and no idea of solution with it."""

from __future__ import annotations

import numpy as np
import pytest
from independent.excitation import rich_duty

from pierburg_ros.actuators import read_actuator
from pierburg_ros.plant import Inputs, Model, simulate
from pierburg_ros.proof.formulation import simulate_textbook

NOMINAL = Model.nominal(read_actuator("pierburg"))
CASES = {
    "viscous_friction": {"coefficient": 0.03},
    "drag": {"quadratic": 0.01, "cubic": 0.002},
    "static_friction": {"breakaway_torque": 0.25, "stribeck_velocity": 0.1},
    "presliding": {"stiffness": 12.0, "damping": 0.02},
    "load_dependent_friction": {"coefficient": 0.1},
    "direction_dependent_friction": {"viscous_difference": 0.06, "coulomb_difference": 0.03},
    "position_dependent_friction": {"amplitude": 0.06, "center": 0.7, "width": 0.1},
    "backlash": {"gap": 0.07, "motor_friction_share": 0.2},
    "gear_compliance": {"stiffness": 12.0, "damping": 0.01},
    "cogging_torque": {"amplitude": 0.03, "periods_per_motor_revolution": 3.0, "phase": 0.4},
    "nonlinear_spring": {"cubic_stiffness": 0.06, "knee_stiffness": 0.1, "knee_angle": 0.8},
    "stop_compliance": {"stiffness": 15.0, "damping": 0.03},
    "external_load": {"amplitude": 0.05, "frequency": 1.3, "phase": 0.2, "start": 1.0, "end": 9.0},
    "thermal_resistance": {"thermal_resistance": 30.0, "heat_capacity": 0.5},
    "supply_sag": {"source_resistance": 2.0},
    "pwm_deadband": {"width": 0.012},
    "armature_inductance": {"inductance": 0.001},
    "input_delay": {"delay": 0.0203},
    "sensor_lag": {"time_constant": 0.009},
    "sensor_nonlinearity": {"amplitude": 0.04, "half_waves": 2.0},
    "sensor_hysteresis": {"width": 0.02},
    "sensor_quantization": {"step": 0.01},
}


@pytest.mark.parametrize("effect", CASES)
def test_agrees_with_the_textbook_formulation(effect: str) -> None:
    time, duty = rich_duty()
    values = {f"{effect}.{name}": value for name, value in CASES[effect].items()}
    ours = simulate(NOMINAL.with_values(values), Inputs(time, duty), time)
    textbook = simulate_textbook(values, time, duty, time)
    apart = np.abs(ours - textbook)
    if effect == "sensor_quantization":
        assert np.mean(apart > 1e-9) < 0.01, "a sample on the edge of a step may fall to either side"
        assert apart.max() < 0.0101
    else:
        assert apart.max() < 0.5e-3


def test_gear_with_play_and_elastic_teeth_agrees() -> None:
    """Both kinds of transmission at once; flanks part only after negative duty at the closed stop."""
    time, duty = rich_duty()
    values = {"gear_compliance.stiffness": 20.0, "gear_compliance.damping": 0.02, "backlash.gap": 0.05}
    ours = simulate(NOMINAL.with_values(values), Inputs(time, duty), time)
    assert np.sqrt(np.mean((ours - simulate_textbook(values, time, duty, time)) ** 2)) < 0.5e-3


@pytest.mark.parametrize("gear", ["backlash", "gear_compliance"])
def test_drag_behind_a_gear_agrees(gear: str) -> None:
    """A shaft without inertia balances its torques at any moment, those that bend over the velocity too."""
    time, duty = rich_duty()
    values = {f"{effect}.{name}": value for effect in (gear, "drag") for name, value in CASES[effect].items()}
    ours = simulate(NOMINAL.with_values(values), Inputs(time, duty), time)
    assert np.abs(ours - simulate_textbook(values, time, duty, time)).max() < 0.5e-3
