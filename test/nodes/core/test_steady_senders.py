"""Who keeps sending, and who is behind."""

from pierburg_ros.nodes.core.steady_senders import STEADY, SteadySenders

SECOND = 10**9


def heard(*sent):
    """Of one sender with messages sent at these times [ns]."""
    senders = SteadySenders()
    for time in sent:
        senders.take(b"a", time)
    return senders


def test_a_steady_sender_is_behind_until_something_comes_that_was_sent_later():
    senders = heard(*(k * SECOND // 100 for k in range(STEADY)))
    assert senders.behind({b"a"}, 5 * SECOND) == {b"a"}
    senders.take(b"a", 6 * SECOND)
    assert senders.behind({b"a"}, 5 * SECOND) == set()


def test_who_sends_seldom_or_is_gone_is_not_waited_for():
    assert heard(*(k * SECOND for k in range(STEADY))).behind({b"a"}, 100 * SECOND) == set()
    assert heard(1, 2, 3).behind({b"a"}, 100 * SECOND) == set()
    assert heard(*range(STEADY)).behind(set(), 100 * SECOND) == set()
