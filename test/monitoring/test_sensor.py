"""Faults put into the signal of a valve at rest, and the valve without them."""

import numpy as np
import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.closed_loop import simulate_runs
from pierburg_ros.control import Settings
from pierburg_ros.monitoring.movements import BLOCK_SAMPLES, Blocks, Samples
from pierburg_ros.monitoring.sensor import SensorWatch
from pierburg_ros.plant import Model
from pierburg_ros.plant.decode import decoded

NOISE = 0.0012  # rad
MODEL = Model.nominal(read_actuator("pierburg"))


def names(angle, duty=0.0):
    """Faults that a watch names in a signal [rad] of 500 samples a second, by block."""
    watch = SensorWatch(MODEL, 0.01)
    size = angle.size
    samples = Samples(
        np.arange(size) / 500.0, angle, np.broadcast_to(duty, size), np.full(size, np.nan), np.ones(size, dtype=bool)
    )
    return [{f.names[0] for f in watch.take(block, 1.0)} for block in Blocks().take(samples)]


def noise(seconds, seed=0):
    """Noise of the sensor around 0 [rad]."""
    return NOISE * np.random.default_rng(seed).standard_normal(round(seconds * 500))


def test_a_healthy_sensor_at_rest_is_left_alone():
    assert not set().union(*names(noise(120.0)))


def test_a_frozen_sensor_is_named_and_a_coarse_one_is_not():
    angle = noise(20.0)
    angle[7500:] = angle[7500]
    assert "frozen" in names(angle)[7500 // BLOCK_SAMPLES + 5]
    coarse = np.round(noise(20.0) / 0.01) * 0.01
    assert not any("frozen" in found for found in names(coarse))


def test_noise_that_trebles_is_named_within_a_second():
    angle = noise(30.0)
    angle[10_000:] *= 3.0
    found = names(angle)
    assert not any("noise" in each for each in found[: 10_000 // BLOCK_SAMPLES])
    assert "noise" in found[10_000 // BLOCK_SAMPLES + 20]


def test_single_jumps_are_passed_over_and_repeated_ones_named():
    angle = noise(40.0)
    angle[8000] += 0.5
    assert not any("spikes" in found for found in names(angle))
    angle[9000:12_000:500] += 0.5
    assert "spikes" in names(angle)[-1]


@pytest.mark.parametrize("offset", [0.05, -0.05])
def test_an_offset_shows_at_the_stop(offset):
    angle = noise(30.0)
    angle[9000:] += offset
    found = names(angle)
    assert not any("offset" in each for each in found[: 9000 // BLOCK_SAMPLES])
    assert any("offset" in each for each in found[10_000 // BLOCK_SAMPLES :])


def test_an_angle_that_stays_while_the_duty_drives_the_shaft_is_named():
    angle = 0.8 + noise(20.0)
    duty = np.full(angle.size, 0.15)
    duty[8000:] = 0.6
    found = names(angle, duty)
    assert not any(found[: 8000 // BLOCK_SAMPLES])
    assert "stuck" in found[8000 // BLOCK_SAMPLES + 3]


def test_nothing_is_said_before_the_usual_noise_is_known():
    assert not any(names(0.8 + noise(5.0), np.full(2500, 0.6)))


def test_a_loop_that_begins_to_hunt_is_no_noise_of_the_sensor():
    """With 10 ms on the way to the valve the duty answers noise too late, and the shaft shakes by twice the noise."""
    setpoints = np.radians([35.0, 45.0, 55.0, 45.0])[np.arange(15_000) // 750 % 4]
    models = [MODEL.with_values({"input_delay.delay": late}) for late in (0.0, 0.01)]
    parts = [simulate_runs(model, Settings(), setpoints[np.newaxis], noise=0.003) for model in models]
    angle = decoded(MODEL, np.concatenate([part.hall_voltage[0] for part in parts]))
    duty = np.concatenate([parts[0].duty[0], np.zeros(5), parts[1].duty[0][:-5]])
    assert np.std(np.diff(angle[15_000:], 2)) > 2.0 * np.std(np.diff(angle[:15_000], 2))
    assert not any("noise" in found for found in names(angle, duty))
