"""Windows in words, on a course that is known."""

from dataclasses import replace

import numpy as np
import pytest
from support.motions import CORNERS, drawn

from pierburg_ros.actuators import read_actuator
from pierburg_ros.diagnosis.location.locations import doing, locations


def pressing(time):
    return np.where(time < 1.2, -0.1, np.where(time > 8.0, -0.1, 0.2))


@pytest.mark.parametrize(
    ("start", "end", "words"),
    [
        (0.2, 0.8, "pressed against the closed stop"),
        (1.9, 2.3, "leaving the closed stop"),
        (2.4, 2.6, "fast opening between 23 and 34 degrees"),
        (3.5, 4.0, "standstill near 57 degrees"),
        (4.9, 5.2, "reversal, closing near 57 degrees"),
        (6.9, 7.1, "first movement after standstill, closing near 23 degrees"),
        (7.35, 7.8, "arriving at the closed stop"),
        (2.5, 4.5, "fast opening between 29 and 57 degrees, then between 29 and 57 degrees"),
    ],
)
def test_says_what_the_shaft_does(start, end, words):
    assert doing(drawn(duty=pressing), start, end) == words


def test_what_has_no_stop_neither_opens_nor_closes():
    motion = replace(drawn(duty=pressing), actuator=read_actuator("xl330"))
    assert doing(motion, 2.4, 2.6) == "fast forwards between 23 and 34 degrees"


def test_a_sensor_of_speed_tells_no_angle():
    motion = replace(drawn(duty=pressing), actuator=replace(read_actuator("xl330"), quantity="speed"))
    assert doing(motion, 2.4, 2.6) == "fast forwards at 0.958 to 1.04 rad/s"


def test_negative_duty_before_leaving_the_stop_is_said():
    def pulled(time):
        return np.where(time < 1.95, -0.1, 0.2)

    assert doing(drawn(duty=pulled), 1.9, 2.3) == "leaving the closed stop after negative duty"


def test_shares_are_of_all_energy():
    motion = drawn()
    residual = np.where((motion.time >= 2.0) & (motion.time < 3.0), 0.3, 0.1)
    found = locations(motion, residual, [(2.0, 3.0), (8.0, 8.5)])
    energies = np.array([0.09 * 1.0, 0.01 * 0.5]) / (0.09 * 1.0 + 0.01 * 9.0)
    assert [place.share for place in found] == pytest.approx(energies, rel=0.01)
    assert (found[0].start, found[0].end) == (2.0, 3.0)


@pytest.mark.parametrize(
    ("window", "way"), [((2.1, 2.9), "positive"), ((5.1, 5.9), "negative"), ((2.1, 5.9), "both"), ((3.5, 4.5), "both")]
)
def test_a_window_has_the_direction_in_which_the_shaft_moves_in_it(window, way):
    motion = drawn()
    (found,) = locations(motion, np.ones(motion.time.size), [window])
    assert found.direction == way


def test_windows_that_are_all_late_are_called_late():
    motion = drawn(corners=CORNERS)
    found = locations(motion, np.ones(motion.time.size), [(7.0, 7.2), (8.0, 8.4)])
    assert all(place.regime.endswith(", late in the recording") for place in found)
