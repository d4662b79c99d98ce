"""What a model accepts, refuses, remembers."""

from __future__ import annotations

import math

import numpy as np
import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.effects import EFFECTS
from pierburg_ros.errors import InputError
from pierburg_ros.plant import Inputs, Model, simulate

NOMINAL = Model.nominal(read_actuator("pierburg"))


def test_nominal_model_has_every_parameter_and_no_effect() -> None:
    names = {f"{effect.id}.{p.name}" for effect in EFFECTS for p in effect.parameters}
    assert {name: NOMINAL.values[name] for name in names} == dict.fromkeys(names, 0.0)
    assert NOMINAL.values["armature_resistance"] == 4.139
    assert NOMINAL.active_effects == ()


def test_changing_values_leaves_the_original_alone() -> None:
    changed = NOMINAL.with_values({"armature_resistance": 4.71})
    assert (NOMINAL.values["armature_resistance"], changed.values["armature_resistance"]) == (4.139, 4.71)


@pytest.mark.parametrize(
    ("changes", "message"),
    (
        ({"resistance": 1.0}, "There is no parameter resistance in actuator pierburg"),
        ({"backlash.width": 1.0}, "There is no parameter backlash.width"),
        ({"gravity_torque": 0.1}, "There is no parameter gravity_torque"),
        ({"armature_resistance": -1.0}, "armature_resistance is -1; expected 0.1 to 50"),
        ({"armature_resistance": math.nan}, "armature_resistance is nan; expected 0.1 to 50"),
        ({"armature_resistance": "4"}, "armature_resistance is '4'; expected a number"),
        ({"armature_resistance": True}, "armature_resistance is True; expected a number"),
        ({"backlash.gap": -0.6}, "backlash.gap is -0.6; expected 0 to 1e+09"),
        ({"sensor_nonlinearity.half_waves": 1.5}, "half_waves is 1.5; expected 1 or 2"),
        ({"static_friction.breakaway_torque": 0.1}, "expected 0 (absent) or at least coulomb_friction, 0.2007"),
        ({"coulomb_friction": 0.3, "static_friction.breakaway_torque": 0.25}, "at least coulomb_friction, 0.3"),
        (
            {"viscous_friction.coefficient": 0.02, "direction_dependent_friction.viscous_difference": -0.03},
            "is -0.03 and viscous_friction.coefficient 0.02; expected a sum of at least 0",
        ),
        ({"supply_sag.source_resistance": 4.2}, "expected less than armature_resistance, 4.139"),
    ),
)
def test_refusals_say_what_was_expected(changes: dict[str, float], message: str) -> None:
    with pytest.raises(InputError) as refusal:
        NOMINAL.with_values(changes)
    assert message in str(refusal.value)
    assert "\n" not in str(refusal.value)


def test_numpy_numbers_and_integers_are_numbers() -> None:
    changed = NOMINAL.with_values({"armature_resistance": np.float32(5.0), "supply_voltage": 12})
    assert (changed.values["armature_resistance"], changed.values["supply_voltage"]) == (5.0, 12)


def test_residual_torque_acts_as_a_load() -> None:
    """A flat residual of 0.05 N.m shifts the standing angle like that much more preload."""
    grid = {"angle": [0.0, 1.0], "velocity": [-1.0, 1.0], "torque": [[0.05, 0.05], [0.05, 0.05]]}
    time = np.arange(0.0, 4.0, 0.01)
    inputs = Inputs(time[:1], np.array([0.24]))
    loaded = simulate(NOMINAL.with_residual(grid), inputs, time)
    stiffer = simulate(NOMINAL.with_values({"spring_preload": 0.34}), inputs, time)
    assert np.abs(loaded - stiffer).max() < 1e-5


def test_residual_torque_is_bilinear_and_clamped() -> None:
    """Rising with the angle it is a spring of 0.1 N.m/rad up to 0.5 rad and constant beyond."""
    grid = {"angle": [0.0, 0.5], "velocity": [0.0], "torque": [[0.0], [0.05]]}
    time = np.arange(0.0, 30.0, 0.01)
    voltage = simulate(NOMINAL.with_residual(grid), Inputs(time[:1], np.array([0.22])), time)
    push = 37.3 * 0.022 * 0.22 * 13.5 / 4.139 - 0.29 - 0.2007
    angle = push / (0.1419 + 0.1)
    angle = angle if angle < 0.5 else (push - 0.05) / 0.1419
    assert voltage[-1] == pytest.approx(0.42 + 4.10 * angle / (math.pi / 2), abs=1e-5)


@pytest.mark.parametrize(
    ("grid", "message"),
    (
        ({"angle": [0.0]}, "residual_torque has angle; expected angle, velocity and torque"),
        ({"angle": [1.0, 0.0], "velocity": [0.0], "torque": [[0.0], [0.0]]}, "residual_torque.angle is unusable"),
        ({"angle": [0.0], "velocity": [0.0], "torque": [[math.nan]]}, "expected (1, 1), finite"),
        ({"angle": [0.0, 1.0], "velocity": [0.0], "torque": [[0.0]]}, "has shape (1, 1); expected (2, 1)"),
    ),
)
def test_unusable_residual_torque_is_refused(grid: dict[str, object], message: str) -> None:
    with pytest.raises(InputError) as refusal:
        NOMINAL.with_residual(grid)
    assert message in str(refusal.value)


def test_a_residual_torque_with_a_period_acts_in_every_turn():
    """Seven sines in a turn as nodes, on a free rotor that goes round several times, beside the same by its formula."""
    rotor = Model.nominal(read_actuator("odrive"))
    angle = np.linspace(0.0, 2.0 * np.pi, 512)
    turn = {"angle": angle, "velocity": [0.0], "torque": 0.01 * np.sin(7.0 * angle)[:, None], "period": 2.0 * np.pi}
    ripple = {"cogging_torque.amplitude": 0.01, "cogging_torque.periods_per_motor_revolution": 7.0}
    inputs, time = Inputs(np.zeros(1), np.full(1, 1.5)), np.arange(0.0, 1.0, 0.002)
    known = simulate(rotor.with_values(ripple), inputs, time, 0.3, 5.0)
    assert known[-1] > 50.0
    for turns in (0, -4):
        begun = 0.3 + 2.0 * np.pi * turns
        found = simulate(rotor.with_residual(turn), inputs, time, begun, 5.0)
        # straight lines between 73 nodes of a sine take a thousandth off it
        np.testing.assert_allclose(found - 2.0 * np.pi * turns, known, atol=2e-3)
    with pytest.raises(InputError, match=r"residual_torque.period is 3 rad"):
        rotor.with_residual({**turn, "period": 3.0})
