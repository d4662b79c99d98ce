"""When the source of simulated time waits for a recorder, and when it does not any more."""

from pierburg_ros.nodes.core.follower import RECORDER_PATIENCE, TICKS_AHEAD, Follower

PERIOD = 2_000_000


def follower():
    """A follower with a clock that a test moves."""
    clock = [0.0]
    return Follower(lambda: clock[0]), clock


def test_nothing_is_waited_for_until_a_recorder_has_spoken():
    found, _ = follower()
    assert not found.must_wait(10**12, PERIOD)


def test_the_source_waits_at_the_limit_and_goes_on_when_the_recorder_has_moved():
    found, _ = follower()
    found.progress(PERIOD)
    assert not found.must_wait(PERIOD + TICKS_AHEAD * PERIOD, PERIOD)
    assert found.must_wait(2 * PERIOD + TICKS_AHEAD * PERIOD, PERIOD)
    found.progress(2 * PERIOD)
    assert not found.must_wait(2 * PERIOD + TICKS_AHEAD * PERIOD, PERIOD)


def test_a_recorder_that_stays_where_it_is_is_given_up_and_followed_again_when_it_has_caught_up():
    found, clock = follower()
    found.progress(PERIOD)
    far = 2 * PERIOD + TICKS_AHEAD * PERIOD
    assert found.must_wait(far, PERIOD)
    clock[0] = RECORDER_PATIENCE + 0.1
    found.progress(PERIOD)
    assert not found.must_wait(far, PERIOD)
    assert found.given_up
    found.progress(far)
    assert not found.must_wait(far, PERIOD)
    assert not found.given_up
    assert found.must_wait(far + (TICKS_AHEAD + 1) * PERIOD, PERIOD)


def test_a_slow_recorder_is_waited_for_however_long_it_takes():
    found, clock = follower()
    now = (2 * TICKS_AHEAD + 10) * PERIOD
    for tick in range(1, 100):
        found.progress(tick * PERIOD)
        clock[0] += RECORDER_PATIENCE / 2
        assert found.must_wait(now, PERIOD)


def test_time_that_begins_again_is_not_waited_for():
    found, _ = follower()
    found.progress(5000 * PERIOD)
    assert not found.must_wait(PERIOD, PERIOD)
