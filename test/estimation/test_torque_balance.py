"""The balance of torques of a turning rotor: what repeats itself, what does not, and a current behind a filter."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.signal import lfilter

from pierburg_ros.actuators import read_actuator
from pierburg_ros.estimation.torque_balance import TURN, ahead, goes_round, over_a_turn, recorded_lag
from pierburg_ros.plant import Inputs, Model, simulate

ROTOR = Model.nominal(read_actuator("odrive")).with_values({"viscous_friction.coefficient": 0.01})
COGGING = {
    "cogging_torque.amplitude": 0.006,
    "cogging_torque.periods_per_motor_revolution": 7.0,
    "cogging_torque.phase": 0.8,
}
TIME = np.arange(0.0, 8.0, 0.002)
ANGLE = np.linspace(0.0, TURN, 400)


def current(seed: int) -> np.ndarray:
    """A current that wanders about 1.3 A [A], enough to keep the rotor turning."""
    random = np.random.default_rng(seed)
    times = np.linspace(0.0, TIME[-1], 60)
    return 1.3 + 0.2 * np.interp(TIME, times, random.standard_normal(times.size))


def turned(model: Model, driven: np.ndarray, seed: int) -> np.ndarray:
    noise = 1e-4 * np.random.default_rng(seed + 100).standard_normal(TIME.size)
    return simulate(model, Inputs(TIME, driven), TIME, 0.3, 2.0) + noise


def all_of(time: np.ndarray) -> np.ndarray:
    return np.ones(time.size, dtype=bool)


def test_a_ripple_with_an_overtone_is_found_with_amplitude_and_phase() -> None:
    angle = np.linspace(0.0, TURN, 512)
    overtone = {"angle": angle, "velocity": np.zeros(1), "period": TURN}
    model = ROTOR.with_values(COGGING).with_residual({**overtone, "torque": 0.003 * np.cos(28.0 * angle)[:, None]})
    inputs = Inputs(TIME, current(0))
    found = over_a_turn(ROTOR, [(inputs, TIME, turned(model, inputs.command, 0), all_of(TIME))])
    assert set(found.orders.tolist()[:2]) == {7, 28}
    true = 0.006 * np.sin(7.0 * ANGLE + 0.8) + 0.003 * np.cos(28.0 * ANGLE)
    assert np.corrcoef(found.torque(ANGLE), true)[0, 1] > 0.98
    assert np.std(found.torque(ANGLE)) == pytest.approx(np.std(true), rel=0.15)
    assert 7 not in found.lesser.orders and 28 in found.lesser.orders


def test_what_does_not_repeat_itself_is_given_no_order() -> None:
    found = [over_a_turn(ROTOR, [(Inputs(TIME, current(seed)), TIME, turned(ROTOR, current(seed), seed), all_of(TIME))])
             for seed in range(10)]  # fmt: skip
    # one in a hundred would be given one by chance
    assert sum(each.orders.size > 0 for each in found) <= 1


@pytest.mark.parametrize("lag", [0.0, 0.06])
def test_a_filter_of_the_recorded_current_is_found_and_taken_out(lag: float) -> None:
    driven = current(3)
    keep = math.exp(-0.002 / lag) if lag else 0.0
    shown = lfilter([1.0 - keep], [1.0, -keep], driven - driven[0]) + driven[0]
    measured = turned(ROTOR.with_values(COGGING), driven, 3)
    found = recorded_lag(ROTOR, Inputs(TIME, shown), TIME, measured)
    # noise in the acceleration leaves some of the inertia to it
    assert found == pytest.approx(lag, rel=0.25)
    if lag:
        mended = ahead(Inputs(TIME, shown), found).command
        assert np.std(mended - driven) < 0.3 * np.std(shown - driven)


def test_only_a_shaft_seen_in_a_turn_goes_round() -> None:
    turn = np.linspace(0.0, TURN, 100)
    assert goes_round(ROTOR, turn, "position") and not goes_round(ROTOR, 0.5 * turn, "position")
    assert not goes_round(Model.nominal(read_actuator("pierburg")), turn, "position")
    assert not goes_round(Model.nominal(read_actuator("xl330")), turn, "position")
