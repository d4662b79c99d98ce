"""What every effect promises: absent at zero strength, continuous towards it, and independent of the internal step."""

from __future__ import annotations

import numpy as np
import pytest
from independent.excitation import rich_duty

from pierburg_ros.actuators import read_actuator
from pierburg_ros.effects import EFFECTS, Effect
from pierburg_ros.plant import Inputs, Model, simulate

NOMINAL = Model.nominal(read_actuator("pierburg"))
STIFFNESSES = {"gear_compliance.stiffness", "stop_compliance.stiffness", "presliding.stiffness"}
RESTING_ON_COULOMB = {"static_friction.breakaway_torque": 0.2007}
"""A breakaway torque that tends to T_c is one that vanishes."""


def strengths() -> list[tuple[Effect, str]]:
    return [(effect, name) for effect in EFFECTS for name in effect.strength]


def plausible(effect: Effect) -> dict[str, float]:
    """All parameters of an effect in the middle of their plausible ranges."""
    values = {
        f"{effect.id}.{p.name}": p.choices[0] if p.choices else 0.5 * sum(p.expected(NOMINAL.scales))
        for p in effect.parameters
    }
    if effect.id == "external_load":
        values |= {"external_load.torque": 0.05, "external_load.start": 0.5, "external_load.end": 7.0}
    return values


def ids(item: tuple[Effect, str] | Effect) -> str:
    return item.id if isinstance(item, Effect) else f"{item[0].id}.{item[1]}"


@pytest.mark.parametrize("effect", EFFECTS, ids=ids)
def test_absent_at_zero_strength(effect: Effect) -> None:
    time, duty = rich_duty(6.0)
    values = plausible(effect) | {f"{effect.id}.{name}": 0.0 for name in effect.strength}
    absent = simulate(NOMINAL.with_values(values), Inputs(time, duty), time)
    assert np.array_equal(absent, simulate(NOMINAL, Inputs(time, duty), time))


@pytest.mark.parametrize("strength", strengths(), ids=ids)
def test_continuous_towards_absence(strength: tuple[Effect, str]) -> None:
    effect, name = strength
    time, duty = rich_duty(6.0)
    nominal = simulate(NOMINAL, Inputs(time, duty), time)
    flat = f"{effect.id}.{name}"
    values = plausible(effect) | {f"{effect.id}.{other}": 0.0 for other in effect.strength}

    def distance(share: float) -> float:
        strong = effect.parameter(name).expected(NOMINAL.scales)[1]
        weak = strong / share if flat in STIFFNESSES else strong * share
        if flat in RESTING_ON_COULOMB:
            weak = RESTING_ON_COULOMB[flat] + share * (strong - RESTING_ON_COULOMB[flat])
        model = NOMINAL.with_values(values | {flat: weak})
        return float(np.sqrt(np.mean((simulate(model, Inputs(time, duty), time) - nominal) ** 2)))

    at_strength, near, nearer = distance(1.0), distance(1e-2), distance(1e-3)
    assert at_strength > 1e-4, "the excitation does not show the effect"
    assert near < at_strength
    assert nearer < 0.3 * near or nearer < 0.1e-3, "0.1 mV is what the internal steps may add up to"


@pytest.mark.parametrize("effect", EFFECTS, ids=ids)
def test_halving_the_sample_interval_changes_nothing(effect: Effect) -> None:
    """Half the interval at least halves the internal steps; the converter's own steps are left out."""
    if effect.id == "sensor_quantization":
        pytest.skip("a rounding has no internal step; its own test covers it")
    time, duty = rich_duty(8.0)
    halved = np.sort(np.concatenate([time, time[:-1] + 0.5 * np.diff(time)]))
    model = NOMINAL.with_values(plausible(effect))
    coarse = simulate(model, Inputs(time, duty), time)
    fine = simulate(model, Inputs(time, duty), halved)[::2]
    assert np.abs(coarse - fine).max() < 0.5e-3
