"""Paths to a number: fields, places and names of elements."""

import pytest

from pierburg_ros.recording.signal_map.field_path import Named, field_path


@pytest.mark.parametrize(
    ("written", "steps"),
    [
        ("data", ("data",)),
        ("pwm.data[2]", ("pwm", "data", 2)),
        ("position[elbow]", ("position", Named("elbow"))),
        ("position['2']", ("position", Named("2"))),
        ('position["left arm/elbow"]', ("position", Named("left arm/elbow"))),
        ("motors[left].current", ("motors", Named("left"), "current")),
        ("a[0][1].b", ("a", 0, 1, "b")),
    ],
)
def test_a_path_has_its_steps(written, steps):
    assert field_path(written).steps == steps


@pytest.mark.parametrize(
    "written", ["", ".", "a.", "a..b", "[0]", "a[", "a[]", "a]b", "a[b[c]]", "1a", "a b", "x" * 999]
)
def test_what_is_no_path_is_refused(written):
    with pytest.raises(ValueError, match="no field path"):
        field_path(written)
