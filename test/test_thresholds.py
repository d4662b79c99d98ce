"""Every threshold has a reason for its value, in its docstring."""

import re

import pytest
from support.named_numbers import GROUNDS, named_numbers, numbers_of, parts

ROOMS = ("inference", "audit", "diagnosis", "identification", "fleets")
"""Folders whose numbers decide what is concluded from recordings."""
FOUND = [found for room in ROOMS for found in numbers_of(room)]


@pytest.mark.parametrize("found", FOUND, ids=lambda found: f"{found.file}-{found.name}")
def test_a_threshold_says_what_it_decides_and_why_it_has_its_value(found):
    assert len(found.decides.split()) >= 4
    assert found.ground in GROUNDS, "the docstring names no ground: 'Derived: ...', 'Measured: ...', ..."
    assert len(found.reason.split()) >= 3


@pytest.mark.parametrize("found", [f for f in FOUND if f.ground == "Measured"], ids=lambda found: found.name)
def test_a_measured_threshold_says_of_how_many_cases(found):
    assert re.search(r"\bn = \d", found.reason)


def test_no_number_with_a_name_escapes():
    source = 'A = 3\nB = (0.5, -1.0)\nC: float = 2 * A\nD = {"row": 4.0}\nE = (1, "text")\nF = "4"\ng = 5\nH = A\n'
    assert [name for name, _, _ in named_numbers(source)] == ["A", "B", "C", "D"]


def test_a_docstring_without_a_ground_is_no_reason():
    assert parts("Share of the error that is kept. It works well.")[1] == ""
    assert parts("Share of the error that is kept. Derived: a half of it.") == (
        "Share of the error that is kept.",
        "Derived",
        "a half of it.",
    )
