"""Counts and magnitudes are refused before memory is taken for them."""

import numpy as np
import pytest

from pierburg_ros.errors import InputError
from pierburg_ros.intake import check_count, check_magnitude
from pierburg_ros.library.simulation import Sampling


def test_ten_billion_samples_are_refused_and_four_million_are_not():
    with pytest.raises(
        InputError, match=r"A simulation of 100000 s at 100000 Hz has 1e\+10 samples, expected at most 4,"
    ):
        Sampling(1e5, 1e5, 0.0, 0, 0.0).times(1.0)
    check_count(8000.0, 500.0, "A simulation")


@pytest.mark.parametrize("value", [1.1e9, -np.inf, np.nan])
def test_a_value_beyond_any_sensor_is_named_with_its_place(value):
    check_magnitude("duty", np.array([1e9, -1e9]))
    with pytest.raises(InputError, match=r"duty has .* as value 2 of 3, expected magnitudes up to 1e"):
        check_magnitude("duty", np.array([0.0, value, 0.0]))
