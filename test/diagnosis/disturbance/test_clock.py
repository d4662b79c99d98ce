"""An input that is stamped by another clock is told from the motion, and a delay is none."""

from dataclasses import replace

import numpy as np
import pytest
from support.recordings import NOMINAL, data_on, recording

from pierburg_ros.diagnosis.disturbance import clock as clocks
from pierburg_ros.diagnosis.disturbance.apart import with_other_clock
from pierburg_ros.diagnosis.disturbance.clock import OtherClock, other_clock
from pierburg_ros.diagnosis.disturbance.moments import exact
from pierburg_ros.estimation.estimator import Estimator
from pierburg_ros.estimation.likelihood import EXPLAINED
from pierburg_ros.inference.explanation import Explanation
from pierburg_ros.recording import Channel

ONE = recording({})
FIRST, LAST = float(ONE.time[0]), float(ONE.time[-1])


def stamped(at_first, at_last, given=ONE):
    """`given` with its duty stamped late by `at_first` [s] at the beginning and `at_last` in the end."""
    time = given.command.time
    late = at_first + (at_last - at_first) * (time - FIRST) / (LAST - FIRST)
    return replace(given, command=Channel(time + late, given.command.values))


@pytest.mark.parametrize(("at_first", "at_last"), [(0.02, 0.02), (0.0, 0.12), (0.0, -0.1), (0.03, -0.05)])
def test_a_duty_by_another_clock_is_told_to_a_part_of_a_sample(at_first, at_last):
    given = stamped(at_first, at_last)
    data = data_on(given)
    clock = other_clock(data, NOMINAL)
    assert (clock.at_first, clock.at_last) == pytest.approx((at_first, at_last), abs=1e-3)
    left = data_on(clock.known(given)).residual(NOMINAL)
    assert np.sqrt(np.mean(left**2)) < EXPLAINED < np.sqrt(np.mean(data.residual(NOMINAL) ** 2))


@pytest.mark.parametrize(
    "changes", [{}, {"input_delay.delay": 0.03}, {"sensor_lag.time_constant": 0.02}, {"coulomb_friction": 0.3}], ids=str
)
def test_physics_is_no_other_clock(changes):
    assert other_clock(data_on(recording(changes)), NOMINAL) is None


@pytest.mark.parametrize("duration", [0.05, 1.0])
def test_a_recording_may_be_shorter_than_sixteen_of_the_actuators_own_times(duration):
    data = data_on(recording({}, duration=duration))
    assert duration < 16 * data.scales.time
    assert other_clock(data, NOMINAL, alone=True) is None


def test_the_true_times_undo_the_stamps():
    given = stamped(0.02, 0.12)
    known = OtherClock(FIRST, LAST, 0.02, 0.12).known(given)
    assert np.allclose(known.command.time, ONE.command.time, atol=1e-3)
    assert np.array_equal(known.command.values, ONE.command.values)


def test_what_was_logged_of_the_drive_moves_with_the_input():
    """As it does while the times are looked for."""
    duty = ONE.command
    moved = OtherClock(FIRST, LAST, 0.02, 0.12).known(
        replace(ONE, supply_voltage=Channel(duty.time, 12.0 + duty.values), enabled=None)
    )
    assert np.array_equal(moved.supply_voltage.time, moved.command.time) and moved.enabled is None


def test_alone_it_is_told_at_once_and_not_beside_missing_physics(monkeypatch):
    whole = []
    monkeypatch.setattr(clocks, "exact", lambda cost, *rest: whole.append(cost) or exact(cost, *rest))
    assert other_clock(data_on(stamped(0.0, 0.1)), NOMINAL, alone=True).at_last == pytest.approx(0.1, abs=1e-3)
    parts = len(whole)
    lacking = stamped(0.0, 0.1, recording({"spring_stiffness": 0.3}))
    assert other_clock(data_on(lacking), NOMINAL, alone=True) is None
    assert len(whole) - parts < parts


def test_what_is_lacking_beside_it_is_asked_for():
    """The clock is set apart beside an explanation that lacks nothing else, and the explanation is fitted again."""
    given = stamped(0.0, 0.1, recording({"spring_stiffness": 0.3}))
    data = data_on(given)
    estimator, drifted = Estimator(data, NOMINAL), Explanation(("spring_stiffness",))
    fit = estimator.fit(drifted, forgiving=True)
    told = with_other_clock(data, estimator, fit, given)
    assert "stamped by another clock" in told.remarks[-1]
    assert Estimator(told, NOMINAL).fit(drifted, fit.values).values["spring_stiffness"] == pytest.approx(0.3, rel=0.01)
    assert with_other_clock(data, estimator, estimator.at(Explanation()), given) is None
