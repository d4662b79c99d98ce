"""The balance names what no simulation shows: a rotor whose current is recorded late, by inverse dynamics."""

import numpy as np
import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.budget import Budget
from pierburg_ros.inference.infer import infer
from pierburg_ros.plant import Model
from pierburg_ros.recording import Channel, Recording

pytestmark = pytest.mark.search

ROTOR = Model.nominal(read_actuator("odrive"))
PERIOD, LATE = 0.01, 0.08
NO_SEARCH = Budget(1e-3)
"""The balance needs none."""
RIPPLE = {"amplitude": 0.025, "periods": 7.0, "phase": 0.6}


def turning(missing, seed: int = 3) -> Recording:
    """Turns at several speeds, both ways, with the current that they need, which is recorded behind a filter.

    `missing` is the load torque [N.m] at some angles [rad] and times [s] that the model has not.
    """
    random = np.random.default_rng(seed)
    time = np.arange(0.0, 30.0, PERIOD)
    speed = np.interp(time, np.linspace(0.0, 30.0, 11), [0.6, 0.9, -0.7, -1.1, 0.8, 1.3, -0.5, -0.9, 1.0, 0.7, -0.8])
    angle = np.cumsum(speed) * PERIOD
    value = ROTOR.values
    torque = value["total_inertia"] * np.gradient(speed, PERIOD) + value["coulomb_friction"] * np.sign(speed)
    current = (torque + missing(angle, time)) / value["torque_constant"]
    late = current.copy()
    for place in range(1, time.size):
        late[place] = late[place - 1] + (current[place] - late[place - 1]) * PERIOD / LATE
    measured = angle + 2e-4 * random.standard_normal(time.size)
    return Recording("rotor.csv", "position", time, measured, Channel(time, late), input="current")


def test_a_ripple_is_named_with_its_periods_and_amplitude():
    def ripple(angle, _):
        return RIPPLE["amplitude"] * np.sin(RIPPLE["periods"] * angle + RIPPLE["phase"])

    choice = infer([turning(ripple)], ROTOR, jobs=1, budget=NO_SEARCH).choice
    assert choice.verdict == "unexplained" and set(choice.names) == {"cogging_torque"}
    assert choice.names["cogging_torque"].along > 0.5
    found = choice.handed.values
    assert found["cogging_torque.periods_per_motor_revolution"] == pytest.approx(RIPPLE["periods"], abs=0.1)
    # behind the filter the ripple at 0.5 to 1.3 rad/s is lower by 0.96 to 0.81, and what is late by 0.3 to 0.6 rad,
    # once on one side and once on the other, keeps 0.96 to 0.81 of it
    assert 0.6 * RIPPLE["amplitude"] < found["cogging_torque.amplitude"] < RIPPLE["amplitude"]


def test_a_load_that_wanders_in_time_has_no_name():
    random = np.random.default_rng(5)
    knots = 0.02 * random.standard_normal(60)

    def wandering(_, time):
        return np.interp(time, np.linspace(0.0, 30.0, knots.size), knots)

    choice = infer([turning(wandering)], ROTOR, jobs=1, budget=NO_SEARCH).choice
    assert choice.verdict == "unexplained" and not choice.names
