"""Recipes: within limits, repeatable, and moving the shaft as they say."""

from dataclasses import replace

import numpy as np
import pytest
from support.closed_form import FRICTION_ANGLE, GAIN, PRELOAD_ANGLE

from pierburg_ros.actuators import read_actuator
from pierburg_ros.errors import InputError
from pierburg_ros.identification.experiment.excitation import (
    DUTY_RECIPES,
    SETPOINT_RECIPES,
    DutyRange,
    duty_sequence,
    purpose,
    setpoint_sequence,
)
from pierburg_ros.identification.experiment.synthetic import synthetic_recording
from pierburg_ros.plant import Model

TIME = np.arange(30_000) / 500.0


def test_duty_range_is_where_the_static_characteristic_bends(nominal):
    span = DutyRange.of(nominal)
    assert span.low == pytest.approx((PRELOAD_ANGLE + FRICTION_ANGLE) / GAIN)
    assert span.high - span.low == pytest.approx(np.pi / 2 / GAIN)


@pytest.mark.parametrize("name", DUTY_RECIPES)
@pytest.mark.parametrize("actuator", ["pierburg", "xl330"])
def test_duty_stays_within_limits_and_repeats(name, actuator):
    model = Model.nominal(read_actuator(actuator))
    duty = duty_sequence(name, model, TIME, seed=4)
    assert duty.shape == TIME.shape
    assert np.all(np.abs(duty) <= 1.0)
    assert np.array_equal(duty, duty_sequence(name, model, TIME, seed=4))


@pytest.mark.parametrize("name", DUTY_RECIPES)
def test_every_duty_recipe_moves_the_valve(name, nominal):
    recording = synthetic_recording(nominal, TIME, duty_sequence(name, nominal, TIME), noise=0.0)
    assert np.ptp(recording.measured) > 1.0


@pytest.mark.parametrize("name", ["random_steps", "sharp_steps", "rich"])
def test_a_shaft_that_nothing_brings_back_is_turned_both_ways_and_rests(name, nominal):
    free = Model.nominal(replace(nominal.actuator, load="none"))
    duty, span = duty_sequence(name, free, TIME), DutyRange.of(free)
    least = (
        nominal.values["coulomb_friction"]
        * nominal.values["armature_resistance"]
        / 0.022
        / nominal.values["gear_ratio"]
    )
    assert span.low == pytest.approx(least / nominal.values["supply_voltage"])
    shares = [np.mean(duty > span.low), np.mean(duty < -span.low), np.mean(np.abs(duty) < span.low)]
    assert min(shares) > 0.1


@pytest.mark.parametrize("name", SETPOINT_RECIPES)
def test_setpoints_stay_between_the_stops(name):
    setpoints = setpoint_sequence(name, TIME, seed=2)
    assert setpoints.min() >= 0.0
    assert setpoints.max() <= np.pi / 2
    assert setpoints[0] == 0.0


def test_the_staircase_visits_every_angle_both_ways(nominal):
    duty = duty_sequence("staircase", nominal, TIME)
    top = int(np.argmax(duty))
    assert np.all(np.diff(duty[:top]) >= 0.0)
    assert np.all(np.diff(duty[top:]) <= 0.0)
    assert duty[0] == duty[-1] == 0.0


def test_an_unknown_recipe_is_refused():
    with pytest.raises(InputError, match="There is no recipe stairs"):
        purpose("stairs")
