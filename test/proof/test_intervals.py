"""Wilson's interval against published values and its own defining equation."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pierburg_ros.proof.intervals import NORMAL_95, Share


@pytest.mark.parametrize(
    ("count", "total", "low", "high"),
    [
        (81, 263, 0.2553, 0.3662),  # Newcombe, Statistics in Medicine 17 (1998) 857-872, table I
        (15, 148, 0.0624, 0.1605),
        (0, 20, 0.0000, 0.1611),
        (1, 29, 0.0061, 0.1718),
    ],
)
def test_published_intervals(count, total, low, high):
    assert Share(count, total).interval == (pytest.approx(low, abs=5e-5), pytest.approx(high, abs=5e-5))


@given(st.integers(1, 500).flatmap(lambda total: st.tuples(st.integers(0, total), st.just(total))))
def test_each_end_is_a_share_from_which_the_count_lies_196_deviations(drawn):
    count, total = drawn
    for end in Share(count, total).interval:
        if 1e-9 < end < 1.0 - 1e-9:
            deviation = (end * (1 - end) / total) ** 0.5
            assert abs(count / total - end) == pytest.approx(NORMAL_95 * deviation, rel=1e-6)


def test_nothing_counted_says_so():
    assert Share(0, 0).value is None
    assert Share(0, 0).interval == (0.0, 1.0)
    assert str(Share(0, 0)) == "n = 0"


def test_a_share_is_written_with_its_interval():
    assert str(Share(19, 20)) == "19/20 (76 to 99 %)"


@pytest.mark.parametrize("total", range(1, 500))
def test_the_share_itself_lies_within(total):
    """Rounding takes an end past it where all, or none, were counted."""
    for count in (0, total):
        low, high = Share(count, total).interval
        assert low <= count / total <= high
