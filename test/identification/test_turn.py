"""A torque that repeats itself with every turn: its orders and their size, none where there is none, and in words."""

from __future__ import annotations

import numpy as np
import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.identification.turn import described_turn, with_turn
from pierburg_ros.inference.data import Data, all_fitted
from pierburg_ros.plant import Inputs, Model, simulate
from pierburg_ros.recording import Channel, Recording

ROTOR = Model.nominal(read_actuator("odrive")).with_values({"viscous_friction.coefficient": 0.01})
TIME = np.arange(0.0, 8.0, 0.002)
ANGLE = np.linspace(0.0, 2.0 * np.pi, 512)


def rippled(*orders: tuple[int, float]) -> Model:
    """The rotor with a cosine of each order and amplitude [N.m]."""
    torque = np.sum([amplitude * np.cos(order * ANGLE) for order, amplitude in orders], axis=0)[:, None]
    return ROTOR.with_residual({"angle": ANGLE, "velocity": np.zeros(1), "torque": torque, "period": 2.0 * np.pi})


def turning(model: Model, seed: int, turns: float = 1.0) -> Recording:
    """A rotor that goes round several times under a current that wanders; a share of the `turns` of it."""
    random, time = np.random.default_rng(seed), TIME[: int(turns * TIME.size)]
    current = 1.3 + 0.2 * np.interp(TIME, np.linspace(0.0, 8.0, 60), random.standard_normal(60))
    angle = simulate(model, Inputs(TIME, current), time, 0.3, 2.0) + 1e-4 * random.standard_normal(time.size)
    return Recording("turns", "position", time, angle, Channel(TIME, current), input="current")


def data_of(*recordings: Recording) -> Data:
    return all_fitted(recordings, ROTOR)


def spectrum(model: Model) -> np.ndarray:
    """Amplitudes [N.m] of the torque over a turn by order."""
    assert model.residual_torque is not None
    torque = model.residual_torque["torque"][:-1, 0]
    return 2.0 * np.abs(np.fft.rfft(torque)) / torque.size


def test_the_orders_are_found_with_their_size() -> None:
    found = with_turn(data_of(turning(rippled((7, 0.006), (28, 0.003)), 4)), ROTOR)
    assert found is not None
    amplitudes = spectrum(found)
    # the shaft passes up to a tenth of a period of the 28th order between two samples
    assert amplitudes[7] == pytest.approx(0.006, rel=0.1)
    assert amplitudes[28] == pytest.approx(0.003, rel=0.15)
    assert np.max(np.delete(amplitudes, [7, 28])) < 0.0005


def test_it_is_the_load_torque_that_the_simulation_lacks() -> None:
    true = rippled((7, 0.006))
    found = with_turn(data_of(turning(true, 4)), ROTOR)
    assert found is not None and found.residual_torque is not None
    wanted = 0.006 * np.cos(7.0 * found.residual_torque["angle"])
    np.testing.assert_allclose(found.residual_torque["torque"][:, 0], wanted, atol=0.0006)


@pytest.mark.parametrize("seed", range(8))
def test_a_rotor_without_one_has_none(seed: int) -> None:
    assert with_turn(data_of(turning(ROTOR, seed)), ROTOR) is None


def test_every_recording_must_show_it() -> None:
    with_one, without = turning(rippled((7, 0.006)), 4), turning(ROTOR, 5)
    assert with_turn(data_of(with_one), ROTOR) is not None
    assert with_turn(data_of(with_one, without), ROTOR) is None


def test_less_than_a_turn_tells_nothing() -> None:
    assert with_turn(data_of(turning(rippled((7, 0.006)), 4, turns=0.02)), ROTOR) is None


def test_a_valve_does_not_turn_round() -> None:
    valve = Model.nominal(read_actuator("pierburg"))
    time = np.arange(0.0, 3.0, 0.002)
    duty = np.where(time < 1.0, 0.0, 0.3)
    still = Recording("valve", "hall_voltage", time, simulate(valve, Inputs(time, duty), time), Channel(time, duty))
    assert with_turn(all_fitted([still], valve), valve) is None


def test_the_strongest_orders_are_named() -> None:
    torque = (0.003 * np.cos(28.0 * ANGLE))[:, None]
    assert described_turn(torque, "N.m") == "it repeats itself with every turn, with 0.0030 N.m 28 times"
