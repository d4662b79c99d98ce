"""Numbers as people read them."""

import pytest

from pierburg_ros.pages.numbers import confidence, interval, percent, value, words


@pytest.mark.parametrize(
    ("middle", "ends", "shown"),
    [
        (4.54985, (4.54968, 4.55015), "4.54985 (4.54968 to 4.55015)"),
        (0.27, (0.2658, 0.2703), "0.2700 (0.2658 to 0.2703)"),
        (0.0, (-0.5, 0.5), "0.0 (-0.5 to 0.5)"),
        (2.5407, (0.1, 17.2), "2.54 (0 to 17)"),
        (-0.00364, (-0.09, 0.08), "-0.00364 (-0.09 to 0.08)"),
        (123456.0, (120000.0, 130000.0), "123456 (120000 to 130000)"),
        (2.46e-6, (2.4e-6, 2.5e-6), "2.46e-06 (2.40e-06 to 2.50e-06)"),
        (4.55, (4.55, 4.55), "4.55 (4.55 to 4.55)"),
    ],
)
def test_an_interval_has_digits_enough_to_tell_its_ends_apart(middle, ends, shown):
    assert f"{value(middle, ends)} ({interval(ends)})" == shown


def test_what_does_not_exist_is_a_dash():
    assert (interval(None), value(None), percent(None)) == ("-", "-", "-")


@pytest.mark.parametrize(
    ("share", "shown"), [(0.0, "0 %"), (0.0001, "below 0.1 %"), (0.012, "1.2 %"), (0.0996, "10 %"), (1.0, "100 %")]
)
def test_small_shares_keep_a_digit(share, shown):
    assert percent(share) == shown


def test_nothing_is_sure():
    assert (confidence(1.0), confidence(0.973)) == ("above 0.999", "0.973")


def test_names_are_words():
    assert words("spring_preload@time+backlash.gap") == "spring preload (changes) + backlash: gap"
