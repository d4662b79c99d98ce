"""The sensor's effects in closed form, applied to the angle of the plant without them."""

from __future__ import annotations

import math

import numpy as np
import pytest
from independent.excitation import rich_duty

from pierburg_ros.actuators import read_actuator
from pierburg_ros.plant import Inputs, Model, simulate

NOMINAL = Model.nominal(read_actuator("pierburg"))


def measured(values: dict[str, float], per_sample: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """Times [s] and Hall voltage [V], with `per_sample` samples in each interval of the duty."""
    time, duty = rich_duty(6.0)
    fine = np.interp(np.arange((time.size - 1) * per_sample + 1) / per_sample, np.arange(time.size), time)
    return fine, simulate(NOMINAL.with_values(values), Inputs(time, duty), fine)


def fraction(voltage: np.ndarray) -> np.ndarray:
    """Fraction of the span that a nominal sensor shows."""
    return (voltage - 0.42) / 4.10


@pytest.mark.parametrize("half_waves", (1.0, 2.0))
def test_nonlinearity_bends_the_span(half_waves: float) -> None:
    _, nominal = measured({})
    _, bent = measured({"sensor_nonlinearity.amplitude": 0.05, "sensor_nonlinearity.half_waves": half_waves})
    x = fraction(nominal)
    expected = 0.42 + 4.10 * (x + 0.05 * np.sin(half_waves * math.pi * x))
    assert np.abs(bent - expected).max() < 1e-12


def test_quantization_rounds_to_multiples_of_the_step() -> None:
    _, nominal = measured({})
    _, rounded = measured({"sensor_quantization.step": 0.01})
    assert np.abs(rounded / 0.01 - np.round(rounded / 0.01)).max() < 1e-9
    assert np.abs(rounded - nominal).max() <= 0.005 + 1e-12


def test_hysteresis_drags_the_magnet_behind_the_shaft() -> None:
    _, nominal = measured({})
    _, dragged = measured({"sensor_hysteresis.width": 0.03})
    half = 4.10 * 0.015 / (math.pi / 2)
    magnet, expected = nominal[0], []
    for voltage in nominal:
        magnet = min(max(magnet, voltage - half), voltage + half)
        expected.append(magnet)
    assert np.abs(dragged - expected).max() < 5e-5, "a reversal between two samples drags further than they show"


def test_lag_is_a_first_order_filter() -> None:
    """Reference: the exact filter over 40 straight pieces in each sample interval."""
    _, fine = measured({}, per_sample=40)
    time, lagged = measured({"sensor_lag.time_constant": 0.009})
    step = (time[1] - time[0]) / 40
    decay = math.exp(-step / 0.009)
    y, expected = fine[0], [fine[0]]
    for k in range(1, fine.size):
        slope = (fine[k] - fine[k - 1]) / step
        y = fine[k] - slope * 0.009 + (y - fine[k - 1] + slope * 0.009) * decay
        if k % 40 == 0:
            expected.append(y)
    assert np.abs(lagged - expected).max() < 0.2e-3


def test_lag_follows_the_magnet_not_the_shaft() -> None:
    """Within the play nothing moves: the lagging sensor stays where it is while the shaft turns less than that."""
    time = np.arange(0.0, 1.0, 0.002)
    duty = np.where(time < 0.1, 0.0, 0.19)
    values = {"sensor_hysteresis.width": 0.5, "sensor_lag.time_constant": 0.01}
    still = simulate(NOMINAL.with_values(values), Inputs(time, duty), time)
    moving = simulate(NOMINAL, Inputs(time, duty), time)
    assert 0.01 < np.ptp(moving) < 4.10 * 0.25 / (math.pi / 2)
    assert np.ptp(still) == 0.0
