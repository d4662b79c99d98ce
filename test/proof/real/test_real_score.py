"""The score of a diagnosis of a real recording."""

from pierburg_ros.proof.real.score import score

NOTHING = {"verdict": "unexplained", "effects": [], "parameters": {}}


def truth(kind="sensor_lag", true=None):
    """The label of a trial."""
    true = {"sensor_lag.time_constant": 0.02} if true is None else true
    label = {"id": "a", "recording": "run", "half": 0, "kind": kind, "level": "plain", "strength": 0.02, "limit": None}
    return {**label, "true": true, "shown": bool(true) or None}


def naming(*effects, drifted=(), ties=()):
    """A diagnosis that names effects with a value each, and drifts to 2.0."""
    return {
        "verdict": "unexplained",
        "effects": [
            {"id": effect, "parameters": {parameter: {"value": value}}, "indistinguishable_from": list(ties)}
            for effect, parameter, value in effects
        ],
        "parameters": {name: {"value": 2.0, "drifted": True} for name in drifted},
    }


LAG = ("sensor_lag", "time_constant", 0.024)
LOAD = ("load_dependent_friction", "coefficient", 0.3)


def test_an_effect_that_is_named_counts_with_its_value():
    result = score(truth(), naming(LAG), NOTHING)
    assert result.named and not result.already and result.found == 0.024 and result.within
    far = score(truth(), naming(("sensor_lag", "time_constant", 0.026)), NOTHING)
    assert far.named and far.within is False


def test_what_is_not_named_has_no_value():
    result = score(truth(), naming(LOAD), NOTHING)
    assert not result.named and result.found is None and result.within is None
    assert result.beside == ("load_dependent_friction",)


def test_what_the_untouched_recording_is_given_too_is_no_other_effect():
    assert score(truth(), naming(LAG, LOAD), naming(LOAD)).beside == ()


def test_an_effect_named_without_being_put_in_proves_nothing():
    assert score(truth(), naming(LAG), naming(LAG)).already


def test_an_effect_among_equals_is_tied():
    result = score(truth(), naming(LOAD, ties=[["sensor_lag"], ["armature_resistance"]]), NOTHING)
    assert result.tied and not result.named


def test_a_wrong_number_is_named_by_its_drift():
    wrong = truth("armature_resistance", {"armature_resistance": 1.7})
    result = score(wrong, naming(drifted=["armature_resistance"]), NOTHING)
    assert result.named and result.found == 2.0 and result.within
    assert not score(wrong, naming(drifted=["torque_constant"]), NOTHING).named
    assert score(wrong, naming(drifted=["armature_resistance"]), naming(drifted=["armature_resistance"])).already


def test_any_effect_in_an_untouched_recording_is_one_more():
    untouched = {**truth("untouched", {}), "strength": None}
    assert score(untouched, naming(LOAD), naming(LOAD)).beside == ("load_dependent_friction",)
    assert score(untouched, NOTHING, NOTHING).beside == ()


def test_what_is_said_of_the_signals_is_kept():
    refused = {**NOTHING, "input_faults": [{"signal": "duty", "what": "late by 0.02 s"}]}
    assert score(truth(), refused, NOTHING).refused == ("duty: late by 0.02 s",)
