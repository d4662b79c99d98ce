"""What the shaft does, on a course that is known."""

import numpy as np
import pytest
from support.motions import drawn

from pierburg_ros.diagnosis.motion import slope

TIME = np.sort(np.random.default_rng(2).uniform(0.0, 4.0, 2000))


def test_reads_angle_velocity_and_rest():
    motion = drawn()
    assert motion.angle[:500] == pytest.approx(0.0, abs=0.005)
    assert motion.velocity[(motion.time > 2.1) & (motion.time < 2.9)] == pytest.approx(1.0, abs=0.1)
    assert motion.moving.mean() == pytest.approx(2.5 / 10.0, abs=0.02)
    assert motion.time[motion.departures] == pytest.approx([2.0, 5.0, 7.0], abs=0.03)
    assert motion.time[motion.reversals] == pytest.approx([5.0], abs=0.03)


def test_counts_time_at_rest_and_since_reversal():
    motion = drawn()

    def at(values, moment):
        return values[np.searchsorted(motion.time, moment)]

    assert at(motion.time_at_rest, 1.5) == pytest.approx(1.5, abs=0.03)
    assert at(motion.time_at_rest, 5.1) == pytest.approx(2.0, abs=0.05)
    assert at(motion.time_at_rest, 5.8) == 0.0
    assert at(motion.time_since_reversal, 6.5) == pytest.approx(1.5, abs=0.03)
    assert at(motion.stop_distance, 4.0) == pytest.approx(np.pi / 2 - 1.0, abs=0.005)


def test_knows_the_stops():
    motion = drawn()
    assert motion.closed[motion.time < 1.9].all() and motion.closed[motion.time > 7.6].all()
    assert not motion.closed[(motion.time > 2.1) & (motion.time < 7.3)].any()
    assert not motion.open.any()


def test_slope_of_a_line_is_exact_at_uneven_times():
    assert slope(TIME, 3.0 * TIME - 1.0, 0.05) == pytest.approx(3.0)
