"""Deadlines on a grid: slept for, or skipped and counted."""

import pytest

from pierburg_ros.nodes.core.pacing import Pacer


class Clock:
    """A clock that only moves when someone sleeps or works."""

    def __init__(self):
        self.now = 0.0

    def __call__(self):
        return self.now

    def pass_by(self, seconds):
        self.now += seconds


@pytest.fixture
def clock():
    return Clock()


def test_ticks_keep_the_grid_whatever_the_work_takes(clock):
    pacer = Pacer(0.01, clock, clock.pass_by)
    ticks = []
    for work in (0.001, 0.009, 0.004, 0.0):
        pacer.wait()
        ticks.append(clock.now)
        clock.pass_by(work)
    assert ticks == pytest.approx([0.01, 0.02, 0.03, 0.04])
    assert pacer.skipped == 0


def test_a_late_tick_comes_at_once_and_whole_periods_are_skipped(clock):
    pacer = Pacer(0.01, clock, clock.pass_by)
    pacer.wait()
    clock.pass_by(0.036)  # deadlines at 0.02, 0.03 and 0.04 pass; the last is kept, late
    pacer.wait()
    assert clock.now == pytest.approx(0.046)
    assert pacer.skipped == 2
    pacer.wait()
    assert clock.now == pytest.approx(0.05)


def test_period_zero_runs_free(clock):
    pacer = Pacer(0.0, clock, clock.pass_by)
    pacer.wait()
    assert clock.now == 0.0


def test_a_restart_forgets_what_passed(clock):
    pacer = Pacer(0.01, clock, clock.pass_by)
    clock.pass_by(5.0)
    pacer.restart()
    pacer.wait()
    assert clock.now == pytest.approx(5.01)
    assert pacer.skipped == 0


def test_a_changed_period_holds_from_the_next_tick(clock):
    pacer = Pacer(0.01, clock, clock.pass_by)
    pacer.wait()
    pacer.period = 0.1
    pacer.wait()
    assert clock.now == pytest.approx(0.11)
