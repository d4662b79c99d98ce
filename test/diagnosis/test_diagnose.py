"""Recordings in, a verdict out: what is refused, what is named, and what every document keeps to."""

import re
from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from support.recordings import NOISE, NOMINAL, changing, disturbed, recording

from pierburg_ros.actuators import read_actuator
from pierburg_ros.budget import Budget
from pierburg_ros.diagnosis.diagnose import diagnose
from pierburg_ros.diagnosis.result import Result
from pierburg_ros.diagnosis.schema import Diagnosis
from pierburg_ros.errors import InputError
from pierburg_ros.plant import Inputs, Model
from pierburg_ros.recording import Channel, Recording

STUCK = {"static_friction.breakaway_torque": 0.27, "static_friction.stribeck_velocity": 0.1}
STEP, CHANGED_AT = 0.02, 9.3


def changed() -> Recording:
    """The winding's resistance rises in mid-recording."""
    whole = recording({}, 18.0)
    inputs = Inputs(whole.command.time, whole.command.values)
    after = NOMINAL.with_values({"armature_resistance": 5.0})
    volts = changing(NOMINAL, after, CHANGED_AT, inputs, whole.time)
    return replace(whole, measured=volts + NOISE * np.random.default_rng(1).standard_normal(volts.size))


def quantized() -> Recording:
    """A converter whose steps are seven times the noise."""
    whole = recording({}, 12.0)
    return replace(whole, measured=STEP * np.round(whole.measured / STEP))


MADE: dict[str, Callable[[], Recording]] = {
    "as described": lambda: recording({}, 12.0),
    "one drift": lambda: recording({"armature_resistance": 5.2}, 12.0),
    "static friction": lambda: recording(STUCK),
    "viscous friction": lambda: recording({"viscous_friction.coefficient": 0.03}, 18.0),
    "a change": changed,
    "a converter": quantized,
    "a wave of no effect": lambda: disturbed({"sensor_lag.time_constant": 0.03}, seed=1),
}


@cache
def result(name: str) -> Result:
    """What is found in a recording; each is diagnosed once."""
    return diagnose([MADE[name]()], NOMINAL)


def found(name: str) -> Diagnosis:
    return result(name).diagnosis


def drifted(document: Diagnosis) -> set[str]:
    return {name for name, each in document.parameters.items() if each.drifted}


def test_another_actuator_is_refused() -> None:
    with pytest.raises(InputError, match=r"holds a Hall voltage and actuator xl330 measures its angle"):
        diagnose([recording({}, duration=5.0)], Model.nominal(read_actuator("xl330")))


def test_what_is_too_short_is_refused() -> None:
    with pytest.raises(InputError, match="too short"):
        diagnose([recording({}, duration=1.2)], NOMINAL)


def test_signals_that_are_not_what_they_are_read_as_are_refused_with_the_line_that_mends_them() -> None:
    right = recording({}, 12.0)
    wrong = replace(right, command=Channel(right.command.time, -right.command.values))
    refused = diagnose([wrong], NOMINAL)
    document = refused.diagnosis
    assert document.verdict == "unexplained" and not document.effects and not document.ruled_out
    (fault,) = document.input_faults
    assert fault.signal == "duty" and "sign: -1" in fault.mend
    assert document.summary.startswith("Nothing is concluded")
    assert any("--force" in each for each in document.advice)
    assert refused.model is NOMINAL


def test_a_motor_that_is_not_plugged_in_tells_nothing_and_gets_no_verdict() -> None:
    """Its sensor has noise, and the duty swings: what does not move shows no physics, and no drift of it."""
    alive = recording({}, 12.0)
    still = np.full(alive.time.size, 0.42) + NOISE * np.random.default_rng(3).standard_normal(alive.time.size)
    refused = diagnose([replace(alive, measured=still)], NOMINAL)
    document = refused.diagnosis
    assert document.verdict == "unexplained" and not document.effects and not drifted(document)
    assert "The shaft never moves" in document.input_faults[0].evidence and document.effort.simulations == 0
    assert document.advice[0].endswith("large enough to move the shaft both ways.") and refused.model is NOMINAL


@pytest.mark.search
def test_what_is_forced_is_concluded() -> None:
    right = recording({}, 6.0)
    wrong = replace(right, command=Channel(right.command.time, -right.command.values))
    document = diagnose([wrong], NOMINAL, force=True, budget=Budget(0.01)).diagnosis
    assert not document.input_faults and document.fit.training.nominal_rmse is not None


@pytest.mark.search
def test_the_actuator_as_described_is_consistent() -> None:
    document = found("as described")
    assert document.verdict == "consistent" and document.model_of == "description"
    assert not document.effects and not document.doubted and not drifted(document) and not document.locations
    assert document.fit.validation.final_rmse == pytest.approx(NOISE, rel=0.05)
    assert document.remaining.looks_like == "noise" and document.re_estimated_share is None
    assert result("as described").model.values == NOMINAL.values


@pytest.mark.search
def test_a_drift_is_one_drift() -> None:
    document = found("one drift")
    assert document.verdict == "parameter_drift" and document.model_of == "re_estimated"
    assert drifted(document) == {"armature_resistance"} and not document.effects
    resistance = document.parameters["armature_resistance"]
    assert resistance.value == pytest.approx(5.2, rel=0.01)
    assert resistance.ci95[0] < 5.2 < resistance.ci95[1]
    assert document.re_estimated_share == pytest.approx(1.0)
    assert result("one drift").model.values["armature_resistance"] == resistance.value


