"""How a search ends before everything is tried: by its budget, by a clock, or by an interrupt."""

import pytest

from pierburg_ros.budget import SIMULATIONS, Budget
from pierburg_ros.inference.fit import Effort


def test_a_budget_is_looked_at_between_steps_and_never_within_one():
    effort = Effort(Budget(2.0 / SIMULATIONS))
    with effort.interruptible():
        for _ in range(5):
            effort.count()
        assert effort.stopped_by is None and effort.over
    assert (effort.simulations, effort.stopped_by) == (5, "budget")


def test_without_a_budget_nothing_is_over():
    effort = Effort(Budget.of(None), simulations=10 * SIMULATIONS)
    assert not effort.over and effort.stopped_by is None


def test_a_clock_ends_work_that_may_be_ended():
    effort, reached = Effort(Budget(seconds=0.0)), []
    with effort.interruptible():
        effort.count()
        reached.append(1)
    assert not reached and effort.stopped_by == "clock" and effort.over


def test_a_clock_leaves_other_work_alone():
    effort = Effort(Budget(seconds=0.0))
    effort.count()
    assert effort.simulations == 1 and effort.stopped_by is None


def test_an_interrupt_ends_work_with_what_was_found_before():
    effort = Effort()
    with effort.interruptible():
        raise KeyboardInterrupt
    assert effort.stopped_by == "interrupt" and effort.over


def test_an_error_is_no_end_of_time():
    effort = Effort()
    with pytest.raises(ValueError, match="broken"), effort.interruptible():
        raise ValueError("broken")
    assert effort.stopped_by is None
