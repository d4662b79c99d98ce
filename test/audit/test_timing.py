"""A lag that grows is told from one that is only told badly."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.audit import audit
from pierburg_ros.audit.timing import PLAINLY, _common, _curve, _lag
from pierburg_ros.identification.experiment.synthetic import synthetic_recording
from pierburg_ros.plant import Model
from pierburg_ros.proof.real.channels import with_effect
from pierburg_ros.proof.real.strengths import strength, values_at
from pierburg_ros.recording import Channel, read_recording

DDP = Path(__file__).parents[3] / "shared/data/ak80/ddp.csv"
LAGS = np.array([-15, -9, -3, 3, 9, 15])


def curves(values):
    """Of six parts of what was measured at growing lags behind the same, with noise."""
    random = np.random.default_rng(0)
    found = []
    for lag, part in zip(LAGS, np.array_split(np.arange(100, values.size - 100), LAGS.size), strict=True):
        noisy = values[part - lag] + 0.3 * np.std(values) * random.standard_normal(part.size)
        found.append(_curve(noisy - np.mean(noisy), values[part] - np.mean(values[part])))
    return np.stack(found)


def share_in_common(found):
    """What one lag for all parts keeps of how well each correlates at its own."""
    return _common(found) / np.mean([_lag(curve)[1] for curve in found])


def test_lags_of_a_sharp_motion_have_no_common_one():
    steps = np.repeat(np.random.default_rng(1).standard_normal(300), 10)
    found = curves(steps)
    assert [_lag(curve)[0] for curve in found] == pytest.approx(LAGS, abs=1.0)
    assert share_in_common(found) < PLAINLY


def test_lags_of_a_slow_motion_have_a_common_one():
    assert share_in_common(curves(np.sin(2.0 * np.pi * np.arange(3000) / 450.0))) > PLAINLY


@pytest.mark.parametrize("rate", [0.985, 0.995, 1.002, 1.01, 1.018])
@pytest.mark.parametrize("changes", [{}, {"load_dependent_friction.coefficient": 0.1}], ids=str)
def test_a_clock_of_the_duty_at_another_rate_is_told(rate, changes):
    valve, time = Model.nominal(read_actuator("pierburg")), np.arange(30_000) / 500.0
    duty = np.repeat(np.random.default_rng(1).uniform(-0.1, 0.4, 75), 400)
    given = synthetic_recording(valve.with_values(changes), time, duty)
    (fault,) = audit([replace(given, command=Channel(rate * time, duty))], valve)
    _, percent, _, way = fault.what.split()
    assert way == ("fast" if rate > 1.0 else "slow")
    assert float(percent) == pytest.approx(100.0 * abs(1.0 - 1.0 / rate), rel=0.1)


@pytest.mark.skipif(not DDP.exists(), reason="the recordings of the pendulum are not beside this checkout")
def test_a_play_of_a_sensor_is_no_clock():
    """Lags from 18 samples early to 9 late, at which it correlates by 0.99 of what it does at one of them."""
    numbers = {"torque_scale": 0.8077, "total_inertia": 0.1318, "coulomb_friction": 0.132}
    model = Model.nominal(read_actuator("ak80")).with_values({**numbers, "viscous_friction.coefficient": 0.0145})
    half = 0.5 * strength("sensor_hysteresis", "plain", model, ())
    played = with_effect(read_recording(DDP), "sensor_hysteresis", values_at("sensor_hysteresis", half, model), model)
    assert audit([played], model) == []
