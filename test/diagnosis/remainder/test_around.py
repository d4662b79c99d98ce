"""The strongest order of a torque over a turn is named, where there are overtones and unseen data improve."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.diagnosis.remainder.around import goes_around, supported_around, vouched_around
from pierburg_ros.diagnosis.remainder.confirmed import confirmed
from pierburg_ros.diagnosis.remainder.shape import fit_shape
from pierburg_ros.estimation.data import Data, data_of, in_parts
from pierburg_ros.estimation.turn import left_of_torque, with_turn
from pierburg_ros.plant import Inputs, Model, simulate
from pierburg_ros.recording import Channel, Recording
from pierburg_ros.workers import workers

NOMINAL = Model.nominal(read_actuator("odrive")).with_values({"viscous_friction.coefficient": 0.01})
TIME = np.arange(0.0, 6.0, 0.002)
ANGLE = np.linspace(0.0, 2.0 * np.pi, 512)
RIPPLE = {
    "cogging_torque.amplitude": 0.006,
    "cogging_torque.periods_per_motor_revolution": 7.0,
    "cogging_torque.phase": 0.8,
}


def recorded(model: Model, seed: int = 4) -> Recording:
    """A rotor that goes round slowly under a current that wanders."""
    random = np.random.default_rng(seed)
    current = 1.2 + 0.2 * np.interp(TIME, np.linspace(0.0, 6.0, 60), random.standard_normal(60))
    angle = simulate(model, Inputs(TIME, current), TIME, 0.3, 2.0) + 1e-4 * random.standard_normal(TIME.size)
    return Recording(f"turns {seed}", "position", TIME, angle, Channel(TIME, current), input="current")


def data_on(model: Model, *seeds: int) -> Data:
    return in_parts(data_of([recorded(model, seed) for seed in seeds or (4,)], NOMINAL))


def overtone(amplitude: float, order: float) -> dict[str, Any]:
    torque = amplitude * np.cos(order * ANGLE)[:, None]
    return {"angle": ANGLE, "velocity": np.zeros(1), "torque": torque, "period": 2.0 * np.pi}


def rippled() -> Model:
    return NOMINAL.with_values({**RIPPLE, "coulomb_friction": 0.012}).with_residual(overtone(0.003, 28.0))


def test_a_ripple_with_an_overtone_is_named_beside_a_drift() -> None:
    data = data_on(rippled())
    found = supported_around(data, NOMINAL)
    assert found is not None
    values = found.scored.fit.values
    assert values["cogging_torque.periods_per_motor_revolution"] == 7.0
    assert values["cogging_torque.amplitude"] == pytest.approx(0.006, rel=0.1)
    assert values["cogging_torque.phase"] == pytest.approx(0.8, abs=0.1)
    assert values["coulomb_friction"] == pytest.approx(0.012, rel=0.1)


def test_a_rotor_without_a_ripple_is_given_none() -> None:
    data = data_on(NOMINAL.with_values({"coulomb_friction": 0.012}))
    assert supported_around(data, NOMINAL) is None


def test_a_ripple_that_the_nominal_model_has_is_not_named_again() -> None:
    """Neither with its overtones, where nothing is left, nor without, where the overtones are."""
    torque = overtone(0.003, 28.0)["torque"] + overtone(0.003, 14.0)["torque"]
    known = rippled().with_residual({**overtone(0.0, 1.0), "torque": torque})
    data, bare = data_on(known), known.with_residual(None)
    assert not goes_around(data, known) and supported_around(data, known) is None
    assert goes_around(data, bare) and supported_around(data, bare) is None


def test_what_a_known_torque_over_a_turn_lacks_is_added_to_it() -> None:
    """Another order beside the one that is known; that stays."""
    known = NOMINAL.with_residual(overtone(0.003, 14.0))
    torque = overtone(0.003, 14.0)["torque"] + overtone(0.004, 9.0)["torque"]
    data = data_on(NOMINAL.with_residual({**overtone(0.0, 1.0), "torque": torque}))
    both = with_turn(data, known)
    assert both is not None and both.residual_torque is not None
    found = np.interp(ANGLE, both.residual_torque["angle"], np.asarray(both.residual_torque["torque"])[:, 0])
    assert np.corrcoef(found, torque[:, 0])[0, 1] > 0.98


def test_several_recordings_vouch_for_a_ripple_that_they_share() -> None:
    data = data_on(rippled(), 4, 5)
    found, said = supported_around(data, NOMINAL), vouched_around(data, NOMINAL)
    assert found is not None and said is not None
    assert found.scored.fit.values["cogging_torque.amplitude"] == pytest.approx(0.006, rel=0.1)
    assert (said.helped, said.parts, said.recordings) == (2, 2, ("turns 4", "turns 5"))
    assert said.beside < 0.5 * said.without
    assert vouched_around(data_on(NOMINAL.with_values({"coulomb_friction": 0.012}), 4, 5), NOMINAL) is None


def test_recordings_left_out_confirm_what_repeats_itself() -> None:
    """A recording that does not train tells nothing of the torque over a turn, though it goes round."""
    rotor = rippled()
    data = data_on(rotor, 4, 5)
    with workers(1) as pool:
        shape = fit_shape(data, [lambda _: rotor.with_residual(None)], pool)
        assert confirmed(shape, data, pool)


def test_a_load_that_passes_for_overtones_is_not_confirmed() -> None:
    """Something pushes a pendulum from 4.8 s on: what its orders tell is of no use on samples that validate."""
    pendulum = Model.nominal(read_actuator("ak80"))
    random, time = np.random.default_rng(0), np.arange(0.0, 12.0, 0.008)
    torque = random.uniform(-1.6, 1.6, 30)[(time / 0.7).astype(int)]
    load = {"external_load.torque": 0.05, "external_load.start": 4.8, "external_load.end": 12.0}
    angle = simulate(pendulum.with_values(load), Inputs(time, torque), time)
    noisy = angle + 0.001 * random.standard_normal(time.size)
    pushed = Recording("pushed", "position", time, noisy, Channel(time, torque), input="torque")
    data = in_parts(data_of([pushed], pendulum))
    assert left_of_torque(data, data, pendulum) is not None and not goes_around(data, pendulum)
    assert goes_around(data_on(rippled()), NOMINAL)
