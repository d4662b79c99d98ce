"""How much a diagnosis may take, as it is given."""

import math

import pytest

from pierburg_ros.budget import SIMULATIONS, USUAL_BUDGET, Budget
from pierburg_ros.errors import InputError


@pytest.mark.parametrize(
    ("given", "efforts", "seconds"),
    [
        (1.0, 1.0, math.inf),
        ("2", 2.0, math.inf),
        (" 0.5 ", 0.5, math.inf),
        ("60s", 1.0, 60.0),
        ("1e3s", 1.0, 1000.0),
        ("inf", math.inf, math.inf),
        (None, math.inf, math.inf),
        (Budget(3.0, 5.0), 3.0, 5.0),
    ],
)
def test_efforts_and_seconds_are_read(given, efforts, seconds):
    assert Budget.of(given) == Budget(efforts, seconds)


@pytest.mark.parametrize("given", ["0", "-1", "0s", "s", "", "nan", "nans", "60 min", "much"])
def test_what_is_no_budget_is_refused_with_what_is_expected(given):
    with pytest.raises(InputError, match=r"expected usual efforts such as 2 or 0\.5, or seconds such as 60s"):
        Budget.of(given)


def test_efforts_count_simulations_and_a_clock_counts_none():
    assert USUAL_BUDGET.simulations == SIMULATIONS
    assert Budget(0.25).simulations == SIMULATIONS / 4
    assert Budget.of("1s").simulations == SIMULATIONS
    assert math.isinf(Budget.of(None).simulations)
