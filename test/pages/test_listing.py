"""Rows on a terminal of any width: whole words, no frame broken, nothing cut."""

import io

import pytest
from rich.console import Console

from pierburg_ros.pages.listing import Listing, widths

ROWS = [
    ("cogging_torque.periods_per_motor_revolution", "6", "5.9 to 6.1", "nothing"),
    ("armature_resistance", "4.71 ohm", "not identifiable", "torque constant with spring stiffness; or [rad] viscous"),
]
LISTING = Listing(("what", "value [rad]", "95 %", "cannot be told from"), ROWS, "a [title]")


def printed(listing: Listing, columns: int) -> str:
    console = Console(file=io.StringIO(), width=columns, markup=True)
    console.print(listing)
    return console.file.getvalue()


@pytest.mark.parametrize("columns", [44, 60, 80, 120])
def test_every_word_is_whole_and_no_line_too_long(columns):
    shown = printed(LISTING, columns)
    assert max(map(len, shown.splitlines())) <= columns
    for cell in (*LISTING.headings[1:], *sum(ROWS, ()), LISTING.title):
        for word in cell.split():
            assert word in shown
    assert "…" not in shown


def test_a_table_where_it_fits_and_paragraphs_where_it_does_not():
    assert "│" in printed(LISTING, 120)
    narrow = printed(LISTING, 50).splitlines()
    assert "│" not in "".join(narrow)
    assert narrow[1].strip() == "cogging_torque.periods_per_motor_revolution"
    assert narrow[2].rstrip() == "  value [rad]: 6"


def test_a_word_longer_than_the_terminal_is_folded():
    shown = printed(LISTING, 20)
    assert "".join(shown.split()).count("cogging_torque.periods_per_motor_revolution") == 1


def test_columns_that_want_little_get_it_first():
    assert widths([5, 5, 5], [7, 100, 5], 12) == [7, 15, 5]
    assert widths([5, 5], [6, 7], 100) == [6, 7]
