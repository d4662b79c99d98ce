"""Who may send duties: every order of starting, ending and dying."""

import pytest

from pierburg_ros.nodes.core.precedence import SETTLE, SILENT, TIE, Precedence

NOW = 100.0


@pytest.fixture
def alone():
    """A controller that has been sending for long."""
    place = Precedence(NOW)
    assert place.may_send(NOW + SETTLE, set(), "", False)
    assert place.may_send(NOW + SETTLE + TIE, set(), "b", True)
    return place


def test_nothing_is_sent_before_the_graph_is_known():
    place = Precedence(NOW)
    assert not place.may_send(NOW + 0.5 * SETTLE, set(), "", True)
    assert place.may_send(NOW + SETTLE, set(), "", True)


def test_the_later_one_stays_passive_and_takes_over_when_the_other_is_gone():
    place = Precedence(NOW)
    for step in range(100):
        place.heard(NOW + 0.1 * step)
        assert not place.may_send(NOW + 0.1 * step, {"a"}, "", True)
    assert place.may_send(NOW + 10.1, set(), "", True)


def test_the_first_one_goes_on_whatever_comes_later(alone):
    assert all(alone.may_send(NOW + 20.0 + step, {"a"}, "b", True) for step in range(10))
    assert alone.rivals == {"a"}


def test_of_two_that_began_together_one_gives_way():
    first, second = Precedence(NOW), Precedence(NOW)
    assert first.may_send(NOW + SETTLE, set(), "", True)
    assert second.may_send(NOW + SETTLE, set(), "", True)
    assert first.may_send(NOW + SETTLE + 0.3, {"b"}, "a", True)
    assert not second.may_send(NOW + SETTLE + 0.3, {"a"}, "b", True)


def test_a_dead_rival_still_on_the_graph_is_passed_over_for_good():
    place = Precedence(NOW)
    assert not place.may_send(NOW + SILENT - 0.1, {"a"}, "", True)
    assert place.may_send(NOW + SILENT + 0.1, {"a"}, "", True)
    assert place.may_send(NOW + SILENT + 0.2, {"a"}, "b", True)
    assert place.rivals == set()


def test_without_samples_a_silent_rival_is_not_taken_for_dead():
    place = Precedence(NOW)
    assert not place.may_send(NOW + 10.0 * SILENT, {"a"}, "", False)
