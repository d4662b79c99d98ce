"""Messages back in the order of their sending, and the simulated time of each."""

import math

from hypothesis import given
from hypothesis import strategies as st

from pierburg_ros.nodes.core.source_order import SimulatedTime, SourceOrder


@given(st.lists(st.integers(0, 10**12)))
def test_all_come_out_in_order_of_sending(sent):
    order = SourceOrder(0.1)
    for place, time in enumerate(sent):
        order.put(time, (time, place))
    assert order.until(math.inf) == sorted((time, place) for place, time in enumerate(sent))


def test_an_item_is_held_back_for_the_horizon():
    order = SourceOrder(0.1)
    order.put(1_000_000_000, "late")
    order.put(900_000_000, "early")
    assert order.due(1_000_000_000) == ["early"]
    assert order.due(1_099_999_999) == []
    assert order.due(1_100_000_000) == ["late"]


def test_the_clock_in_force_at_the_sending():
    time = SimulatedTime()
    assert time.at(5) is None
    time.reading(10, 2_000_000)
    time.reading(20, 4_000_000)
    assert time.at(5) is None
    assert [time.at(sent) for sent in (10, 19)] == [2_000_000] * 2
    assert [time.at(sent) for sent in (20, 99)] == [4_000_000] * 2


def test_after_a_stall_topics_that_arrive_one_after_another_come_out_in_order():
    order = SourceOrder(0.1)
    second = 1_000_000_000
    for sent in range(0, 5 * second, second):
        order.put(sent, ("first", sent), 5 * second)
    assert order.due(5 * second) == []
    for sent in range(0, 5 * second, second):
        order.put(sent, ("second", sent), 5 * second + second // 5)
    expected = [(topic, sent) for sent in range(0, 5 * second, second) for topic in ("first", "second")]
    assert order.due(8 * second) == expected


def test_the_past_of_a_latched_topic_holds_nothing_up():
    order = SourceOrder(0.1)
    order.put(0, "an hour ago", 3600 * 1_000_000_000)
    assert order.due(3600 * 1_000_000_000) == ["an hour ago"]
