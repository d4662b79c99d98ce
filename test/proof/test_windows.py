"""Windows against the best windows of their length, on signals whose energy is known."""

import numpy as np
import pytest

from pierburg_ros.proof.windows import best, held, share_of_best

TIME = np.arange(1000) / 100.0  # 10 s


def pulse(start, end):
    return np.where((TIME - start >= 0.0) & (TIME - end < 0.0), 1.0, 0.0)


def test_the_right_window_holds_all():
    signal = pulse(2.0, 4.0)
    assert held(TIME, signal, [{"start": 2.0, "end": 4.0}])[0] == 1.0
    assert share_of_best(TIME, signal, [{"start": 2.0, "end": 4.0}]) == pytest.approx(1.0)


def test_half_the_right_length_in_the_right_place_is_the_best_possible():
    assert share_of_best(TIME, pulse(2.0, 4.0), [{"start": 2.6, "end": 3.6}]) == pytest.approx(1.0, abs=0.02)


def test_the_wrong_place_holds_nothing():
    assert share_of_best(TIME, pulse(2.0, 4.0), [{"start": 6.0, "end": 8.0}]) == 0.0


def test_overlapping_windows_count_once():
    windows = [{"start": 2.0, "end": 3.0}, {"start": 2.5, "end": 3.0}]
    share, length = held(TIME, pulse(2.0, 4.0), windows)
    assert share == pytest.approx(0.5)
    assert length == pytest.approx(1.0)


def test_the_best_is_bounded_by_the_whole():
    assert best(TIME, pulse(0.0, 10.0), 2.5) == pytest.approx(0.25)
    assert best(TIME, pulse(0.0, 10.0), 60.0) == pytest.approx(1.0)


@pytest.mark.parametrize(("signal", "windows"), [(pulse(2.0, 4.0), []), (0.0 * TIME, [{"start": 1.0, "end": 2.0}])])
def test_nothing_to_compare_gives_none(signal, windows):
    assert share_of_best(TIME, signal, windows) is None
