"""Several effects together act in the order of the signal path, which is written out here."""

from __future__ import annotations

import math

import numpy as np
import pytest
from independent.event_driven import COULOMB, SUPPLY, Valve, spring, trajectory
from independent.excitation import rich_duty

from pierburg_ros.actuators import read_actuator
from pierburg_ros.effects import EFFECTS
from pierburg_ros.plant import Inputs, Model, simulate
from pierburg_ros.proof.formulation import simulate_textbook

NOMINAL = Model.nominal(read_actuator("pierburg"))


def test_active_effects_are_listed_in_the_order_of_the_signal_path() -> None:
    model = NOMINAL.with_values({"sensor_lag.time_constant": 0.01, "input_delay.delay": 0.01, "backlash.gap": 0.02})
    assert model.active_effects == ("input_delay", "backlash", "sensor_lag")
    order = [effect.id for effect in EFFECTS]
    assert order.index("pwm_deadband") < order.index("supply_sag") < order.index("cogging_torque")


def test_dead_band_comes_before_the_source_resistance() -> None:
    """The source sees the effective duty: i = d V / (R + R_s d^2) with d behind the dead band."""
    width, source, duty = 0.05, 3.0, 0.28
    values = {"pwm_deadband.width": width, "supply_sag.source_resistance": source}
    time = np.arange(0.0, 25.0, 0.01)
    voltage = simulate(NOMINAL.with_values(values), Inputs(time[:1], np.array([duty])), time)
    d = duty - width
    torque = 37.3 * 0.022 * d * SUPPLY / (4.139 + source * d**2)
    angle = (torque - 0.29 - COULOMB) / 0.1419
    assert voltage[-1] == pytest.approx(0.42 + 4.10 * angle / (math.pi / 2), abs=1e-6)


def test_play_then_lag_then_curve_then_converter() -> None:
    """The sensor's stages, applied one after the other to the angle at rest."""
    values = {
        "sensor_hysteresis.width": 0.02,
        "sensor_lag.time_constant": 0.01,
        "sensor_nonlinearity.amplitude": 0.05,
        "sensor_nonlinearity.half_waves": 1.0,
        "sensor_quantization.step": 0.05,
    }
    time = np.arange(0.0, 20.0, 0.01)
    inputs = Inputs(time[:1], np.array([0.21]))
    angle = (simulate(NOMINAL, inputs, time)[-1] - 0.42) / 4.10 * math.pi / 2
    x = (angle - 0.01) / (math.pi / 2)
    expected = 0.42 + 4.10 * (x + 0.05 * math.sin(math.pi * x))
    found = simulate(NOMINAL.with_values(values), inputs, time)[-1]
    assert found == pytest.approx(round(expected / 0.05) * 0.05, abs=1e-12)


def test_frictions_add_up() -> None:
    """Stribeck excess, tight spot, load and direction at once, against SciPy with events."""
    time, duty = rich_duty()
    values = {
        "viscous_friction.coefficient": 0.02,
        "static_friction.breakaway_torque": 0.24,
        "static_friction.stribeck_velocity": 0.2,
        "load_dependent_friction.coefficient": 0.05,
        "direction_dependent_friction.coulomb_difference": 0.02,
        "position_dependent_friction.amplitude": 0.03,
        "position_dependent_friction.center": 0.8,
        "position_dependent_friction.width": 0.2,
        "cogging_torque.amplitude": 0.01,
        "cogging_torque.periods_per_motor_revolution": 2.0,
    }

    def level(angle: float, velocity: float, direction: float, motor: float) -> float:
        stribeck = (0.24 - COULOMB) * math.exp(-((velocity / 0.2) ** 2))
        spot = 0.03 * math.exp(-(((angle - 0.8) / 0.2) ** 2))
        return COULOMB + stribeck + spot + 0.05 * abs(motor) + (0.02 if direction < 0 else 0.0)

    valve = Valve(
        level=level,
        viscous=lambda direction: 0.02,
        load=lambda t, a, w: spring(t, a, w) + 0.01 * math.sin(2.0 * 37.3 * a),
    )
    expected = 0.42 + 4.10 * trajectory(valve, time, duty, time) / (math.pi / 2)
    found = simulate(NOMINAL.with_values(values), Inputs(time, duty), time)
    assert np.abs(found - expected).max() < 0.5e-3


COMBINATIONS = (
    {"backlash.gap": 0.05, "static_friction.breakaway_torque": 0.25, "static_friction.stribeck_velocity": 0.1},
    {"backlash.gap": 0.05, "backlash.motor_friction_share": 0.2, "presliding.stiffness": 20.0,
     "presliding.damping": 0.02},
    {"gear_compliance.stiffness": 20.0, "gear_compliance.damping": 0.02, "armature_inductance.inductance": 0.001},
    {"gear_compliance.stiffness": 20.0, "gear_compliance.damping": 0.02, "stop_compliance.stiffness": 20.0,
     "stop_compliance.damping": 0.02, "viscous_friction.coefficient": 0.02},
    {"presliding.stiffness": 20.0, "presliding.damping": 0.02, "static_friction.breakaway_torque": 0.25,
     "static_friction.stribeck_velocity": 0.1, "thermal_resistance.thermal_resistance": 20.0,
     "thermal_resistance.heat_capacity": 0.5},
    {"input_delay.delay": 0.0123, "sensor_lag.time_constant": 0.008, "stop_compliance.stiffness": 20.0,
     "stop_compliance.damping": 0.02, "armature_inductance.inductance": 0.001},
)  # fmt: skip


@pytest.mark.parametrize("values", COMBINATIONS, ids=lambda v: "+".join(dict.fromkeys(n.split(".")[0] for n in v)))
def test_combination_agrees_with_the_textbook_formulation(values: dict[str, float]) -> None:
    time, duty = rich_duty()
    found = simulate(NOMINAL.with_values(values), Inputs(time, duty), time)
    apart = found - simulate_textbook(values, time, duty, time)
    assert np.sqrt(np.mean(apart**2)) < 0.3e-3
