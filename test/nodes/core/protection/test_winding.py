"""Heat of a winding: the closed form of I^2 t, the limit, the switching off and the cooling."""

import math

import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.nodes.core.protection.limits import limits_of
from pierburg_ros.nodes.core.protection.winding import LIMITED_FOR, Winding

LIMITS = limits_of(read_actuator("pierburg"))
PERIOD = 0.002


@pytest.fixture
def winding():
    return Winding(LIMITS, LIMITS.rated_current, 20.0)


def stalled(winding, duty, seconds, speed=0.0):
    """Duties borne, tick by tick, while `duty` is wanted of a blocked shaft."""
    borne = [0.0]
    for _ in range(round(seconds / PERIOD)):
        winding.warm(winding.current(borne[-1], speed), PERIOD)
        borne.append(winding.borne(duty, speed))
    return borne


def limited_at(duties):
    """Time [s] of the first duty that is less than the one wanted."""
    return next(k for k, duty in enumerate(duties) if k > 1 and duty < duties[1]) * PERIOD


@pytest.mark.parametrize("duty", [1.0, 0.8, 0.5, -1.0])
def test_a_stall_is_limited_when_the_closed_form_says_so(winding, duty):
    ratio = duty * 13.5 / 4.139 / (13.5 / 4.139 / 3.0)
    expected = -20.0 * math.log(1.0 - 1.0 / ratio**2)
    duties = [abs(each) for each in stalled(winding, duty, 15.0)]
    assert limited_at(duties) == pytest.approx(expected, abs=2 * PERIOD)


def test_the_steps_do_not_matter():
    fine, coarse = Winding(LIMITS, 1.0, 20.0), Winding(LIMITS, 1.0, 20.0)
    for _ in range(1000):
        fine.warm(0.9, 0.003)
    coarse.warm(0.9, 3.0)
    assert fine.heat == pytest.approx(coarse.heat, rel=1e-9)
    assert coarse.heat == pytest.approx(0.81 * (1.0 - math.exp(-0.15)))


def test_full_duty_against_a_stop_for_30_s_is_limited_and_then_ended(winding):
    duties = stalled(winding, 1.0, 30.0)
    guarded = duties[round(2.5 / PERIOD) : round(26.0 / PERIOD)]
    assert max(winding.current(duty, 0.0) for duty in guarded) <= 1.01 * LIMITS.rated_current
    assert duties[round((2.5 + LIMITED_FOR) / PERIOD)] == 0.0
    assert winding.heat < 1.01


def test_after_cooling_it_may_be_used_again(winding):
    duties = stalled(winding, 1.0, 30.0)
    off = [k for k, duty in enumerate(duties) if k > 0 and duty == 0.0]
    assert off[-1] - off[0] == len(off) - 1
    assert off[-1] * PERIOD == pytest.approx(2.36 + LIMITED_FOR + 20.0 * math.log(2.0), abs=0.3)


def test_below_a_third_of_the_stall_current_nothing_is_ever_limited(winding):
    assert set(stalled(winding, 0.33, 200.0)[1:]) == {0.33}


def test_a_turning_motor_draws_less_and_is_not_limited(winding):
    free = 13.5 / LIMITS.torque_constant - 0.7 * LIMITS.resistance / LIMITS.torque_constant
    assert set(stalled(winding, 1.0, 60.0, speed=free)[1:]) == {1.0}


def test_braking_is_always_borne(winding):
    stalled(winding, 1.0, 3.0)
    assert winding.limited
    assert winding.borne(0.0, 10.0) == 0.0
    assert winding.borne(0.0, -10.0) == 0.0


def test_a_time_constant_of_0_switches_it_off():
    winding = Winding(LIMITS, LIMITS.rated_current, 0.0)
    assert set(stalled(winding, 1.0, 60.0)[1:]) == {1.0}
