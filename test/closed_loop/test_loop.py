"""The compiled loop against the stepping plant and controller, and the contract's order of events."""

import math

import numpy as np
import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.closed_loop import simulate_loop, simulate_runs
from pierburg_ros.control import Controller, Schedule, Settings, linear
from pierburg_ros.errors import InputError
from pierburg_ros.plant import Model, Plant

STEP = Schedule(np.array([0.0, 0.1]), np.array([0.0, 0.8]))


@pytest.fixture(scope="module")
def nominal():
    return Model.nominal(read_actuator("pierburg"))


def test_is_the_node_s_controller_against_the_node_s_plant(nominal):
    """The same run by the objects that the nodes use, one sample of delay written out."""
    run = simulate_loop(nominal, Settings(), STEP, 0.6)
    plant, controller, duty = Plant(nominal), Controller(Settings()), 0.0
    for tick, time in enumerate(run.time):
        hall_voltage = plant.measure()
        assert run.hall_voltage[tick] == pytest.approx(hall_voltage, abs=1e-12)
        assert run.duty[tick] == pytest.approx(duty, abs=1e-12)
        assert run.angle[tick] == pytest.approx(plant.angle, abs=1e-12)
        plant.advance(duty, 0.002)
        duty = controller.step(STEP.at(time), hall_voltage, 0.002)


def test_a_setpoint_shows_in_the_duty_one_sample_later(nominal):
    run = simulate_loop(nominal, Settings(), STEP, 0.2)
    changed = int(np.argmax(run.setpoint > 0.0))
    assert run.duty[changed] == pytest.approx(0.0, abs=1e-12)
    assert run.duty[changed + 1] > 0.5
    assert run.angle[changed + 1] == 0.0
    assert run.angle[changed + 2] > 0.0


def test_runs_one_after_the_other_are_independent(nominal):
    setpoint = np.array([np.full(200, 0.8), np.full(200, 0.3)])
    runs = simulate_runs(nominal, Settings(), setpoint)
    for number, wanted in enumerate((0.8, 0.3)):
        alone = simulate_loop(nominal, Settings(), Schedule(np.array([0.0]), np.array([wanted])), 199 / 500)
        np.testing.assert_array_equal(runs.angle[number], alone.angle)
        np.testing.assert_array_equal(runs.duty[number], alone.duty)


def test_reaches_the_setpoint(nominal):
    run = simulate_loop(nominal, Settings(), STEP, 1.0, noise=0.003)
    assert math.degrees(abs(run.angle[-1] - 0.8)) < 0.3


def test_the_seed_repeats_the_noise(nominal):
    runs = [simulate_loop(nominal, Settings(), STEP, 0.2, noise=0.003, seed=seed) for seed in (1, 1, 2)]
    np.testing.assert_array_equal(runs[0].hall_voltage, runs[1].hall_voltage)
    assert not np.array_equal(runs[0].hall_voltage, runs[2].hall_voltage)


def test_noise_comes_before_the_converter(nominal):
    coarse = nominal.with_values({"sensor_quantization.step": 0.05})
    steps = simulate_loop(coarse, Settings(), STEP, 0.5, noise=0.02).hall_voltage / 0.05
    np.testing.assert_allclose(steps, np.round(steps), atol=1e-9)


def test_a_pid_sums_what_the_fuzzy_stage_would_weigh(nominal):
    settings = Settings(integral_gain=0.0, pi_output_support=0.5, derivative_support=1e9, transfer_time=1e-6)
    run = simulate_loop(nominal, settings, STEP, 0.3, control=linear)
    error = 4.1 * run.setpoint / (math.pi / 2) + 0.42 - run.hall_voltage
    np.testing.assert_allclose(run.duty[2:], np.clip(error[1:-1] / 0.5, -1.0, 1.0), atol=1e-5)


def test_needs_a_hall_sensor():
    with pytest.raises(InputError, match="xl330 measures position; the controller needs hall_voltage"):
        simulate_loop(Model.nominal(read_actuator("xl330")), Settings(), STEP, 0.1)
