"""Lost messages counted from the numbers of their publishers."""

from hypothesis import given
from hypothesis import strategies as st

from pierburg_ros.nodes.core.numbering import Numbering


@given(st.integers(1, 50), st.sets(st.integers(1, 200)))
def test_one_publishers_losses_are_counted_to_the_message(first, lost):
    numbering = Numbering()
    sent = range(first, first + 200)
    kept = [number for number in sent if number - first not in lost or number == sent[-1]]
    for number in kept:
        numbering.take(number, 1)
    assert (numbering.received, numbering.lost) == (len(kept), kept[-1] - kept[0] + 1 - len(kept))


@given(st.lists(st.booleans(), min_size=2, max_size=100))
def test_two_publishers_whose_messages_alternate_have_lost_nothing(turns):
    numbering, next_number = Numbering(), {True: 1, False: 1001}
    for turn in turns:
        assert numbering.take(next_number[turn], 2) == 0
        next_number[turn] += 1


def test_a_publisher_that_is_started_again_counts_from_one():
    numbering = Numbering()
    assert [numbering.take(number, 1) for number in (7, 8, 1, 2, 5)] == [0, 0, 0, 0, 2]


def test_a_new_file_counts_anew_without_losing_its_place():
    numbering = Numbering()
    for number in (1, 4):
        numbering.take(number, 1)
    numbering.forget_counts()
    numbering.take(6, 1)
    assert (numbering.received, numbering.lost) == (1, 1)
