"""Scoring: what counts as right, tied, false alarm, expected, covered, complete."""

import copy

import pytest

from pierburg_ros.proof.score import failed, score

TRUTH = {
    "id": "sensor_lag-001",
    "kind": "sensor_lag",
    "severity": "concealed",
    "verdict": "missing_physics",
    "effects": [{"id": "sensor_lag", "parameters": {"time_constant": {"value": 0.01, "unit": "s"}}}],
    "drifted": {"spring_preload": 0.32},
    "changes": [],
    "not_in_catalogue": None,
    "visibility": {"noise": 0.002, "shown": True, "bounds": {"sensor_lag.time_constant": 0.01}},
}
ANSWER = {
    "verdict": "missing_physics",
    "effects": [
        {
            "id": "sensor_lag",
            "confidence": 0.97,
            "parameters": {"time_constant": {"value": 0.0105, "ci95": [0.0095, 0.0115]}},
            "indistinguishable_from": [],
        }
    ],
    "parameters": {"spring_preload": {"value": 0.32, "drifted": True, "indistinguishable_from": []}},
    "changes": [],
    "fit": {"training": {"nominal_rmse": 0.2, "final_rmse": 0.002}, "validation": {"final_rmse": 0.0021}},
}


def changed(mapping, **changes):
    """A deep copy with some entries replaced; None removes nothing."""
    return {**copy.deepcopy(mapping), **changes}


def other_effect(name, ties=()):
    return [{"id": name, "confidence": 0.9, "parameters": {}, "indistinguishable_from": [list(tie) for tie in ties]}]


def test_a_full_answer_is_complete():
    result = score(TRUTH, ANSWER, 0.9, 0.0021)
    assert result.right and result.complete and result.drift_named
    assert result.unseen_ratio == pytest.approx(1.05)
    assert result.values[0].error == pytest.approx(0.05)
    assert result.values[0].covered
    assert result.errors_volts["training_nominal_rmse"] == 0.2
    assert result.confidences == {"sensor_lag": 0.97}


@pytest.mark.parametrize(("windows", "unseen"), [(0.7, 0.0021), (0.9, 0.0023), (0.9, None)])
def test_poor_windows_or_unseen_data_leave_it_right_but_incomplete(windows, unseen):
    result = score(TRUTH, ANSWER, windows, unseen)
    assert result.right and not result.complete


def test_another_name_is_wrong():
    result = score(TRUTH, changed(ANSWER, effects=other_effect("input_delay")), None, None)
    assert not result.right and not result.tied and not result.false_alarm


def test_another_name_with_the_truth_as_its_tie_is_tied_not_right():
    answer = changed(ANSWER, effects=other_effect("input_delay", [["sensor_lag"]]))
    result = score(TRUTH, answer, None, None)
    assert result.tied and not result.right


def test_an_effect_too_many_is_wrong():
    answer = changed(ANSWER, effects=[*ANSWER["effects"], *other_effect("backlash")])
    assert not score(TRUTH, answer, None, None).right


def test_an_effect_where_there_is_none_is_a_false_alarm():
    truth = changed(TRUTH, kind="drift", verdict="parameter_drift", effects=[])
    result = score(truth, ANSWER, None, None)
    assert result.false_alarm and not result.right


def test_silence_is_right_only_where_the_recording_does_not_show_the_effect():
    silent = changed(ANSWER, verdict="parameter_drift", effects=[])
    hidden = changed(TRUTH, visibility={**TRUTH["visibility"], "shown": False})
    assert not score(TRUTH, silent, None, None).right
    assert score(hidden, silent, None, None).right
    assert score(hidden, ANSWER, None, None).right


def test_of_two_effects_one_that_the_recording_does_not_show_may_be_left_out():
    faint = {"id": "backlash", "parameters": {"gap": {"value": 0.03, "unit": "rad"}}}
    truth = changed(TRUTH, kind="two", effects=[*TRUTH["effects"], faint])
    assert not score(truth, ANSWER, None, None).right
    truth["visibility"] = {**TRUTH["visibility"], "faint": ["backlash"]}
    assert score(truth, ANSWER, None, None).right
    assert score(truth, changed(ANSWER, effects=[*ANSWER["effects"], *other_effect("backlash")]), None, None).right
    assert not score(truth, changed(ANSWER, effects=other_effect("backlash")), None, None).right
    assert not score(
        truth, changed(ANSWER, effects=[*ANSWER["effects"], *other_effect("presliding")]), None, None
    ).right