@pytest.mark.search
def test_static_friction_is_named_with_its_values() -> None:
    document = found("static friction")
    assert document.verdict == "missing_physics" and document.model_of == "effects"
    (effect,) = document.effects
    assert effect.id == "static_friction" and effect.confidence > 0.9
    breakaway = effect.parameters["breakaway_torque"]
    assert breakaway.value == pytest.approx(0.27, rel=0.05)
    assert breakaway.ci95[0] < 0.27 < breakaway.ci95[1]
    assert not drifted(document)
    assert document.fit.validation.final_rmse == pytest.approx(NOISE, rel=0.1)
    assert document.fit.validation.nominal_rmse > 5.0 * NOISE
    assert document.locations and all(place.regime and place.share > 0.0 for place in document.locations)


@pytest.mark.search
def test_an_effect_that_equals_two_drifts_is_told_with_the_tie_and_rules_none_of_it_out() -> None:
    document = found("viscous friction")
    assert [effect.id for effect in document.effects] == ["viscous_friction"]
    assert ["armature_resistance", "torque_constant"] in document.effects[0].indistinguishable_from


@pytest.mark.search
def test_a_change_is_told_with_its_moment() -> None:
    document = found("a change")
    assert document.verdict == "parameter_drift" and not document.effects
    (change,) = document.changes
    assert change.parameter == "armature_resistance"
    assert (change.before, change.after) == pytest.approx((4.139, 5.0), rel=0.01)
    assert change.time == pytest.approx(CHANGED_AT, abs=0.02)
    assert document.re_estimated_share == pytest.approx(1.0)


@pytest.mark.search
def test_the_steps_of_a_converter_are_named() -> None:
    document = found("a converter")
    assert document.verdict == "missing_physics"
    (effect,) = document.effects
    assert effect.id == "sensor_quantization" and effect.confidence == 1.0
    assert effect.parameters["step"].value == pytest.approx(STEP, rel=1e-6)
    assert result("a converter").model.values["sensor_quantization.step"] == pytest.approx(STEP, rel=1e-6)


@pytest.mark.search
def test_what_no_effect_makes_is_unexplained_and_located() -> None:
    document = found("a wave of no effect")
    assert document.verdict == "unexplained"
    assert document.remaining.looks_like != "noise" and document.remaining.share > 0.05
    assert document.locations and document.summary.startswith("An error remains that no effect explains.")
    assert all(each.given == "residual" for each in document.ruled_out)


@pytest.mark.search
@pytest.mark.parametrize("name", MADE)
def test_every_document_keeps_to_its_own_word(name: str) -> None:
    """Nothing is excluded that the same document states elsewhere, and shares are of one whole."""
    document = found(name)
    stated = {each.id for each in document.effects} | {each.id for each in document.doubted}
    for several in (*document.effects, *document.parameters.values()):
        stated |= {quantity for tie in several.indistinguishable_from for quantity in tie}
    assert not stated & {each.id for each in document.ruled_out}
    assert not {each.id for each in document.effects} & {each.id for each in document.doubted}
    shares = [document.re_estimated_share, document.remaining.share]
    shares += [each.share for each in document.effects if each.id != "sensor_quantization"]
    if None not in shares:
        assert sum(shares) == pytest.approx(1.0)
    (chosen,) = [each for each in document.candidates if each.status == "chosen"]
    assert set(chosen.id.split("+")) >= {each.id for each in document.effects} - {"sensor_quantization"}
    assert document.effort.stopped_by is None and document.effort.simulations > 0
    assert Diagnosis.model_validate_json(document.text()) == document


@pytest.mark.search
def test_jobs_and_repetition_change_no_byte() -> None:
    made = recording({"sensor_lag.time_constant": 0.02}, 8.0)
    texts = {diagnose([made], NOMINAL, jobs=jobs).diagnosis.text() for jobs in (1, 2, 2)}
    assert len(texts) == 1
    assert re.search(r'"id": ?"sensor_lag"', texts.pop())


@pytest.mark.search
def test_a_sensor_whose_ends_are_known_to_differ_is_no_fault() -> None:
    """The recording begins with the valve half open: decoded by the nominal ends it would start 2 degrees off."""
    ends = {"hall_voltage_closed": 0.55, "hall_voltage_open": 4.4}
    given = diagnose([recording(ends).select(2.42, 14.0)], NOMINAL.with_values(ends))
    assert given.diagnosis.verdict == "consistent"
    assert given.diagnosis.fit.validation.final_rmse == pytest.approx(NOISE, rel=0.05)
    assert given.model.values["hall_voltage_open"] == 4.4


@pytest.mark.search
def test_a_spent_budget_gives_the_best_verdict_yet_and_says_so() -> None:
    document = diagnose([recording({"sensor_lag.time_constant": 0.02}, 8.0)], NOMINAL, budget=Budget(0.001)).diagnosis
    assert document.effort.stopped_by == "budget" and document.effort.budget == 0.001
    assert document.summary.startswith("The effort allowed was spent before all was tried")
    assert not document.effects
