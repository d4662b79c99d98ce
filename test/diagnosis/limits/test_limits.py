"""Limits hold: an effect as strong as a limit is not excluded, one several times as strong is."""

from dataclasses import replace

import pytest
from support.fits import found_among
from support.recordings import NOMINAL, data_on, recording

from pierburg_ros.deadline import Deadline, OutOfTime
from pierburg_ros.diagnosis.limits.held import Case, Held
from pierburg_ros.diagnosis.limits.limits import Limit, limits
from pierburg_ros.diagnosis.search.found import Found
from pierburg_ros.effects import EFFECT
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.inference.coordinates import Coordinates
from pierburg_ros.inference.explanation import Explanation, Variant

LUMPS = Explanation(("armature_resistance", "spring_preload", "coulomb_friction"))
SOME = {"input_delay", "pwm_deadband", "gear_compliance"}


def nothing_named(changes: dict[str, float], seed: int) -> tuple[Found, Fit]:
    data = data_on(recording(changes, duration=12.0, seed=seed))
    estimator = Estimator(data, NOMINAL)
    nominal = estimator.at(Explanation())
    return replace(found_among(data, nominal), recalibrated=estimator.fit(LUMPS)), nominal


def limits_on(changes: dict[str, float], seed: int) -> dict[str, Limit]:
    """Limits of `SOME` effects where nothing is named on a recording of the valve with `changes`."""
    found, nominal = nothing_named(changes, seed)
    return {limit.effect: limit for limit in limits(found, nominal, jobs=1).found if limit.effect in SOME}


@pytest.fixture(scope="module")
def clean() -> dict[str, Limit]:
    return limits_on({}, seed=3)


def test_every_effect_that_shows_gets_a_limit_within_what_is_searched(clean):
    assert set(clean) == SOME
    for effect, limit in clean.items():
        axis = Coordinates((f"{effect}.{limit.parameter}",), NOMINAL, 12.0).axes[0]
        assert axis.value(axis.lower) < limit.value <= axis.value(axis.upper)
    assert clean["gear_compliance"].above and not clean["input_delay"].above


def test_a_clean_recording_excludes_less_than_what_is_plausible(clean):
    assert clean["input_delay"].value < EFFECT["input_delay"].parameter("delay").plausible[0]
    assert clean["gear_compliance"].value > EFFECT["gear_compliance"].parameter("stiffness").plausible[1]


@pytest.mark.parametrize("seed", [11, 12, 13])
def test_what_acts_as_strongly_as_a_limit_is_not_excluded(clean, seed):
    delay, width = clean["input_delay"].value, clean["pwm_deadband"].value
    assert limits_on({"input_delay.delay": delay}, seed)["input_delay"].value > delay
    assert limits_on({"pwm_deadband.width": width}, seed)["pwm_deadband"].value > width


def test_static_friction_is_held_by_what_it_exceeds_the_sliding_friction_by():
    """Held at a torque, the sliding friction could rise to it, and nothing would be excluded."""
    estimator = Estimator(data_on(recording({}, duration=12.0, seed=3)), NOMINAL)
    base = estimator.fit(LUMPS)
    start = {"breakaway_torque": 0.02, "stribeck_velocity": 0.04}
    case = Case(Variant("static_friction", tuple(start)), start, "breakaway_torque")
    fit = Held(estimator, base, case).fit(0.5, 0.0 * base.solution.point, 4)
    sliding, sticking = (fit.values[name] for name in ("coulomb_friction", "static_friction.breakaway_torque"))
    assert sliding != pytest.approx(base.values["coulomb_friction"], rel=1e-3)
    assert sticking - sliding == pytest.approx(0.01, rel=1e-6)


@pytest.mark.parametrize("own", [True, False], ids=["their own", "that of all"])
def test_limits_found_before_the_time_is_over_are_kept_and_the_others_named(clean, own, monkeypatch):
    begun: list[str] = []

    def stop_at_the_third(tried: str) -> None:
        begun.append(tried.removeprefix("limit of "))
        if len(begun) == 3:
            raise OutOfTime

    deadline = Deadline(1000.0)
    monkeypatch.setattr("pierburg_ros.diagnosis.limits.limits.LEAST", 100.0 if own else 10_000.0)
    found, nominal = nothing_named({}, seed=3)
    kept = limits(found, nominal, stop_at_the_third, jobs=1, deadline=deadline)
    whole = limits(found, nominal, jobs=1).found
    assert kept.found == [limit for limit in whole if limit.effect in begun[:2]] != []
    assert begun[2] in kept.untested and set(kept.untested).isdisjoint(begun[:2])
    assert deadline.stopped == (not own)


def test_what_is_late_has_no_limit_behind_a_filter_of_the_input(clean):
    """Its time is read from the same recording, and may be shorter instead."""
    found, nominal = nothing_named({}, seed=3)
    runs = tuple(replace(run, input_lag=0.08) for run in found.data.runs)
    told = limits(replace(found, data=replace(found.data, runs=runs)), nominal, jobs=1)
    effects = {limit.effect for limit in told.found}
    assert "pwm_deadband" in effects and not effects & {"input_delay", "sensor_lag"} and not told.untested
