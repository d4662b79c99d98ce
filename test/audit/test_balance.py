"""The torques along a motion are made up by hand: inertia, friction and poles, as a rotor in a slow position loop."""

import numpy as np
import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.audit import audit
from pierburg_ros.audit.balance import made_up
from pierburg_ros.audit.signals import Signals
from pierburg_ros.plant import Model
from pierburg_ros.recording import Channel, Recording

ROTOR = Model.nominal(read_actuator("odrive"))
TIME = np.arange(15_000) / 500.0
STEP = 2.0 * np.pi / 8192
NOISE = STEP * (np.random.default_rng(0).random(TIME.size) - 0.5)


def turned(frequency, phase=0.0):
    """Angle [rad] and the current [A] that moves the rotor so, two turns to and fro, over poles of 0.025 N.m."""
    swing, pulse = 2.0 * np.pi, 2.0 * np.pi * frequency
    angle = swing * np.sin(pulse * TIME + phase)
    velocity = swing * pulse * np.cos(pulse * TIME + phase)
    poles = 0.025 * np.sin(7.0 * angle) + 0.008 * np.sin(12.0 * angle + 1.0)
    friction = ROTOR.values["coulomb_friction"] * np.sign(velocity)
    torque = -ROTOR.values["total_inertia"] * pulse**2 * angle + friction + poles
    return angle + NOISE, torque / ROTOR.values["torque_constant"]


def recorded(angle, current, step=STEP):
    return Recording("rotor", "position", TIME, np.round(angle / step) * step, Channel(TIME, current), input="current")


@pytest.mark.parametrize("coarser", [1, 30])
def test_the_input_of_a_motion_makes_up_its_torques_and_that_of_another_does_not(coarser):
    angle, current = turned(0.05)
    other = turned(0.083, 0.7)[1]
    told = [made_up(Signals.of(recorded(angle, each, coarser * STEP)), ROTOR) for each in (current, other, -current)]
    assert told == [True, False, False]


def test_a_slow_rotor_with_a_coarse_encoder_is_not_blamed():
    angle, current = turned(0.05)
    assert audit([recorded(angle, current, 30 * STEP)], ROTOR) == []


def test_within_a_part_of_a_turn_nothing_is_said():
    angle, current = turned(0.05)
    assert not made_up(Signals.of(recorded(0.1 * angle, current)), ROTOR)


def test_a_model_whose_inertia_is_off_does_not_make_a_right_input_wrong():
    """A slow motion hardly tells an inertia: what a diagnosis has found in other recordings may be far off."""
    angle, current = turned(0.3)
    heavy = ROTOR.with_values({"total_inertia": 100.0 * ROTOR.values["total_inertia"]})
    assert [made_up(Signals.of(recorded(angle, each)), heavy) for each in (current, -current)] == [True, False]
