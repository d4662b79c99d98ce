"""What an effect adds along a measured motion is what the simulator makes of it."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator

from pierburg_ros.actuators import read_actuator
from pierburg_ros.effects import EFFECTS, Effect
from pierburg_ros.inference.balance import missing
from pierburg_ros.inference.data import data_of
from pierburg_ros.inference.motion import Motion, motion_of
from pierburg_ros.plant import Inputs, Model, simulate
from pierburg_ros.recording import Channel, Recording

NOMINAL = Model.nominal(read_actuator("pierburg"))
ALONG = [effect for effect in EFFECTS if effect.along is not None]
OTHERS = [effect for effect in EFFECTS if effect.along is None and effect.variants]
VALUES = {
    "armature_inductance": {"inductance": 0.1},
    "direction_dependent_friction": {"viscous_difference": 0.1, "coulomb_difference": 0.03},
    "drag": {"quadratic": 0.05, "cubic": 0.02},
    "external_load": {"torque": 0.05, "amplitude": 0.02, "frequency": 0.4, "phase": 1.0, "start": 5.0, "end": 25.0},
    "gear_compliance": {"stiffness": 0.6, "damping": 0.0},
    "input_delay": {"delay": 0.1},
    "nonlinear_spring": {"knee_stiffness": 0.1, "knee_angle": 0.6, "cubic_stiffness": 0.04},
    "sensor_lag": {"time_constant": 0.02},
    "sensor_nonlinearity": {"amplitude": 0.03, "half_waves": 1.0},
    "static_friction": {"breakaway_torque": 0.27, "stribeck_velocity": 0.3},
}
"""Strong enough to be seen above what the filter leaves; of a lag, shorter than the motion's own changes."""

SLIDING = 0.2
"""Velocity [rad/s] above which the shaft slides, and no slow sensor only ends a movement that is over."""


def duty_at(time: np.ndarray) -> np.ndarray:
    """A smooth duty through random values, so that the filter of the motion leaves little."""
    knots = np.clip(0.2 + 0.08 * np.random.default_rng(3).standard_normal(101), 0.02, 0.42)
    return np.asarray(PchipInterpolator(np.linspace(0.0, 40.0, 101), knots)(time))


def values_of(effect: Effect) -> dict[str, float]:
    typical = effect.typical_values(NOMINAL.values, NOMINAL.scales)
    return typical | {f"{effect.id}.{name}": value for name, value in VALUES.get(effect.id, {}).items()}


def moved(model: Model) -> Motion:
    """The motion of `model` under that duty, sampled at 2 kHz without noise."""
    time = np.arange(0.0, 40.0, 0.0005)
    duty = duty_at(time)
    hall = simulate(model, Inputs(time, duty), time)
    run = data_of([Recording("x.mcap", "hall_voltage", time, hall, Channel(time, duty))], NOMINAL).runs[0]
    motion = motion_of(run, NOMINAL, 0.25 * NOMINAL.scales.time)
    return motion.only(np.abs(motion.velocity) > SLIDING)


def test_the_balance_of_the_model_itself_lacks_next_to_nothing() -> None:
    assert np.std(missing(moved(NOMINAL), NOMINAL.values, ())) < 1e-3


@pytest.mark.parametrize("effect", ALONG, ids=lambda effect: effect.id)
def test_what_the_balance_lacks_is_what_the_effect_adds(effect: Effect) -> None:
    values = values_of(effect)
    motion = moved(NOMINAL.with_values(values))
    lacks = missing(motion, NOMINAL.values, ())
    assert effect.along is not None
    adds = effect.along(motion, {**NOMINAL.values, **values})
    assert adds.shape == motion.time.shape
    slope = float(lacks @ adds / (adds @ adds))
    likeness = float(lacks @ adds) / math.sqrt(float(lacks @ lacks) * float(adds @ adds))
    assert slope == pytest.approx(1.0, abs=0.15)
    assert likeness > 0.9


@pytest.mark.parametrize("effect", ALONG, ids=lambda effect: effect.id)
def test_nothing_is_added_at_zero_strength(effect: Effect) -> None:
    stiff = {name: 0.0 for name in effect.strength if not effect.parameter(name).inverse}
    if not stiff:
        pytest.skip("absent where it is rigid, and a balance asks for no rigid one")
    values = values_of(effect) | {f"{effect.id}.{name}": 0.0 for name in stiff}
    values |= {f"{effect.id}.{p.name}": NOMINAL.values[p.above] for p in effect.parameters if p.above}
    assert effect.along is not None
    assert np.max(np.abs(effect.along(moved(NOMINAL), {**NOMINAL.values, **values}))) < 1e-12


@pytest.mark.parametrize("effect", OTHERS, ids=lambda effect: effect.id)
def test_what_adds_nothing_along_a_motion_says_where_it_shows(effect: Effect) -> None:
    assert effect.mark is not None
