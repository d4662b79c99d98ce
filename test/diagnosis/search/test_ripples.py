"""Ripples beside a drift are found through stretches where descents over the whole recording end elsewhere."""

from concurrent.futures import ThreadPoolExecutor

import pytest
from pierburg_ros.diagnosis.evidence.data import evidence_of
from pierburg_ros.diagnosis.search.explanation import Explanation, Variant
from pierburg_ros.diagnosis.search.fits import Search
from pierburg_ros.diagnosis.search.ripples import RIPPLES, through_stretches
from support.recordings import NOMINAL, PIERBURG, recording, recording_in_closed_loop

from pierburg_ros.diagnosis.search.candidates import starts_of

pytestmark = pytest.mark.search

OVER_ANGLE, IN_TIME = RIPPLES
COGGING, PULSATION = OVER_ANGLE.variant, IN_TIME.variant
SUPPLY = Explanation(("supply_voltage",))
COGGED = {
    "cogging_torque.amplitude": 0.035,
    "cogging_torque.periods_per_motor_revolution": 4.0,
    "cogging_torque.phase": 0.7,
}


def search_in(changes: dict[str, float]) -> Search:
    return Search(evidence_of([recording({"supply_voltage": 12.8, **changes})], PIERBURG), NOMINAL)


def test_stretches_lead_to_the_noise_where_whole_recordings_do_not() -> None:
    search = search_in(COGGED)
    base, both = search.fit(SUPPLY), SUPPLY.plus(COGGING)
    starts = search.screened(base, COGGING, starts_of(search.data, base.model)[COGGING])[:4]
    assert min(search.fit(both, {**base.values, **start}).ratio for _, start in starts) > 2.0
    with ThreadPoolExecutor(2) as pool:
        (found,) = through_stretches(search, OVER_ANGLE, {both: base}, pool)
    assert found.ratio == pytest.approx(1.0, abs=0.02)
    for name, value in COGGED.items():
        assert found.values[name] == pytest.approx(value, rel=0.01)


def test_where_cogging_explains_little_it_is_not_followed_up() -> None:
    search = search_in({"viscous_friction.coefficient": 0.03})
    with ThreadPoolExecutor(2) as pool:
        assert through_stretches(search, OVER_ANGLE, {SUPPLY.plus(COGGING): search.fit(SUPPLY)}, pool) == []


@pytest.mark.parametrize("seed", (0, 1, 2))
def test_weak_cogging_in_closed_loop_is_told_from_errors_of_the_starts(seed: int) -> None:
    """The start of each stretch is off by a third of the noise, which can put a shaft on the other side of a pole."""
    weak = {"supply_voltage": 12.8, **COGGED, "cogging_torque.amplitude": 0.008}
    search = Search(evidence_of([recording_in_closed_loop(weak, seed)], PIERBURG), NOMINAL)
    base = search.fit(SUPPLY)
    assert base.ratio > 3.0
    with ThreadPoolExecutor(2) as pool:
        (found,) = through_stretches(search, OVER_ANGLE, {SUPPLY.plus(COGGING): base}, pool)
    assert found.ratio < 1.05
    assert found.values["cogging_torque.amplitude"] == pytest.approx(0.008, rel=0.05)
    assert found.values["cogging_torque.periods_per_motor_revolution"] == pytest.approx(4.0, rel=0.01)


@pytest.mark.parametrize("seed", (0, 1, 2))
def test_a_pulsating_load_in_closed_loop_is_found_at_its_own_rhythm(seed: int) -> None:
    """The missing torque has rhythms beside it, from the setpoints every 2 s."""
    load = {"external_load.amplitude": 0.03, "external_load.frequency": 2.784, "external_load.phase": 2.97}
    search = Search(evidence_of([recording_in_closed_loop({"supply_voltage": 12.8, **load}, seed)], PIERBURG), NOMINAL)
    base = search.fit(SUPPLY)
    assert base.ratio > 3.0
    with ThreadPoolExecutor(2) as pool:
        (found,) = through_stretches(search, IN_TIME, {SUPPLY.plus(PULSATION): base}, pool)
    assert found.ratio < 1.05
    for name, value in load.items():
        assert found.values[name] == pytest.approx(value, rel=0.02)


def test_heat_and_what_changes_midway_are_left_out() -> None:
    search = search_in({})
    heat = Explanation((), (COGGING, Variant("thermal_resistance", ("thermal_resistance", "heat_capacity"))))
    change = Explanation((), (COGGING,), "spring_preload")
    base = search.fit(Explanation())
    with ThreadPoolExecutor(2) as pool:
        assert through_stretches(search, OVER_ANGLE, {heat: base, change: base}, pool) == []
