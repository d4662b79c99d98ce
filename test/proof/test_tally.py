"""Counting results: errors and coverage of values, reasons of failures, answers in words."""

import pytest

from pierburg_ros.proof import tally


def result(**changes):
    """A result with nothing remarkable about it."""
    plain = {
        "kind": "sensor_lag",
        "expected": "missing_physics",
        "verdict": "missing_physics",
        "concealed": ["sensor_lag"],
        "named": ["sensor_lag"],
        "shown": True,
        "right": True,
        "tied": False,
        "false_alarm": False,
        "failure": None,
        "values": [],
        "values_right": True,
        "windows": None,
        "unseen_ratio": 1.0,
    }
    return {**plain, **changes}


def value(found, interval, true=0.01, bound=0.01):
    return {
        "name": "sensor_lag.time_constant",
        "true": true,
        "found": found,
        "interval": interval,
        "bound": bound,
    }


def test_value_errors_and_coverage():
    results = [
        result(values=[value(0.011, [0.009, 0.013])]),
        result(values=[value(0.013, [0.012, 0.014])]),
        result(values=[value(None, None)]),
        result(values=[value(0.9, [0.8, 1.0])], right=False),
    ]
    (errors,) = tally.value_errors(results)
    assert (errors["trials"], errors["given"]) == (3, 2)
    assert errors["median_error"] == pytest.approx(0.2)
    assert (errors["coverage"].count, errors["coverage"].total) == (1, 2)


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"failure": "it crashed"}, "it crashed"),
        ({"false_alarm": True}, "an effect claimed where there is none"),
        ({"tied": True, "named": ["input_delay"]}, "another of the explanations that it reports as equal"),
        ({"named": [], "verdict": "parameter_drift"}, "taken for drift"),
        ({"named": [], "verdict": "consistent"}, "not found"),
        ({"named": ["backlash"]}, "missed sensor_lag; added backlash"),
        ({"named": ["backlash", "sensor_lag"]}, "missed nothing; added backlash"),
        ({"verdict": "unexplained"}, "verdict unexplained for missing_physics"),
        ({}, "its exact tie is not in the answer"),
        (
            {
                "kind": "outside",
                "expected": "unexplained",
                "concealed": ["detent"],
                "named": ["cogging_torque"],
            },
            "explained by what the catalogue offers",
        ),
    ],
)
def test_a_failure_is_given_its_reason(changes, reason):
    assert tally.reason(result(**changes)) == reason


@pytest.mark.parametrize(
    ("changes", "answer"),
    [
        ({}, "sensor_lag"),
        ({"named": [], "verdict": "consistent"}, "consistent"),
        ({"verdict": "unexplained"}, "unexplained (sensor_lag)"),
        ({"failure": "it crashed"}, "no answer"),
    ],
)
def test_answers_in_words(changes, answer):
    assert tally.answered(result(**changes)) == answer


def test_confusion_names_what_lay_outside():
    outside = result(kind="outside", concealed=["detent"], verdict="unexplained", named=[])
    counted = tally.confusion([outside, outside, result()])
    assert counted == {"outside: detent": {"unexplained": 2}, "sensor_lag": {"sensor_lag": 1}}


def test_only_what_applies_is_counted():
    results = [
        result(windows=0.9),
        result(windows=0.5),
        result(windows=None),
        result(windows=0.1, right=False),
    ]
    counted = tally.share(results, tally.windows_right)
    assert (counted.count, counted.total) == (1, 2)
    assert tally.unseen_right(result(kind="outside")) is None
    assert tally.values_right(result(values=[value(0.01, None, bound=0.2)])) is None
