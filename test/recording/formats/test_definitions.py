"""Message types by the definitions that a file carries; hostile ones are refused in one line."""

import pytest
from rosbags.typesys import Stores, get_typestore

from pierburg_ros.errors import InputError
from pierburg_ros.recording.formats.definitions import UNDEFINED, Definition, types_of

NAME = "bench/msg/Simple"
RULE = "=" * 80
IDL = f"""{RULE}
IDL: {NAME}
#include "bench/msg/Inner.idl"
module bench {{ module msg {{
  @verbatim (language="comment", text="a comment")
  struct Simple {{ double value; bench::msg::Inner inner; }};
}}; }};
{RULE}
IDL: bench/msg/Inner
module bench {{ module msg {{ struct Inner {{ sequence<float> data; }}; }}; }};
"""
MSG = f"float64 value\nbench/Inner inner\n{RULE}\nMSG: bench/Inner\nfloat32[] data\n"


@pytest.mark.parametrize("definition", [Definition("ros2idl", IDL), Definition("ros2msg", MSG)])
def test_both_languages_say_the_same(definition):
    fields = types_of(NAME, definition).fielddefs
    assert [name for name, _ in fields[NAME][1]] == ["value", "inner"]
    assert [name for name, _ in fields["bench/msg/Inner"][1]] == ["data"]


def test_a_standard_type_without_a_definition_is_that_of_ros():
    found = types_of("sensor_msgs/msg/JointState", UNDEFINED)
    assert found.fielddefs == get_typestore(Stores.ROS2_JAZZY).fielddefs


def test_a_standard_type_that_is_held_and_left_out_is_that_of_ros():
    found = types_of(NAME, Definition("ros2msg", "std_msgs/Header header\nfloat64 value\n"))
    assert "builtin_interfaces/msg/Time" in found.fielddefs


def test_the_type_of_the_file_comes_before_that_of_ros():
    found = types_of("std_msgs/msg/Float64", Definition("ros2msg", "float64 other\n"))
    assert [name for name, _ in found.fielddefs["std_msgs/msg/Float64"][1]] == ["other"]


@pytest.mark.parametrize(
    ("definition", "said"),
    [
        (UNDEFINED, "has no definition in the file that is read here (none)"),
        (Definition("protobuf", "x"), "has no definition in the file that is read here (protobuf)"),
        (Definition("ros2msg", "int32 x\n" * 100_000), "has no definition in the file that is read here"),
        (Definition("ros2msg", "bench/Simple x\n"), "is not usable"),
        (Definition("ros2msg", "bench/Missing x\n"), "is not usable"),
        (Definition("ros2msg", "int32 x\nint32 x\n"), "is not usable"),
        (Definition("ros2msg", "float64 __class__\n"), "is not usable"),
        (Definition("ros2idl", "struct {"), "is not usable"),
        (Definition("ros2msg", "\x00\udcff"), "is not usable"),
    ],
)
def test_what_defines_nothing_is_one_line(definition, said):
    with pytest.raises(InputError) as refused:
        types_of(NAME, definition)
    assert said in str(refused.value) and "\n" not in str(refused.value)
