"""Ticks of the plant, against the simulator run from the same duties."""

import numpy as np
import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.errors import InputError
from pierburg_ros.nodes.core.physics import Physics, chosen_model
from pierburg_ros.nodes.core.protection.limits import limits_of
from pierburg_ros.nodes.core.protection.winding import Winding
from pierburg_ros.nodes.core.sampled_plant import SampledPlant
from pierburg_ros.nodes.core.shaft_sensor import ShaftSensor
from pierburg_ros.plant import Inputs, Model, simulate

PERIOD = 2_000_000  # ns


def plant(formulation="exact", noise=0.0, seed=0):
    model = chosen_model("pierburg", "")
    return SampledPlant(Physics(model, formulation, noise, seed), ShaftSensor(model.actuator, 0.01))


@pytest.mark.parametrize("formulation", ["exact", "textbook"])
def test_a_duty_acts_from_its_tick_until_the_next(formulation):
    sampled = plant(formulation)
    samples = []
    for tick in range(200):
        sampled.duty.offer(0.3 if tick < 150 else 0.1)
        samples.append(sampled.tick(tick * PERIOD, 0.05))
    time = np.array([s.time for s in samples]) * 1e-9
    duty = np.array([s.duty for s in samples])
    expected = simulate(Model.nominal(read_actuator("pierburg")), Inputs(time, duty), time)
    np.testing.assert_allclose([s.hall_voltage for s in samples], expected, atol=1e-3)
    assert expected.max() > 1.0


def test_noise_is_that_of_its_seed():
    first, second, other = (
        [sampled.tick(k * PERIOD, 0.05).hall_voltage for k in range(500)]
        for sampled in (plant(noise=0.003, seed=4), plant(noise=0.003, seed=4), plant(noise=0.003, seed=5))
    )
    assert first == second
    assert first != other
    assert np.std(first) == pytest.approx(0.003, rel=0.15)


def test_reset_closes_the_valve_and_time_goes_on():
    sampled = plant()
    for tick in range(100):
        sampled.duty.offer(0.5)
        sample = sampled.tick(tick * PERIOD, 0.05)
    assert sample.angle > 0.1
    sampled.reset()
    assert sampled.tick(100 * PERIOD, 0.05).angle < 0.05


def test_a_parameter_changes_while_the_shaft_stays():
    sampled = plant()
    for tick in range(100):
        sampled.duty.offer(0.5)
        before = sampled.tick(tick * PERIOD, 0.05)
    sampled.physics.change({"armature_resistance": 8.0})
    after = sampled.tick(99 * PERIOD, 0.05)
    assert after.hall_voltage == before.hall_voltage


def test_a_coupled_change_is_all_or_nothing():
    physics = plant().physics
    with pytest.raises(InputError, match="breakaway_torque"):
        physics.change({"static_friction.breakaway_torque": 0.25, "coulomb_friction": 0.3})
    physics.change({"static_friction.breakaway_torque": 0.35, "coulomb_friction": 0.3})
    assert physics.has("coulomb_friction")


def test_an_actuator_without_hall_sensor_is_refused():
    with pytest.raises(InputError, match="measures its position"):
        chosen_model("xl330", "")


def test_a_stall_against_the_open_stop_is_limited_as_a_device_would_do_it():
    limits = limits_of(read_actuator("pierburg"))
    sampled = plant()
    sampled.winding = Winding(limits, limits.rated_current, 20.0)
    applied = []
    for tick in range(8000):
        sampled.duty.offer(1.0)
        applied.append(sampled.tick(tick * PERIOD, 0.05).duty)
    limited = next(tick for tick, duty in enumerate(applied) if tick and duty < 1.0) * 0.002
    assert limited == pytest.approx(20.0 * np.log(9.0 / 8.0), abs=0.2)
    assert applied[3000] == pytest.approx(1.0 / 3.0, abs=0.01)
    assert applied[-1] == 0.0


def test_what_a_healthy_controller_asks_of_the_plant_is_never_limited():
    limits = limits_of(read_actuator("pierburg"))
    plain, protected = plant(noise=0.003), plant(noise=0.003)
    protected.winding = Winding(limits, limits.rated_current, 20.0)
    duties = np.repeat([0.26, 0.1, 0.9, 0.2, -0.5, 0.24], [1000, 500, 100, 1000, 100, 800])
    for tick, duty in enumerate(duties):
        plain.duty.offer(duty)
        protected.duty.offer(duty)
        assert plain.tick(tick * PERIOD, 0.05) == protected.tick(tick * PERIOD, 0.05)
