"""A torque that repeats itself with every turn: its orders beside an effect, as a map, and in words."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.estimation.data import Data, data_of, in_parts, rms
from pierburg_ros.estimation.turn import described_turn, left_of_torque, with_lesser_orders, with_turn
from pierburg_ros.plant import Inputs, Model, simulate
from pierburg_ros.recording import Channel, Recording

ROTOR = Model.nominal(read_actuator("odrive")).with_values({"viscous_friction.coefficient": 0.01})
RIPPLE = {
    "cogging_torque.amplitude": 0.006,
    "cogging_torque.periods_per_motor_revolution": 7.0,
    "cogging_torque.phase": 0.8,
}
TIME = np.arange(0.0, 8.0, 0.002)
ANGLE = np.linspace(0.0, 2.0 * np.pi, 512)


def overtones(amplitude: float) -> dict[str, Any]:
    torque = amplitude * np.cos(28.0 * ANGLE)[:, None]
    return {"angle": ANGLE, "velocity": np.zeros(1), "torque": torque, "period": 2.0 * np.pi}


def data_on(*models: Model, seed: int = 4) -> Data:
    """A rotor that goes round several times under a current that wanders, one recording of each model."""
    return in_parts(data_of([recorded(model, seed) for model in models], ROTOR))


def recorded(model: Model, seed: int) -> Recording:
    random = np.random.default_rng(seed)
    current = 1.3 + 0.2 * np.interp(TIME, np.linspace(0.0, 8.0, 60), random.standard_normal(60))
    angle = simulate(model, Inputs(TIME, current), TIME, 0.3, 2.0) + 1e-4 * random.standard_normal(TIME.size)
    return Recording("turns", "position", TIME, angle, Channel(TIME, current), input="current")


def left_unseen_of(data: Data) -> tuple[float, float] | None:
    """What is left of the torque on the samples that tell it; None where they tell no overtones."""
    return left_of_torque(data, data, ROTOR)


@pytest.fixture(scope="module")
def rippled() -> Data:
    return data_on(ROTOR.with_values(RIPPLE).with_residual(overtones(0.003)))


def test_the_strongest_order_is_left_to_an_effect_and_the_others_are_a_map(rippled: Data) -> None:
    assert left_unseen_of(rippled) is not None
    lesser = with_lesser_orders(rippled, ROTOR).residual_torque
    assert lesser is not None and lesser["period"] == pytest.approx(2.0 * np.pi)
    torque = lesser["torque"][:, 0]
    assert np.corrcoef(torque, np.cos(28.0 * lesser["angle"]))[0, 1] > 0.95
    words = described_turn(overtones(0.003)["torque"], "N.m")
    assert words == "it repeats itself with every turn, with 0.0030 N.m 28 times"


def test_the_torque_over_a_turn_makes_up_that_of_another_recording(rippled: Data) -> None:
    """That of another rotor it makes larger."""
    same, other = ROTOR.with_values(RIPPLE).with_residual(overtones(0.003)), ROTOR
    left = [left_of_torque(rippled, data_on(model, seed=9), ROTOR) for model in (same, other)]
    (without, beside), (plain, worse) = (each or (0.0, 0.0) for each in left)
    assert beside < 0.3 * without and worse > 1.5 * plain


def test_the_map_is_what_the_effects_of_a_model_leave(rippled: Data) -> None:
    """On samples that fitted nothing it comes near the true model, with an effect in the model and without."""
    true = ROTOR.with_values(RIPPLE).with_residual(overtones(0.003))
    left = {}
    for name, base in {"nominal": ROTOR, "named": ROTOR.with_values(RIPPLE)}.items():
        found = with_turn(rippled, base)
        assert found is not None
        left[name] = rms(rippled.residual(found)[rippled.test])
    before, best = (rms(rippled.residual(model)[rippled.test]) for model in (ROTOR, true))
    assert best < 1.3 and max(left.values()) < best + 0.3 * (before - best)


def test_a_sine_alone_has_no_overtones_and_a_plain_rotor_no_map() -> None:
    assert left_unseen_of(data_on(ROTOR.with_values(RIPPLE))) is None
    plain = data_on(ROTOR)
    assert with_turn(plain, ROTOR) is None
    assert with_lesser_orders(plain, ROTOR) is ROTOR


def test_what_one_of_several_recordings_shows_repeats_itself_in_none() -> None:
    true = ROTOR.with_values(RIPPLE).with_residual(overtones(0.003))
    assert left_unseen_of(data_on(true, true)) is not None
    assert left_unseen_of(data_on(true, ROTOR)) is None
