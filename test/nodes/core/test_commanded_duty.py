"""Which duty is in force: the newest usable one, for as long as its sender is heard."""

import math

import pytest

from pierburg_ros.errors import InputError
from pierburg_ros.nodes.core.commanded_duty import CommandedDuty

MILLISECOND = 1_000_000


def test_no_duty_is_zero():
    assert CommandedDuty().at(0, 0.05) == 0.0


def test_the_newest_duty_holds_until_the_timeout():
    duty = CommandedDuty()
    duty.offer(0.2)
    duty.offer(0.3)
    assert duty.at(0, 0.05) == 0.3
    assert duty.at(50 * MILLISECOND, 0.05) == 0.3
    assert duty.at(51 * MILLISECOND, 0.05) == 0.0
    assert duty.lost(51 * MILLISECOND, 0.05)


def test_a_new_duty_ends_the_timeout():
    duty = CommandedDuty()
    duty.offer(0.2)
    duty.at(0, 0.05)
    duty.offer(-0.4)
    assert duty.at(1000 * MILLISECOND, 0.05) == -0.4
    assert not duty.lost(1000 * MILLISECOND, 0.05)


def test_timeout_zero_holds_for_ever():
    duty = CommandedDuty()
    duty.offer(0.2)
    duty.at(0, 0.0)
    assert duty.at(10**15, 0.0) == 0.2


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_a_duty_that_is_not_finite_leaves_the_previous_one(value):
    duty = CommandedDuty()
    duty.offer(0.2)
    with pytest.raises(InputError, match="not finite"):
        duty.offer(value)
    assert duty.at(0, 0.05) == 0.2


@pytest.mark.parametrize(("value", "clipped"), [(1.5, 1.0), (-7.0, -1.0)])
def test_a_duty_beyond_one_is_clipped_and_said_so(value, clipped):
    duty = CommandedDuty()
    assert duty.offer(value) is False
    assert duty.at(0, 0.05) == clipped


def test_the_limits_themselves_are_not_clipped():
    duty = CommandedDuty()
    assert duty.offer(1.0)
    assert duty.offer(-1.0)
