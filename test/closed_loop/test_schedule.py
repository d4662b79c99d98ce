"""The schedule of the load over the setpoint: what it gives, and what a step away from the stop gains by it."""

import math

import numpy as np
import pytest

from pierburg_ros.closed_loop import simulate_runs
from pierburg_ros.closed_loop.corrected import starts, task_for
from pierburg_ros.closed_loop.goal import Goal
from pierburg_ros.closed_loop.load import duty_for, load
from pierburg_ros.closed_loop.plants import HOT, variations
from pierburg_ros.control import Controller, Settings
from pierburg_ros.control.fuzzy import pi_output_for
from pierburg_ros.plant import Inputs, Model, simulate

PERIOD = 0.002
SCHEDULE = {"load_closed": 0.1, "load_open": 0.2, "load_share": 1.0}


@pytest.fixture(scope="module")
def nominal():
    from pierburg_ros.actuators import read_actuator

    return Model.nominal(read_actuator("pierburg"))


def hall(angle: float) -> float:
    """Hall voltage [V] of the nominal sensor."""
    return 0.42 + 4.1 * angle / (math.pi / 2)


@pytest.mark.parametrize(
    ("angle", "share", "duty"), [(0.0, 1.0, 0.1), (math.pi / 4, 1.0, 0.15), (math.pi / 2, 0.5, 0.1)]
)
def test_without_an_error_the_duty_is_that_of_the_load(angle, share, duty):
    controller = Controller(Settings().with_values({**SCHEDULE, "load_share": share}))
    for _ in range(100):
        given = controller.step(angle, hall(angle), PERIOD)
    assert given == pytest.approx(duty, abs=1e-6)


def test_absent_without_a_share():
    plain, idle = Controller(Settings()), Controller(Settings().with_values({**SCHEDULE, "load_share": 0.0}))
    measured = 1.0 + np.cumsum(np.random.default_rng(1).normal(0.0, 0.02, 500))
    assert [plain.step(0.8, v, PERIOD) for v in measured] == [idle.step(0.8, v, PERIOD) for v in measured]


def test_switching_it_on_does_not_move_the_duty():
    controller = Controller(Settings())
    for _ in range(200):
        before = controller.step(0.7, hall(0.7) - 0.02, PERIOD)
    controller.change(Settings().with_values(SCHEDULE))
    assert controller.step(0.7, hall(0.7) - 0.02, PERIOD) == pytest.approx(before, abs=0.005)


def test_the_load_of_a_model_balances_its_spring(nominal):
    """A frictionless plant rests at either stop under just this duty: a little more or less moves it."""
    smooth = nominal.with_values({"coulomb_friction": 0.0})
    time = np.linspace(0.0, 3.0, 50)
    for share, angle in ((0.25, math.pi / 8), (0.75, 3 * math.pi / 8)):
        known = load(smooth)
        duty = known["load_closed"] + share * (known["load_open"] - known["load_closed"])
        sensed = simulate(smooth, Inputs(np.array([0.0]), np.array([duty])), time, angle)
        assert sensed[-1] == pytest.approx(hall(angle), abs=0.01)


def test_tuning_begins_with_some_of_the_load_scheduled(nominal):
    shares = {
        schedule: [each.load_share for each in starts(task_for(nominal, Goal(), False, schedule), Settings())]
        for schedule in (True, False)
    }
    assert shares == {True: [0.0, 0.5, 1.0], False: [0.0]}


def test_a_hot_start_is_late_since_the_integrator_is_empty(nominal):
    """5 degrees from the stop: late at once after a start, in time after a movement has filled the integrator.

    With the empty one the shaft stops short, by no more than the error at which the fuzzy stage moves it on.
    """
    hot, target = variations(nominal)[HOT], math.radians(5.0)
    fresh = np.repeat([[0.0, 0.0, target]], [300, 600, 500], axis=1)
    moved = np.repeat([[math.radians(10.0), 0.0, target]], [300, 600, 500], axis=1)
    short, right = (target - simulate_runs(hot, Settings(), each).angle[0, 900:] for each in (fresh, moved))
    band = math.radians(0.3)
    assert np.sum(np.abs(short) > band) > 4 * np.sum(np.abs(right) > band)
    values = hot.values
    torque = values["spring_preload"] + values["spring_stiffness"] * target + values["coulomb_friction"]
    moving = pi_output_for(Settings().record(), duty_for(hot, torque), 0.0) * math.pi / 2 / 4.1
    assert short[8] == pytest.approx(short[15], rel=1e-3)
    assert band < short[8] < moving


def test_a_hot_plant_leaves_the_stop_without_waiting_for_the_integrator(nominal):
    hot = variations(nominal)[HOT]
    setpoint = np.repeat([[0.0, math.radians(20.0)]], [200, 500], axis=1)
    scheduled = Settings().with_values(load(nominal) | {"load_share": 1.0})

    def late(settings: Settings) -> float:
        """Time [s] spent more than half a degree from the target after the step."""
        angle = simulate_runs(hot, settings, setpoint).angle[0, 200:]
        return float(np.sum(np.abs(angle - math.radians(20.0)) > math.radians(0.5))) * PERIOD

    assert late(scheduled) < 0.5 * late(Settings())
