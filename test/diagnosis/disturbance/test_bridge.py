"""A bridge that was open is told from the motion: from when to when, and only where that explains it."""

from dataclasses import replace

import numpy as np
import pytest
from support.recordings import NOISE, NOMINAL, data_on, recording

from pierburg_ros.diagnosis.disturbance.bridge import OpenBridge, opened
from pierburg_ros.inference.data import inputs_of
from pierburg_ros.plant import simulate

ONE = recording({})
NOISES = NOISE * np.random.default_rng(6).standard_normal(ONE.time.size)


def open_between(start, end, model=NOMINAL):
    """ONE as a valve makes it without a current from `start` to `end` [s]; the rows of its duty are made dense."""
    given = inputs_of(ONE)
    time = np.unique(np.concatenate([given.time, [start, end]]))
    place = np.searchsorted(given.time, time, side="right") - 1
    inputs = replace(given, time=time, command=given.command[place], enabled=(time < start) | (time >= end))
    return replace(ONE, measured=simulate(model, inputs, ONE.time) + NOISES)


@pytest.mark.parametrize(("start", "end"), [(9.0, 12.0), (7.3217, 8.1), (4.01, 9.015)])
def test_when_it_was_open_is_told_as_far_as_it_shows(start, end):
    given = open_between(start, end)
    data = data_on(given)
    missed = np.flatnonzero(np.abs(data.residual(NOMINAL)) > 6.0)
    shown = float(ONE.time[missed[0]]), float(ONE.time[missed[-1]])
    bridge = opened(data, NOMINAL, shown)
    left = replace(data, runs=tuple(bridge.applied(run) for run in data.runs)).residual(NOMINAL)
    assert np.sqrt(np.mean(left**2)) < 1.03
    assert bridge.start < shown[1] and bridge.end > shown[0]


def test_what_is_told_is_what_a_log_would_have_said():
    bridge = OpenBridge(9.0, 12.0)
    known = bridge.known(ONE)
    assert known.enabled.at(np.array([0.0, 8.99, 9.0, 11.99, 12.0, 20.0])).tolist() == [1, 1, 0, 0, 1, 1]
    (run,) = data_on(ONE).runs
    as_logged, applied = (each.simulated(NOMINAL) for each in (data_on(known).runs[0], bridge.applied(run)))
    assert np.array_equal(as_logged, applied)
    assert "from 9 to 12 s" in bridge.remark


@pytest.mark.parametrize(
    "changes",
    [
        {"external_load.torque": 0.1, "external_load.start": 9.0, "external_load.end": 12.0},
        {"external_load.torque": -0.1, "external_load.start": 9.0, "external_load.end": 12.0},
        {"coulomb_friction": 0.3},
    ],
    ids=str,
)
def test_a_load_or_a_drift_is_no_open_bridge(changes):
    assert opened(data_on(recording(changes)), NOMINAL, (9.0, 12.0)) is None
