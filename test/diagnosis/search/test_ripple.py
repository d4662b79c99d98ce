"""Ripples beside a drift are found between rests where descents over the whole recording end elsewhere."""

import math
from concurrent.futures import ThreadPoolExecutor

import pytest
from support.recordings import NOMINAL, data_on, recording, recording_in_closed_loop

from pierburg_ros.diagnosis.search.candidates import starts_of
from pierburg_ros.diagnosis.search.linear import promised
from pierburg_ros.diagnosis.search.ripple import between_rests, ripples
from pierburg_ros.effects import EFFECT
from pierburg_ros.estimation.estimator import Estimator
from pierburg_ros.inference.explanation import Explanation, Variant

COGGING = Variant("cogging_torque", ("amplitude", "periods_per_motor_revolution", "phase"))
PULSATION = Variant("external_load", ("amplitude", "frequency", "phase"))
OVER_ANGLE, IN_TIME = ((variant, EFFECT[variant.effect].ripple) for variant in (COGGING, PULSATION))
SUPPLY = Explanation(("supply_voltage",))
COGGED = {
    "cogging_torque.amplitude": 0.035,
    "cogging_torque.periods_per_motor_revolution": 4.0,
    "cogging_torque.phase": 0.7,
}


def estimator_on(changes: dict[str, float], duration: float = 24.0) -> Estimator:
    return Estimator(data_on(recording({"supply_voltage": 12.8, **changes}, duration)), NOMINAL)


def test_a_load_may_ripple_over_angle_and_in_time() -> None:
    assert ripples(estimator_on({})) == [OVER_ANGLE, IN_TIME]


@pytest.mark.search
def test_rests_lead_to_the_noise_where_whole_recordings_do_not() -> None:
    cogged = {**COGGED, "cogging_torque.phase": 1.9}
    estimator = estimator_on(cogged, duration=20.0)
    base, both = estimator.fit(SUPPLY), SUPPLY.plus(COGGING)
    starts = promised(estimator, base, COGGING, starts_of(estimator.data, base.model)[COGGING])[:4]
    assert min(estimator.fit(both, {**base.values, **start}).ratio for _, start in starts) > 2.0
    with ThreadPoolExecutor(2) as pool:
        ((found, smooth),) = between_rests(estimator, *OVER_ANGLE, {both: base}, pool)
    assert smooth.ratio < 1.1
    assert found.ratio == pytest.approx(1.0, abs=0.02)
    turned = {**found.values, "cogging_torque.phase": found.values["cogging_torque.phase"] % (2.0 * math.pi)}
    for name, value in cogged.items():
        assert turned[name] == pytest.approx(value, rel=0.01)


@pytest.mark.search
def test_rests_of_the_first_part_lead_to_the_noise_of_a_whole_minute() -> None:
    estimator = estimator_on(COGGED, duration=60.0)
    base = estimator.fit(SUPPLY)
    with ThreadPoolExecutor(2) as pool:
        ((found, _),) = between_rests(estimator, *OVER_ANGLE, {SUPPLY.plus(COGGING): base}, pool)
    assert found.solution.residual.size == base.solution.residual.size
    assert found.ratio == pytest.approx(1.0, abs=0.02)


@pytest.mark.search
@pytest.mark.parametrize("seed", (0, 1, 2))
def test_weak_cogging_in_closed_loop_is_told_from_errors_of_the_starts(seed: int) -> None:
    """A start that is off by a third of the noise can put a shaft on the other side of a pole."""
    weak = {"supply_voltage": 12.8, **COGGED, "cogging_torque.amplitude": 0.008}
    estimator = Estimator(data_on(recording_in_closed_loop(weak, seed)), NOMINAL)
    base = estimator.fit(SUPPLY)
    assert base.ratio > 3.0
    with ThreadPoolExecutor(2) as pool:
        ((found, _),) = between_rests(estimator, *OVER_ANGLE, {SUPPLY.plus(COGGING): base}, pool)
    assert found.ratio < 1.05
    assert found.values["cogging_torque.amplitude"] == pytest.approx(0.008, rel=0.05)
    assert found.values["cogging_torque.periods_per_motor_revolution"] == pytest.approx(4.0, rel=0.01)


@pytest.mark.search
@pytest.mark.parametrize("seed", (0, 1, 2))
def test_a_pulsating_load_in_closed_loop_is_found_at_its_own_rhythm(seed: int) -> None:
    """The missing torque has rhythms beside it, from the setpoints every 2 s."""
    load = {"external_load.amplitude": 0.03, "external_load.frequency": 2.784, "external_load.phase": 2.97}
    estimator = Estimator(data_on(recording_in_closed_loop({"supply_voltage": 12.8, **load}, seed)), NOMINAL)
    base = estimator.fit(SUPPLY)
    assert base.ratio > 3.0
    with ThreadPoolExecutor(2) as pool:
        ((found, _),) = between_rests(estimator, *IN_TIME, {SUPPLY.plus(PULSATION): base}, pool)
    assert found.ratio < 1.05
    for name, value in load.items():
        assert found.values[name] == pytest.approx(value, rel=0.02)


def test_heat_and_what_changes_midway_are_left_out() -> None:
    estimator = estimator_on({})
    heat = Explanation((), (COGGING, Variant("thermal_resistance", ("thermal_resistance", "heat_capacity"))))
    change = Explanation((), (COGGING,), "spring_preload")
    base = estimator.fit(Explanation())
    with ThreadPoolExecutor(2) as pool:
        assert between_rests(estimator, *OVER_ANGLE, {heat: base, change: base}, pool) == []


def test_a_shaft_that_stands_still_has_no_rhythm() -> None:
    estimator = Estimator(data_on(recording({}, duties=(-0.05, -0.05))), NOMINAL)
    with ThreadPoolExecutor(2) as pool:
        assert between_rests(estimator, *OVER_ANGLE, {SUPPLY.plus(COGGING): estimator.at(SUPPLY)}, pool) == []
