"""Every number of a message is listed by a path that leads to it."""

import numpy as np
import pytest
from support.foreign_bags import STORE, T, bench_run, command, joints

from pierburg_ros.recording.formats.definitions import Definition
from pierburg_ros.recording.formats.messages import Messages
from pierburg_ros.recording.inspection.fields import LISTED_ELEMENTS, fields_of
from pierburg_ros.recording.signal_map.field_path import field_path, value_at


def messages(kind, *contents):
    """Messages of one type as a file would give them, with the definition that ROS brings or the bench's own."""
    numbers = np.arange(len(contents))
    definition = Definition("ros2msg", str(STORE.generate_msgdef(kind, ros_version=2)[0]))
    data = [bytes(STORE.serialize_cdr(content, kind)) for content in contents]
    return Messages("/topic", kind, numbers, numbers, numbers, numbers, data, definition)


def dynamic_state(angle):
    """The state of two joints by name, each with values by name, as ros2_control publishes it."""
    interfaces = T["bench/msg/Interfaces"]
    values = [interfaces(["position", "effort"], np.array([angle, 9.0])), interfaces(["position"], np.array([7.0]))]
    return T["bench/msg/DynamicState"](["world"], ["elbow", "wrist"], values)


@pytest.mark.parametrize(
    ("kind", "content", "path"),
    [
        ("bench/msg/Command", command(5.0, 0.25), "pwm.data[2]"),
        ("bench/msg/DynamicState", dynamic_state(0.5), "interface_values[elbow].values[effort]"),
        ("sensor_msgs/msg/JointState", joints(5.0, shoulder=1.0, elbow=2.0), "velocity[elbow]"),
        ("bench/msg/Board", bench_run(1)[2][3], "channels[supply].volts"),
    ],
)
def test_each_path_leads_to_its_number(kind, content, path):
    found = {field.path: field.values[0] for field in fields_of(messages(kind, content))}
    assert path in found
    for written, value in found.items():
        assert float(value_at(content, field_path(written))) == value


def test_a_path_is_listed_once_with_the_values_of_all_messages():
    found = {
        field.path: field for field in fields_of(messages("bench/msg/DynamicState", *map(dynamic_state, range(5))))
    }
    field = found["interface_values[elbow].values[position]"]
    np.testing.assert_array_equal(field.values, np.arange(5.0))
    assert field.limits == (0.0, 4.0) and field.whole


def test_names_that_no_path_can_hold_give_way_to_places():
    content = joints(5.0, **{"a[b": 1.0, "c": 2.0})
    paths = [field.path for field in fields_of(messages("sensor_msgs/msg/JointState", content))]
    assert "position[0]" in paths and "position[c]" not in paths


def test_a_long_array_is_cut():
    content = T["std_msgs/msg/Float64MultiArray"](T["std_msgs/msg/MultiArrayLayout"]([], 0), np.arange(1000.0))
    found = [field.path for field in fields_of(messages("std_msgs/msg/Float64MultiArray", content))]
    assert found.count("data[15]") == 1 and f"data[{LISTED_ELEMENTS}]" not in found


def test_what_cannot_be_decoded_has_no_numbers():
    broken = messages("bench/msg/Command", command(5.0, 0.1))
    broken.data[0] = broken.data[0][:9]
    assert fields_of(broken) == ()
