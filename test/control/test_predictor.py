"""The Smith predictor of the controller: absent bit for bit, and ahead of the sensor by what is under way."""

import math

import numpy as np
import pytest

from pierburg_ros.control import Controller, Settings
from pierburg_ros.control.law import new_state
from pierburg_ros.control.predictor import LONGEST_DELAY, predicted

DT = 0.002
SPEED = 40.0
MODEL = {"predictor_speed": SPEED, "load_closed": 0.1, "load_open": 0.2, "predictor_friction": 0.07}


def friction_free(**values):
    return Settings().with_values({"predictor_speed": SPEED, **values}).record()


def duties(count: int = 400) -> np.ndarray:
    """A smooth duty that moves the modelled shaft within the stops."""
    return 0.02 * np.sin(2.0 * math.pi * 2.0 * DT * np.arange(count)) + 0.005


def shaft(duty: np.ndarray) -> np.ndarray:
    """Voltage [V] of the shaft of the model without load and friction, after each duty has acted for a period."""
    return 1.0 + np.cumsum(SPEED * duty * DT)


def through(lag: float, true: np.ndarray) -> np.ndarray:
    """A first-order lag of a shaft that moves evenly between samples, integrated finely."""
    found: list[float] = []
    shown = before = 1.0
    for value in true:
        for part in range(200):
            shown += (before + (value - before) * (part + 0.5) / 200 - shown) * (1.0 - math.exp(-DT / 200 / lag))
        before = value
        found.append(shown)
    return np.array(found)


def test_absent_without_delay_and_lag():
    """Whatever the other numbers of the model are."""
    plain, idle = Controller(Settings()), Controller(Settings().with_values(MODEL))
    measured = 1.0 + np.cumsum(np.random.default_rng(1).normal(0.0, 0.02, 500))
    assert [plain.step(0.8, v, DT) for v in measured] == [idle.step(0.8, v, DT) for v in measured]


@pytest.mark.parametrize("delay", [1, 5, 10, LONGEST_DELAY])
def test_it_shows_now_what_a_delayed_sensor_shows_later(delay):
    settings, state, duty = friction_free(predictor_delay=delay * DT), new_state(), duties()
    true = shaft(duty)
    sensed = np.concatenate([np.full(delay, 1.0), true[:-delay]])
    found = [predicted(settings, state, v, d, DT) for v, d in zip(sensed, duty, strict=True)]
    np.testing.assert_allclose(found[1:], true[1:], atol=1e-9)


@pytest.mark.parametrize("lag", [0.004, 0.02])
def test_it_shows_the_shaft_behind_a_lagging_sensor(lag):
    settings, state, duty = friction_free(predictor_lag=lag), new_state(), duties()
    true = shaft(duty)
    sensed = through(lag, true)
    found = np.array([predicted(settings, state, v, d, DT) for v, d in zip(sensed, duty, strict=True)])
    assert np.abs(found - true).max() < 0.02 * np.abs(sensed - true).max()


def test_friction_and_load_hold_the_modelled_shaft():
    settings, state = Settings().with_values({**MODEL, "predictor_delay": 0.02}).record(), new_state()
    held = 0.1 + 0.5 * 0.1
    middle = 0.5 * (settings.hall_voltage_closed + settings.hall_voltage_open)
    for duty in (held - 0.069, held + 0.069):
        assert [predicted(settings, state, middle, duty, DT) for _ in range(50)] == [middle] * 50
    assert predicted(settings, state, middle, held + 0.08, DT) == pytest.approx(middle + SPEED * 0.01 * DT)


def test_a_model_that_slides_where_the_shaft_rests_leaves_no_offset():
    settings, state = friction_free(predictor_delay=0.02, predictor_lag=0.005), new_state()
    found = [predicted(settings, state, 2.0, 0.1, DT) for _ in range(1000)]
    assert max(found) > 2.02
    assert found[-1] == pytest.approx(2.0, abs=1e-3)


def test_the_shaft_is_never_predicted_beyond_the_stops():
    settings, state = friction_free(predictor_delay=0.05), new_state()
    assert max(predicted(settings, state, 4.4, 1.0, DT) for _ in range(30)) <= 4.52
    assert predicted(settings, state, 4.6, 1.0, DT) <= 4.6