def test_a_value_is_expected_only_where_its_bound_is_tight():
    far = copy.deepcopy(ANSWER)
    far["effects"][0]["parameters"]["time_constant"] = {"value": 0.02, "ci95": None}
    assert not score(TRUTH, far, None, None).values_right
    loose = changed(TRUTH, visibility={**TRUTH["visibility"], "bounds": {"sensor_lag.time_constant": 0.2}})
    assert score(loose, far, None, None).values_right
    assert score(loose, far, None, None).values[0].covered is None


def test_an_expected_value_that_is_missing_is_wrong():
    missing = copy.deepcopy(ANSWER)
    missing["effects"][0]["parameters"] = {}
    assert not score(TRUTH, missing, None, None).values_right


def test_the_exact_tie_of_viscous_friction_belongs_in_the_answer():
    truth = changed(
        TRUTH,
        effects=[{"id": "viscous_friction", "parameters": {"coefficient": {"value": 0.03, "unit": ""}}}],
    )
    without = changed(ANSWER, effects=other_effect("viscous_friction"))
    tie = [["torque_constant", "armature_resistance"]]
    assert not score(truth, without, None, None).right
    assert score(truth, changed(ANSWER, effects=other_effect("viscous_friction", tie)), None, None).right


def test_outside_the_catalogue_asks_for_unexplained():
    truth = changed(TRUTH, kind="outside", verdict="unexplained", effects=[], not_in_catalogue="relaxation")
    unexplained = changed(ANSWER, verdict="unexplained", effects=[])
    assert score(truth, unexplained, None, 0.01).complete
    wrong = score(truth, ANSWER, None, None)
    assert not wrong.right and not wrong.false_alarm


@pytest.mark.parametrize(
    ("named", "shown", "right"),
    [(["sensor_lag"], True, True), (["sensor_lag", "backlash"], True, False), ([], True, False), ([], False, True)],
)
def test_beside_a_remainder_the_names_decide(named, shown, right):
    visibility = {**TRUTH["visibility"], "shown": shown}
    truth = changed(
        TRUTH,
        kind="beside",
        verdict="unexplained",
        remainder={"relaxation.stiffness": 0.007},
        effects=[{"id": "sensor_lag", "parameters": {"time_constant": {"value": 0.01, "unit": "s"}}}],
        visibility=visibility,
    )
    answer = changed(ANSWER, verdict="unexplained", effects=[each for name in named for each in other_effect(name)])
    assert score(truth, answer, None, None).right is right


@pytest.mark.parametrize(("found", "dated"), [(31.4, True), (35.0, False)])
def test_a_change_is_dated_within_half_a_second(found, dated):
    change = {"parameter": "armature_resistance", "time": 31.2, "before": 4.1, "after": 5.0}
    truth = changed(TRUTH, kind="change", verdict="parameter_drift", effects=[], changes=[change])
    answer = changed(ANSWER, effects=[], verdict="parameter_drift", changes=[{**change, "time": found}])
    assert score(truth, answer, None, None).change_dated is dated


@pytest.mark.parametrize(("told", "held"), [((29.0, 33.0), True), ((31.3, 33.0), False), (None, False)])
def test_the_interval_told_for_a_change_holds_its_moment_or_does_not(told, held):
    change = {"parameter": "armature_resistance", "time": 31.2, "before": 4.1, "after": 5.0}
    truth = changed(TRUTH, kind="change", verdict="parameter_drift", effects=[], changes=[change])
    answer = changed(ANSWER, effects=[], verdict="parameter_drift", changes=[{**change, "time_ci95": told}])
    assert score(truth, answer, None, None).change_held is held


def test_no_answer_is_a_failure_with_its_reason():
    result = failed(TRUTH, "the diagnosis ended with status 1")
    assert not result.right and result.failure == "the diagnosis ended with status 1"
    unseen = failed(changed(TRUTH, verdict="consistent", effects=[]), "crash")
    assert not unseen.right
