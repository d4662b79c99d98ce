"""A deadline: work ends with what it has, by the clock or by Ctrl-C, and what is left of the time is none."""

import math
import threading

import pytest

from pierburg_ros.deadline import Deadline, OutOfTime
from pierburg_ros.workers import PACE, cores, pace, workers


def interrupted():
    raise KeyboardInterrupt


def test_without_a_limit_work_ends_as_it_does():
    deadline = Deadline()
    assert deadline.attempt(lambda: 5, otherwise=0) == 5
    assert math.isinf(deadline.left) and not deadline.stopped
    deadline.check()


def test_once_the_time_is_over_nothing_is_begun():
    deadline = Deadline(0.0)
    assert deadline.attempt(pytest.fail, otherwise=7) == 7
    assert deadline.stopped
    with pytest.raises(OutOfTime):
        deadline.check()


def test_ctrl_c_ends_the_work_and_all_that_would_follow():
    deadline = Deadline(1000.0)
    assert deadline.part(0.5).attempt(interrupted, otherwise=1) == 1
    assert deadline.stopped and deadline.left == 0.0
    assert deadline.attempt(pytest.fail, otherwise=2) == 2


def test_a_part_that_is_over_leaves_time_for_the_rest():
    deadline = Deadline(1000.0)
    part = deadline.part(0.0)
    assert part.attempt(pytest.fail, otherwise=1) == 1
    assert deadline.stopped and deadline.attempt(lambda: 3, otherwise=0) == 3


def test_what_can_be_left_undone_is_not_noted_when_its_own_time_is_over():
    for seconds, left, noted in ((0.0, 1000.0, False), (1000.0, 0.0, True)):
        deadline = Deadline(left)
        assert deadline.at_most(seconds).attempt(pytest.fail, otherwise=1) == 1
        assert deadline.stopped == noted
    assert math.isinf(Deadline().at_most(1.0).left)


def test_an_interrupt_of_what_can_be_left_undone_is_noted():
    deadline = Deadline(1000.0)
    assert deadline.at_most(10.0).attempt(interrupted, otherwise=1) == 1
    assert deadline.stopped and deadline.left == 0.0


def test_who_waits_for_workers_waits_no_longer_than_that():
    release = threading.Event()
    """Nor where nothing works: the time that has gone by counts too, if less."""
    deadline = Deadline(0.05)

    def work():
        with workers(1, deadline) as pool:
            return list(pool.map(lambda _: release.wait(600.0), range(3)))

    assert deadline.attempt(work, otherwise=None) is None
    release.set()


@pytest.fixture
def now(monkeypatch):
    """Clock and processor time as told."""
    told = {"clock": 0.0, "work": 0.0}
    monkeypatch.setattr("pierburg_ros.deadline.time.monotonic", lambda: told["clock"])
    monkeypatch.setattr("pierburg_ros.deadline.time.process_time", lambda: told["work"])
    return told


def test_time_in_which_others_work_counts_less(now):
    """Ten seconds of work on a machine that gives a half of a core, and on one that gives next to nothing."""
    deadline = Deadline(10.0)
    now.update(clock=19.0, work=9.5)
    assert deadline.left == pytest.approx(0.5)
    now.update(clock=21.0, work=10.5)
    assert deadline.left == 0.0
    now.update(clock=49.0, work=1.0)
    assert deadline.left == pytest.approx(0.2)
    now.update(clock=51.0, work=1.0)
    assert deadline.left == 0.0


def test_what_works_on_two_cores_may_do_as_much_on_a_busy_machine(now):
    """Parts of it too: on an idle machine 15 s of work take 10 s."""
    deadline = Deadline(10.0, pace=1.5)
    now.update(clock=20.0, work=12.0)
    assert deadline.left == pytest.approx(2.0)
    part = deadline.part(0.5)
    now.update(clock=22.0, work=12.75)
    assert part.left == pytest.approx(0.5)


def test_one_job_at_a_time_has_the_pace_of_one():
    assert pace(1) == 1.0
    assert pace(2) == (PACE if cores() > 1 else 1.0)


def test_two_cores_do_not_halve_the_time(now):
    deadline = Deadline(10.0)
    now.update(clock=8.0, work=16.0)
    assert deadline.left == pytest.approx(2.0)
