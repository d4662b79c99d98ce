"""What a parameter accepts, and what it says when it does not."""

import math

import pytest

from pierburg_ros.errors import InputError
from pierburg_ros.parameter import Parameter

RATE = Parameter("rate", 500.0, "ticks per second", "Hz", 1.0, 2000.0)
SEED = Parameter("seed", 0, "seed of the noise", minimum=0, maximum=10)
FORM = Parameter("form", "mcap", "form of the file", choices=("mcap", "rosbag2"))


def test_an_integer_is_taken_for_a_double():
    accepted = RATE.accepted(100)
    assert accepted == 100.0
    assert type(accepted) is float


@pytest.mark.parametrize("value", [math.nan, math.inf, 0.5, 2001, -1])
def test_a_double_out_of_range_or_not_finite_is_refused_with_the_range(value):
    with pytest.raises(InputError, match=r"rate is .*; expected 1 to 2000 Hz"):
        RATE.accepted(value)


@pytest.mark.parametrize("value", [True, "500", None, [500.0]])
def test_another_type_is_refused(value):
    with pytest.raises(InputError, match="expected a number"):
        RATE.accepted(value)


@pytest.mark.parametrize("value", [1.0, True, "1"])
def test_a_whole_number_is_not_taken_from_anything_else(value):
    with pytest.raises(InputError, match="expected a whole number"):
        SEED.accepted(value)


def test_a_boolean_is_no_number_and_no_text():
    with pytest.raises(InputError, match="true or false"):
        Parameter("lockstep", False, "lockstep").accepted(1)


def test_choices_are_listed():
    assert FORM.accepted("rosbag2") == "rosbag2"
    with pytest.raises(InputError, match="expected mcap or rosbag2"):
        FORM.accepted("bag")


def test_a_list_of_texts():
    topics = Parameter("topics", ["duty"], "topics")
    assert topics.accepted(("a", "b")) == ["a", "b"]
    with pytest.raises(InputError, match="a list of texts"):
        topics.accepted([1, 2])


def test_the_description_carries_the_unit():
    assert RATE.description == "ticks per second [Hz]"
    assert SEED.description == "seed of the noise"
