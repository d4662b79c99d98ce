"""The plant step by step is the plant of whole runs, with noise, time and parameters that change while it runs."""

from __future__ import annotations

import numpy as np
from independent.excitation import rich_duty
from support.recordings import changing

from pierburg_ros.actuators import read_actuator
from pierburg_ros.plant import Inputs, Model, Plant, simulate

NOMINAL = Model.nominal(read_actuator("pierburg"))
LATE = NOMINAL.with_values({"input_delay.delay": 0.013, "sensor_lag.time_constant": 0.01})


def stepped(plant: Plant, time: np.ndarray, duty: np.ndarray) -> np.ndarray:
    voltage = []
    for k in range(time.size):
        voltage.append(plant.measure())
        plant.advance(float(duty[k]), 0.002)
    return np.array(voltage)


def test_stepping_gives_what_simulate_gives() -> None:
    time, duty = rich_duty(4.0)
    assert np.abs(stepped(Plant(LATE), time, duty) - simulate(LATE, Inputs(time, duty), time)).max() < 1e-9


def test_reset_starts_again_with_the_same_noise() -> None:
    time, duty = rich_duty(1.0)
    plant = Plant(NOMINAL, noise=0.003, seed=7)
    first = stepped(plant, time, duty)
    plant.reset()
    assert (plant.time, plant.angle, plant.velocity) == (0.0, 0.0, 0.0)
    assert np.array_equal(first, stepped(plant, time, duty))


def test_noise_has_its_standard_deviation_and_seed() -> None:
    values = np.array([Plant(NOMINAL, noise=0.003, seed=seed).measure() for seed in range(2000)])
    assert abs(values.std() - 0.003) < 0.0003
    assert np.unique(values).size == values.size


def test_model_changes_while_the_state_stays() -> None:
    """A weaker spring put in while the valve stands: it moves from where it is, at once."""
    plant = Plant(NOMINAL)
    for _ in range(500):
        plant.advance(0.22, 0.002)
    angle, time = plant.angle, plant.time
    plant.model = NOMINAL.with_values({"spring_preload": 0.2})
    assert (plant.angle, plant.time) == (angle, time)
    plant.advance(0.22, 0.002)
    assert plant.angle > angle + 1e-4


def test_model_changes_within_a_run_at_its_time() -> None:
    """Between two samples of a movement: it acts from the second one, as a plant whose model is replaced."""
    time, duty = rich_duty(4.0)
    after = NOMINAL.with_values({"armature_resistance": 5.0})
    moving = int(np.argmax(np.abs(np.diff(simulate(NOMINAL, Inputs(time, duty), time)))))
    when = 0.5 * float(time[moving - 1] + time[moving])
    switched = changing(NOMINAL, after, when, Inputs(time, duty), time)
    plant = Plant(NOMINAL)
    expected = []
    for k in range(time.size):
        expected.append(plant.measure())
        if k == moving:
            plant.model = after
        plant.advance(float(duty[k]), float(time[min(k + 1, time.size - 1)] - time[k]))
    assert np.abs(switched - expected).max() < 1e-9


def test_supply_and_bridge_act_from_the_step_they_are_given() -> None:
    plant = Plant(NOMINAL)
    plant.advance(0.3, 0.1, supply_voltage=6.0)
    assert plant.angle == 0.0
    plant.advance(0.3, 0.1)
    opened = plant.angle
    assert opened > 0.01
    plant.advance(0.3, 0.1, enabled=False)
    assert plant.angle < opened
