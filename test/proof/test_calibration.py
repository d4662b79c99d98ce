"""How far a confidence holds: classes, shares and whether the two agree."""

import pytest

from pierburg_ros.proof.calibration import EDGES, Named, calibration, named, rows
from pierburg_ros.proof.calibration_plot import draw


def test_an_effect_that_is_not_there_counts_as_wrong():
    found = named({"backlash": 0.97, "sensor_lag": 0.6}, ("backlash",))
    assert found == [Named(0.97, True), Named(0.6, False)]


def test_names_stand_in_the_class_of_their_confidence():
    classes = calibration([Named(0.9, True), Named(0.95, False), Named(1.0, True), Named(0.2, False)])
    assert [(each.low, each.high, each.right.count, each.right.total) for each in classes] == [
        (0.0, 0.5, 0, 1),
        (0.9, 0.99, 1, 2),
        (0.99, 1.0, 1, 1),
    ]
    assert [each.said for each in classes] == pytest.approx([0.2, 0.925, 1.0])


def test_every_confidence_falls_into_one_class():
    names = [Named(number / 1000, True) for number in range(1001)]
    classes = calibration(names)
    assert sum(each.right.total for each in classes) == 1001 and len(classes) == len(EDGES) - 1


@pytest.mark.parametrize(("right", "agrees"), [(9, True), (3, False)])
def test_nine_in_ten_are_right_where_nine_tenths_are_said(right, agrees):
    (only,) = calibration([Named(0.9, number < right) for number in range(10)])
    assert only.holds is agrees
    assert rows([only])[0][-1] == ("yes" if agrees else "no")


def test_without_a_name_there_is_nothing_to_hold(tmp_path):
    assert calibration([]) == []
    draw([], tmp_path / "empty.png")
    assert (tmp_path / "empty.png").read_bytes().startswith(b"\x89PNG")


def test_the_curve_is_drawn(tmp_path):
    draw(calibration([Named(0.8, True), Named(1.0, True)]), tmp_path / "curve.png")
    assert (tmp_path / "curve.png").stat().st_size > 5000
