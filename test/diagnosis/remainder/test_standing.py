"""Parameters that are told beside what remains, held against the nominal model and against all re-estimated."""

from dataclasses import replace

import pytest
from support.fits import found_among, made_up
from support.recordings import NOMINAL, data_on, recording

from pierburg_ros.deadline import Deadline, OutOfTime
from pierburg_ros.diagnosis.remainder import standing as module
from pierburg_ros.diagnosis.remainder.standing import _outdone, standing
from pierburg_ros.diagnosis.search.found import Found
from pierburg_ros.diagnosis.search.scored import scored
from pierburg_ros.diagnosis.search.supported import Beside
from pierburg_ros.diagnosis.search.weighing import Supported, Weight
from pierburg_ros.inference.explanation import Explanation, Variant

STIFFER = {"spring_stiffness": 0.17}
TRUE = made_up(Explanation(tuple(STIFFER)), 1.0, NOMINAL.with_values(STIFFER))
SLACK = made_up(Explanation(("torque_constant",)), 3.0, NOMINAL.with_values({"torque_constant": 0.001}))
"""A motor that hardly turns the shaft: what it leaves is one smooth remainder."""


@pytest.fixture
def found() -> Found:
    """A search of a valve with a stiffer spring; all parameters re-estimated find it."""
    data = data_on(recording(STIFFER, duration=5.0))
    return replace(found_among(data, TRUE, made_up(Explanation(), 5.0, NOMINAL)), recalibrated=TRUE)


def told(found: Found, fit) -> Supported:
    return Supported(NOMINAL, scored(found.data, fit), {})


def test_a_number_that_samples_that_validate_refute_is_outdone(found):
    assert _outdone(told(found, SLACK), found)


def test_the_true_number_alone_stands_beside_all_re_estimated(found):
    assert not _outdone(told(found, TRUE), found)


def test_a_number_that_helps_does_not_stand_where_all_re_estimated_help_more(found):
    half = made_up(Explanation(tuple(STIFFER)), 2.0, NOMINAL.with_values({"spring_stiffness": 0.155}))
    assert _outdone(told(found, half), found)
    assert not _outdone(told(found, half), replace(found, recalibrated=half))


def test_effects_are_judged_by_other_rules(found):
    lag = Variant("sensor_lag", ("time_constant",))
    slack = replace(SLACK, explanation=SLACK.explanation.plus(lag))
    assert not _outdone(told(found, slack), found)


def test_what_is_confirmed_is_told_though_no_time_is_left_to_weigh_the_rest(found, monkeypatch):
    """An explanation of nine quantities may take all of it."""
    lag = Variant("sensor_lag", ("time_constant",))
    fit = found.estimator.at(Explanation((), (lag,)), {"sensor_lag.time_constant": 0.012})
    likely = scored(found.data, fit)
    confirmed = Supported(NOMINAL, likely, {lag: Weight(500.0, 100.0)})
    beside = Beside(likely, 1000.0, confirmed)

    def endless(*_: object) -> None:
        raise OutOfTime

    monkeypatch.setattr(module, "likelier", endless)
    monkeypatch.setattr(module, "told_apart", lambda named, *_: named)
    deadline = Deadline(60.0)
    stood = standing(replace(found, beside=beside), deadline=deadline)
    assert stood.base is not None and stood.base.explanation.effects == ("sensor_lag",)
    assert deadline.stopped
