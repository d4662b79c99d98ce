"""Stretches that lengthen lead to values at which a descent on whole recordings does not arrive."""

import itertools

from recordings import NOMINAL, PIERBURG, recording

from pierburg_ros.diagnosis.evidence_data import evidence_of
from pierburg_ros.diagnosis.explanation import Explanation, Variant
from pierburg_ros.diagnosis.search import Search
from pierburg_ros.diagnosis.shooting import unstuck

STICTION = Explanation((), (Variant("static_friction", ("breakaway_torque", "stribeck_velocity")),))


def test_most_poor_starts_of_static_friction_reach_the_noise() -> None:
    """A slip at the wrong moment displaces all that follows until the shaft meets a stop."""
    truth = {"static_friction.breakaway_torque": 0.27, "static_friction.stribeck_velocity": 0.1}
    search = Search(evidence_of([recording(truth, duration=60.0)], PIERBURG), NOMINAL)
    grid = itertools.product((0.23, 0.25, 0.26, 0.28, 0.3, 0.33), (0.04, 0.12, 0.2))
    starts = [dict(zip(truth, values, strict=True)) for values in grid]
    plain = [search.fit(STICTION, start).ratio < 1.03 for start in starts]
    other = [unstuck(search, STICTION, start, 8).ratio < 1.03 for start in starts]
    assert sum(plain) <= 7
    assert sum(other) >= 10


def test_a_load_goes_by_the_clock_and_is_still_fitted() -> None:
    truth = {"external_load.torque": 0.04, "external_load.start": 6.0, "external_load.end": 15.0}
    search = Search(evidence_of([recording(truth)], PIERBURG), NOMINAL)
    load = Explanation((), (Variant("external_load", ("torque", "start", "end")),))
    found = unstuck(search, load, {**truth, "external_load.torque": 0.03, "external_load.start": 6.2}, 8)
    assert found.ratio < 1.05
