"""The time-optimal bound against the simulator at full duty, and against every controlled response."""

import math

import numpy as np
import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.closed_loop import simulate_loop
from pierburg_ros.closed_loop.time_optimal import full_duty_travel_time, settling_bound
from pierburg_ros.control import Schedule, Settings
from pierburg_ros.plant import Model, Plant

WAYS = [(5.0, 85.0), (85.0, 5.0), (42.5, 47.5), (47.5, 42.5), (0.0, 90.0)]


def model(resistance_factor=1.0):
    return Model.nominal(read_actuator("pierburg")).with_values({"armature_resistance": 4.139 * resistance_factor})


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("factor", [1.0, 1.42])
def test_full_duty_travels_as_the_simulator_does(way, factor):
    start, end = map(math.radians, way)
    plant = Plant(model(factor))
    plant.reset(start)
    plant.advance(math.copysign(1.0, end - start), full_duty_travel_time(model(factor), start, end))
    # the closed form leaves out the inertia: up to 19 rad/s come 21 us late
    assert plant.angle == pytest.approx(end, abs=19.0 * 25e-6)


def test_the_nominal_valve_in_numbers():
    """13.4 rad/s at the closed stop fall to 12.1 rad/s at the open one as the spring tightens."""
    time = full_duty_travel_time(model(), math.radians(5.0), math.radians(85.0))
    assert math.radians(80.0) / time == pytest.approx(12.7, abs=0.1)


def test_a_target_out_of_reach_takes_for_ever():
    weak = model().with_values({"supply_voltage": 2.0})
    assert full_duty_travel_time(weak, 0.0, 1.0) == math.inf


def test_the_bound_adds_two_periods_to_the_edge_of_the_band():
    edge = full_duty_travel_time(model(), 0.5, 0.98)
    assert settling_bound(model(), 0.5, 1.0, 0.02, rate=250.0) == pytest.approx(edge + 0.008)


def test_no_response_enters_the_band_sooner():
    start, target, band = 0.5, 1.0, 0.01
    schedule = Schedule(np.array([0.0, 1.0]), np.array([start, target]))
    greedy = Settings(pi_output_support=0.01, derivative_support=1e6)
    run = simulate_loop(model(), greedy, schedule, 1.5)
    entered = run.time[np.argmax(run.angle > target - band)] - 1.0
    assert entered >= settling_bound(model(), start, target, band) - 1.0 / 500.0
