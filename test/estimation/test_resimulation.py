"""Recorded inputs and starts, as the simulator gets them."""

import numpy as np

from pierburg_ros.estimation.resimulation import inputs_of, resimulate
from pierburg_ros.identification.experiment.synthetic import synthetic_recording
from pierburg_ros.recording import Channel, Recording

TIME = np.arange(2000) / 500.0


def recording(measured, **channels):
    duty = channels.pop("duty", Channel(np.array([0.0, 1.0]), np.array([0.0, 0.22])))
    return Recording("run", "hall_voltage", TIME, measured, duty, **channels)


def test_channels_on_different_times_are_held_until_their_next_value():
    supply = Channel(np.array([0.5, 1.5]), np.array([12.0, 13.0]))
    enabled = Channel(np.array([1.0]), np.array([0.0]))
    inputs = inputs_of(recording(np.ones(2000), supply_voltage=supply, enabled=enabled))
    assert inputs.time.tolist() == [0.0, 0.5, 1.0, 1.5]
    assert inputs.duty.tolist() == [0.0, 0.0, 0.22, 0.22]
    assert inputs.supply_voltage.tolist() == [12.0, 12.0, 12.0, 13.0]
    assert inputs.enabled.tolist() == [True, True, False, False]


def test_a_recording_without_noise_is_simulated_again_exactly(nominal):
    duty = np.where(TIME < 1.0, 0.0, 0.23)
    run = synthetic_recording(nominal, TIME, duty, noise=0.0)
    assert np.max(np.abs(resimulate(nominal, run) - run.measured)) == 0.0
