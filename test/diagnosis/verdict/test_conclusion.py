"""From recordings to a verdict: nothing, a drift, a change, an effect, an effect behind a drift, a tie."""

from dataclasses import replace

import numpy as np
import pytest
from pierburg_ros.diagnosis.evidence.data import choosing_blocks, evidence_of
from pierburg_ros.diagnosis.search.explanation import WHEN, Explanation
from pierburg_ros.diagnosis.search.explore import explored
from pierburg_ros.diagnosis.search.fits import Search
from pierburg_ros.estimation.resimulation import inputs_of
from support.recordings import NOMINAL, PIERBURG, recording, recording_under

from pierburg_ros.diagnosis.search.selection import adequate, overlooks, tied
from pierburg_ros.diagnosis.verdict.conclusion import Conclusion, conclude
from pierburg_ros.plant import simulate_switched
from pierburg_ros.recording import Channel, Recording

pytestmark = pytest.mark.search

DEAD = {"pwm_deadband.width": 0.02}


def conclusion_on(changes: dict[str, float], seed: int = 0) -> Conclusion:
    return conclude(explored(evidence_of([recording(changes, seed=seed)], PIERBURG), NOMINAL))


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_the_nominal_valve_is_consistent(seed: int) -> None:
    found = conclusion_on({}, seed=seed)
    assert found.verdict == "consistent"
    assert found.chosen.explanation.size == 0


def test_a_drifted_resistance_is_a_drift_and_no_effect() -> None:
    found = conclusion_on({"armature_resistance": 4.9})
    assert found.verdict == "parameter_drift"
    assert found.chosen.explanation.drifted == ("armature_resistance",)
    assert found.chosen.values["armature_resistance"] == pytest.approx(4.9, rel=0.01)


def test_stiction_is_named_with_its_values() -> None:
    found = conclusion_on({"static_friction.breakaway_torque": 0.26, "static_friction.stribeck_velocity": 0.1})
    assert found.verdict == "missing_physics"
    assert found.chosen.explanation.effects == ("static_friction",)
    assert found.chosen.values["static_friction.breakaway_torque"] == pytest.approx(0.26, rel=0.03)


def test_an_effect_behind_a_drift_is_named() -> None:
    found = conclusion_on({"sensor_lag.time_constant": 0.012, "spring_preload": 0.32})
    assert found.verdict == "missing_physics"
    assert found.chosen.explanation.effects == ("sensor_lag",)
    assert found.chosen.explanation.drifted == ("spring_preload",)
    estimate = found.estimates["sensor_lag.time_constant"]
    assert estimate.low < 0.012 < estimate.high


def test_viscous_friction_comes_with_its_exact_tie() -> None:
    found = conclusion_on({"viscous_friction.coefficient": 0.03})
    assert found.chosen.explanation.effects == ("viscous_friction",)
    ties = {alternative.instead for alternative in found.alternatives}
    assert ("armature_resistance", "torque_constant") in ties
    assert ("armature_resistance", "supply_voltage") in ties


def test_an_effect_that_only_what_chooses_shows_is_named() -> None:
    load = {"external_load.torque": 0.06, "external_load.start": 3.2, "external_load.end": 3.7}
    data = evidence_of([recording(load)], PIERBURG)
    (run,) = data.runs
    during = (run.time > 3.0) & (run.time < 9.0)
    hidden = replace(data, runs=(replace(run, training=run.training & ~during, choosing=during),))
    nominal = Search(hidden, NOMINAL).fit(Explanation())
    assert adequate(nominal) and overlooks(nominal, Search(hidden, NOMINAL))
    assert explored(hidden, NOMINAL).preferred().explanation.effects == ("external_load",)


def test_a_change_in_the_middle_is_dated() -> None:
    plain = recording({})
    after = NOMINAL.with_values({"armature_resistance": 4.9})
    hall = simulate_switched(NOMINAL, after, 13.4, inputs_of(plain), plain.time)
    noise = 0.003 * np.random.default_rng(7).standard_normal(hall.size)
    duty = Channel(plain.time, plain.duty.values)
    changed = Recording("changed.mcap", "hall_voltage", plain.time, hall + noise, duty)
    found = conclude(explored(evidence_of([changed], PIERBURG), NOMINAL))
    assert found.verdict == "parameter_drift"
    assert found.chosen.explanation.changed == "armature_resistance"
    assert found.chosen.values["armature_resistance" + WHEN] == pytest.approx(13.4, abs=0.3)


def test_of_explanations_that_fit_alike_one_that_fails_on_the_choosing_samples_is_out() -> None:
    """A dead band is a larger preload while the duty stays above it: only a return at no duty tells them apart."""
    random = np.random.default_rng(3)
    time = np.arange(0.0, 24.0, 0.002)
    duty = random.uniform(0.1, 0.36, 41)[(time / 0.6).astype(int)]
    choosing = choosing_blocks(time)
    duty[choosing & (time % 1.5 > 0.5)] = 0.0
    duty[np.roll(choosing, round(1.5 / 0.002))] = 0.36  # to the open stop, where the valve forgets where it came from
    found = conclude(explored(evidence_of([recording_under(duty, time, DEAD, random)], PIERBURG), NOMINAL))
    assert found.chosen.explanation.effects == ("pwm_deadband",)
    assert found.chosen.explanation.drifted == ()
    assert ("spring_preload",) not in {alternative.instead for alternative in found.alternatives}


def test_only_known_fits_are_tied() -> None:
    """A model with a residual torque stands beside what was explored."""
    search = Search(evidence_of([recording({})], PIERBURG), NOMINAL)
    assert tied(search.fit(Explanation()), [], search) == []
