"""Recorded inputs and starts, as the simulator gets them."""

import numpy as np
import pytest
from support.recordings import NOMINAL, PIERBURG

from pierburg_ros.actuators import read_actuator
from pierburg_ros.errors import InputError
from pierburg_ros.estimation.run import Switch, resimulated, run_of
from pierburg_ros.identification.experiment.synthetic import synthetic_recording
from pierburg_ros.inference.data import inputs_of
from pierburg_ros.plant import Inputs, Model, simulate
from pierburg_ros.recording import Channel, Recording

TIME = np.arange(2000) / 500.0
OPENED = np.where(TIME < 1.0, 0.0, 0.23)


def recording(measured, **channels):
    duty = channels.pop("duty", Channel(np.array([0.0, 1.0]), np.array([0.0, 0.22])))
    return Recording("run", "hall_voltage", TIME, measured, duty, **channels)


def test_channels_on_different_times_are_held_until_their_next_value():
    supply = Channel(np.array([0.5, 1.5]), np.array([12.0, 13.0]))
    enabled = Channel(np.array([1.0]), np.array([0.0]))
    inputs = inputs_of(recording(np.ones(2000), supply_voltage=supply, enabled=enabled))
    assert inputs.time.tolist() == [0.0, 0.5, 1.0, 1.5]
    assert inputs.command.tolist() == [0.0, 0.0, 0.22, 0.22]
    assert inputs.supply_voltage.tolist() == [12.0, 12.0, 12.0, 13.0]
    assert inputs.enabled.tolist() == [True, True, False, False]


def test_a_recording_without_noise_is_simulated_again_exactly():
    run = synthetic_recording(NOMINAL, TIME, OPENED, noise=0.0)
    assert np.max(np.abs(resimulated(NOMINAL, run)[1] - run.measured)) == 0.0


def test_a_recording_that_begins_on_the_spring_had_its_first_duty_before():
    """A duty of 0.15 holds the valve at 0.8 rad, also while the wire is still bringing what was sent before."""
    late = NOMINAL.with_values({"input_delay.delay": 0.05})
    half_open = 0.42 + 4.1 * 0.8 / (np.pi / 2)
    run = run_of(recording(np.full(TIME.size, half_open), duty=Channel(np.zeros(1), np.full(1, 0.15))), late)
    np.testing.assert_allclose(run.simulated(late), half_open, atol=1e-6)
    released = simulate(late, Inputs(np.zeros(1), np.full(1, 0.15)), TIME, 0.8)
    assert np.min(released) < half_open - 0.1


def test_another_model_takes_over_where_it_switches():
    run = run_of(synthetic_recording(NOMINAL, TIME, OPENED, noise=0.0), NOMINAL)
    weaker = NOMINAL.with_values({"supply_voltage": 12.8})
    nominal, switched = run.simulated(NOMINAL), run.simulated(NOMINAL, Switch(weaker, 2.0))
    # a step ends at the switch, so that the sample before it is rounded otherwise
    np.testing.assert_allclose(switched[TIME < 2.0], nominal[TIME < 2.0], rtol=0.0, atol=1e-12)
    # Less voltage opens the valve less: it is behind by then, and stays so.
    assert np.all(switched[TIME > 2.1] < nominal[TIME > 2.1])


def test_a_position_that_a_hall_voltage_was_turned_into_is_compared_as_position():
    volts = synthetic_recording(NOMINAL, TIME, OPENED, noise=0.0)
    angle = (volts.measured - 0.42) / 4.1 * np.pi / 2
    run = run_of(Recording("bench", "position", TIME, angle, volts.command), NOMINAL)
    np.testing.assert_allclose(run.simulated(NOMINAL), angle, atol=1e-12)


def test_a_model_of_another_sensor_starts_where_its_own_characteristic_says():
    """The first sample is one voltage; which angle it stands for is up to the model that is simulated."""
    other = NOMINAL.with_values({"hall_voltage_closed": 0.5, "hall_voltage_open": 4.4})
    run = run_of(recording(np.full(TIME.size, 2.0), duty=Channel(np.zeros(1), np.full(1, 0.15))), NOMINAL)
    for model in (NOMINAL, other):
        assert run.simulated(model)[0] == pytest.approx(2.0, abs=1e-9)


def test_a_hall_voltage_of_an_actuator_that_measures_its_angle_is_refused():
    bench = Model.nominal(read_actuator("xl330"))
    with pytest.raises(InputError, match="holds a Hall voltage and actuator xl330 measures its angle"):
        run_of(recording(np.ones(2000)), bench)
    assert run_of(recording(np.ones(2000)), NOMINAL).quantity == PIERBURG.quantity
