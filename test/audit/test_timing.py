"""A lag that grows is told from one that is only told badly."""

from pathlib import Path

import numpy as np
import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.audit import audit
from pierburg_ros.audit.timing import _curve, _is_common, _lag
from pierburg_ros.plant import Model
from pierburg_ros.proof.real.channels import with_effect
from pierburg_ros.proof.real.strengths import strength, values_at
from pierburg_ros.recording import read_recording

DDP = Path(__file__).parents[3] / "shared/data/ak80/ddp.csv"
LAGS = np.array([-15, -9, -3, 3, 9, 15])


def curves(values):
    """Of six parts of what was measured at growing lags behind the same, with noise."""
    random = np.random.default_rng(0)
    found = []
    for lag, part in zip(LAGS, np.array_split(np.arange(100, values.size - 100), LAGS.size), strict=True):
        noisy = values[part - lag] + 0.3 * np.std(values) * random.standard_normal(part.size)
        found.append(_curve(noisy - np.mean(noisy), values[part] - np.mean(values[part])))
    return found


def test_lags_of_a_sharp_motion_have_no_common_one():
    steps = np.repeat(np.random.default_rng(1).standard_normal(300), 10)
    found = curves(steps)
    assert [_lag(curve)[0] for curve in found] == pytest.approx(LAGS, abs=1.0)
    assert not _is_common(found)


def test_lags_of_a_slow_motion_have_a_common_one():
    assert _is_common(curves(np.sin(2.0 * np.pi * np.arange(3000) / 450.0)))


@pytest.mark.skipif(not DDP.exists(), reason="the recordings of the pendulum are not beside this checkout")
def test_a_play_of_a_sensor_is_no_clock():
    """Lags from 18 samples early to 9 late, at which it correlates by 0.99 of what it does at one of them."""
    numbers = {"torque_scale": 0.8077, "total_inertia": 0.1318, "coulomb_friction": 0.132}
    model = Model.nominal(read_actuator("ak80")).with_values({**numbers, "viscous_friction.coefficient": 0.0145})
    half = 0.5 * strength("sensor_hysteresis", "plain", model, ())
    played = with_effect(read_recording(DDP), "sensor_hysteresis", values_at("sensor_hysteresis", half, model), model)
    assert audit([played], model) == []
