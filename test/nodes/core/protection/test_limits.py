"""Limits derived from an actuator against its simulator."""

from dataclasses import replace

import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.actuators.actuator import Winding
from pierburg_ros.nodes.core.protection.limits import limits_of, load_torques
from pierburg_ros.plant import Model, Plant

ACTUATOR = read_actuator("pierburg")
MODEL = Model.nominal(ACTUATOR)
LIMITS = limits_of(ACTUATOR)


@pytest.mark.parametrize("angle", [0.1, 0.8, 1.5])
@pytest.mark.parametrize("duty", [LIMITS.opens_above, LIMITS.closes_below])
@pytest.mark.parametrize("breakaway", [0.0, 0.4])
def test_duties_beyond_those_that_hold_move_the_shaft_within_the_patience(angle, duty, breakaway):
    model = MODEL.with_values({"static_friction.breakaway_torque": breakaway, "static_friction.stribeck_velocity": 0.1})
    plant = Plant(model if breakaway else MODEL)
    plant.reset(angle)
    plant.advance(duty, 0.04)
    assert abs(plant.angle - angle) > 0.05


def test_no_duty_moves_the_shaft_faster_than_its_top_speed():
    plant = Plant(MODEL.with_values({"coulomb_friction": 0.0, "supply_voltage": 14.5}))
    plant.reset(1.5)
    plant.advance(-1.0, 0.02)
    assert 0.5 * LIMITS.top_speed < abs(plant.velocity) < LIMITS.top_speed


def test_what_holds_the_valve_open_is_less_than_the_rated_current():
    strongest = 0.29 + 0.1419 * ACTUATOR.upper_stop + 0.2007
    assert strongest / LIMITS.torque_constant < LIMITS.rated_current < LIMITS.stall_current


def test_without_a_supply_no_duty_is_said_to_move_the_shaft():
    limits = limits_of(ACTUATOR, {"supply_voltage": 0.0})
    assert limits.closes_below < -1.0
    assert limits.opens_above > 1.0


def test_a_described_winding_says_what_it_bears_for_ever():
    described = replace(read_actuator("pierburg"), winding=Winding(0.8, 20.0, "data sheet"))
    assert limits_of(described).rated_current == 0.8
    assert limits_of(read_actuator("pierburg")).rated_current == pytest.approx(13.5 / 4.139 / 3.0, rel=0.05)


def test_a_free_rotor_has_no_load():
    assert load_torques(read_actuator("odrive"), {}) == (0.0, 0.0)
