"""What the first part of a recording is, and when it does not show what is left to explain."""

import numpy as np
import pytest
from support.recordings import NOMINAL, data_on, recording

from pierburg_ros.diagnosis.search.scored import estimator_beside
from pierburg_ros.estimation.data import FIRST_PART
from pierburg_ros.estimation.discrepancy import SPAN, Discrepancy
from pierburg_ros.estimation.estimator import Estimator
from pierburg_ros.estimation.first_part import takes_time, where_shown
from pierburg_ros.inference.explanation import Explanation, Variant

CHANGED = {"spring_preload": 0.3}


def test_it_is_as_long_as_the_actuator_is_slow_and_no_longer_than_the_recording() -> None:
    for duration, expected in ((40.0, FIRST_PART * NOMINAL.scales.time), (6.0, 6.0)):
        whole = Estimator(data_on(recording({}, duration=duration)), NOMINAL)
        (run,) = whole.first_part.data.runs
        assert run.time[-1] - run.time[0] == pytest.approx(expected, abs=0.01)


def test_a_discrepancy_counts_there_as_in_the_whole() -> None:
    """But for the last samples, whose movement is measured without those that follow."""
    data = data_on(recording(CHANGED, duration=40.0))
    beside = estimator_beside(data, NOMINAL, Discrepancy(3.0, 1.0, 100.0))
    first, base = beside.first_part, beside.at(Explanation())
    there = first.restated(base).solution.residual[:-SPAN]
    np.testing.assert_allclose(there, base.solution.residual[: there.size], rtol=1e-9)


def test_an_error_that_comes_later_is_shown_by_whole_recordings_only() -> None:
    late = {"external_load.torque": 0.05, "external_load.start": 30.0, "external_load.end": 36.0}
    for changes, shows_late in ((CHANGED, False), (late, True)):
        whole = Estimator(data_on(recording(changes, duration=40.0)), NOMINAL)
        first, base = whole.first_part, whole.at(Explanation())
        estimator, there = where_shown(base, whole)
        assert estimator is (whole if shows_late else first)
        assert there.solution.residual.size == np.count_nonzero(estimator.data.train)


def test_heat_and_what_begins_at_a_moment_take_time() -> None:
    assert takes_time(Variant("thermal_resistance", ("thermal_resistance", "heat_capacity")))
    assert takes_time(Variant("external_load", ("torque", "start", "end")))
    assert not takes_time(Variant("cogging_torque", ("amplitude", "periods_per_motor_revolution", "phase")))
