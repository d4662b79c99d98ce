"""A fit whose range goes along with it, what runs away, and a rotor whose torque repeats itself with every turn."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.identification.identify import identify
from pierburg_ros.identification.reach import fitted
from pierburg_ros.plant import Inputs, Model, simulate
from pierburg_ros.recording import Channel, Recording

PENDULUM, ROTOR = (Model.nominal(read_actuator(name)) for name in ("ak80", "odrive"))
ANGLE = np.linspace(0.0, 2.0 * np.pi, 512)


def swinging(model: Model) -> Recording:
    random, time = np.random.default_rng(2), np.arange(0.0, 6.0, 0.004)
    torque = 2.0 * np.interp(time, np.linspace(0.0, 6.0, 15), random.standard_normal(15))
    angle = simulate(model, Inputs(time, torque), time) + 1e-3 * random.standard_normal(time.size)
    return Recording("swing", "position", time, angle, Channel(time, torque), input="torque")


def turning(model: Model) -> Recording:
    random, time = np.random.default_rng(4), np.arange(0.0, 6.0, 0.002)
    current = 1.2 + 0.2 * np.interp(time, np.linspace(0.0, 6.0, 60), random.standard_normal(60))
    angle = simulate(model, Inputs(time, current), time, 0.3, 2.0) + 1e-4 * random.standard_normal(time.size)
    return Recording("turns", "position", time, angle, Channel(time, current), input="current")


def described(model: Model, **numbers: float) -> Model:
    """The actuator of `model` with other numbers in its description."""
    parameters = dict(model.actuator.parameters)
    for name, value in numbers.items():
        parameters[name] = replace(parameters[name], default=value)
    return Model.nominal(replace(model.actuator, parameters=parameters))


@pytest.mark.parametrize("off", [1 / 20, 1 / 8, 1 / 6.5, 7.0, 7.5, 8.0, 9.0, 10.0, 20.0])
def test_a_pendulum_is_found_however_far_off_its_inertia_is_described(off: float) -> None:
    """A search ends at six times the description; from there a fit of simulations ends in a local minimum."""
    start = described(PENDULUM, total_inertia=off * 0.147)
    found, endless = fitted(start, [swinging(PENDULUM)], ["total_inertia", "coulomb_friction"])
    assert endless == ()
    assert found.values["total_inertia"] == pytest.approx(0.147, rel=0.02)
    assert found.values["coulomb_friction"] == pytest.approx(0.184, rel=0.1)


@pytest.mark.parametrize("off", [1 / 20, 15.0])
def test_a_rotor_is_found_from_afar(off: float) -> None:
    start = described(ROTOR, total_inertia=off * 2.5e-4, coulomb_friction=0.02 / off**0.5)
    found, endless = fitted(start, [turning(ROTOR)], ["total_inertia", "coulomb_friction"])
    assert endless == ()
    assert found.values["total_inertia"] == pytest.approx(2.5e-4, rel=0.01)
    assert found.values["coulomb_friction"] == pytest.approx(0.02, rel=0.01)


def test_what_leaves_no_trace_and_runs_away_is_held_as_described() -> None:
    """The recording has no friction at all: the fit makes it as small as it may, and does as well with what is left."""
    small = {"coulomb_friction": 1e-5}
    start = PENDULUM.with_values(small)
    found = identify(start, [swinging(PENDULUM.with_values({"coulomb_friction": 0.0}))], fixed=("torque_scale",))
    entry = found.as_mapping()["parameters"]["coulomb_friction"]
    assert entry["value"] == pytest.approx(1e-5, rel=10.0) and not entry["identifiable"] and entry["ci95"] is None
    assert found.fitted.values["total_inertia"] == pytest.approx(0.147, rel=0.02)


def test_a_torque_over_a_turn_is_part_of_the_model_and_all_go_in_ratio_to_the_constant() -> None:
    """Without it the inertia, which smooths the motion, ends at several times its value."""
    ripple = {"angle": ANGLE, "velocity": np.zeros(1), "period": 2.0 * np.pi}
    ripple["torque"] = (0.006 * np.sin(7.0 * ANGLE) + 0.003 * np.cos(28.0 * ANGLE))[:, None]
    true = ROTOR.with_values({"viscous_friction.coefficient": 0.01}).with_residual(ripple)
    start = ROTOR.with_values({"viscous_friction.coefficient": 0.01})
    found = identify(start, [turning(true)], fixed=("viscous_friction.coefficient",))
    assert found.repeated is not None and "7 times" in found.repeated
    assert found.model.residual_torque is None and found.fitted.model.residual_torque is not None
    assert found.fitted.values["total_inertia"] == pytest.approx(2.5e-4, rel=0.3)
    assert not found.findings["torque_constant"].identifiable
    held = identify(start, [turning(true)], fixed=("viscous_friction.coefficient", "total_inertia"))
    finding = held.findings["torque_constant"]
    assert not finding.identifiable and "only in ratio" in finding.reason
