"""Lost messages counted from the numbers of their publishers."""

from hypothesis import given
from hypothesis import strategies as st

from pierburg_ros.nodes.core.numbering import Numbering


@given(st.integers(1, 50), st.sets(st.integers(1, 200)))
def test_one_publishers_losses_are_counted_to_the_message(first, lost):
    numbering = Numbering()
    sent = range(first, first + 200)
    kept = [number for number in sent if number - first not in lost or number == sent[-1]]
    missing = sum(numbering.take(b"a", number) for number in kept)
    assert missing == kept[-1] - kept[0] + 1 - len(kept)


@given(st.lists(st.tuples(st.integers(0, 4), st.integers(1, 3)), max_size=200))
def test_any_number_of_publishers_that_come_and_go_are_counted_apart(turns):
    numbering, last = Numbering(), {}
    for publisher, step in turns:
        before = last.get(publisher)
        last[publisher] = (before or 0) + step
        assert numbering.take(bytes([publisher]), last[publisher]) == (0 if before is None else step - 1)


def test_the_past_that_a_topic_repeats_is_no_loss():
    numbering = Numbering()
    assert [numbering.take(b"a", number) for number in (7, 8, 7, 8, 11)] == [0, 0, 0, 0, 2]
