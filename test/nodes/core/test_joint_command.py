"""What a message of joint commands asks of one joint."""

import math

import pytest

from pierburg_ros.errors import InputError
from pierburg_ros.nodes.core.joint_command import JointCommand


@pytest.fixture
def command():
    return JointCommand("swirl_shaft")


def test_the_number_is_that_of_the_name(command):
    assert command.of(["elbow", "swirl_shaft"], [0.1, 0.7]) == 0.7
    assert command.of(["swirl_shaft"], [0.8]) == 0.8


@pytest.mark.parametrize("values", [[], [math.nan]])
def test_where_nobody_commands_nothing_is_asked(command, values):
    assert command.of(["swirl_shaft"], values) is None


def test_another_joint_is_a_wrong_name_until_this_one_was_named(command):
    with pytest.raises(InputError, match="joint_commands names elbow, expected swirl_shaft"):
        command.of(["elbow"], [0.1])
    with pytest.raises(InputError, match="joint_commands names no joint, expected swirl_shaft"):
        command.of([], [0.1])
    command.of(["swirl_shaft"], [0.1])
    assert command.of(["elbow"], [0.1]) is None


def test_numbers_that_belong_to_no_name_are_refused(command):
    with pytest.raises(InputError, match="has 1 numbers for 2 joints"):
        command.of(["elbow", "swirl_shaft"], [0.1])
