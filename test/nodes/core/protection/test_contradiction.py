"""An angle that does not go where the duty drives it."""

import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.nodes.core.protection.contradiction import Contradiction
from pierburg_ros.nodes.core.protection.frozen import Ends
from pierburg_ros.nodes.core.protection.limits import limits_of

CLOSED, OPEN = 0.42, 4.52
MARGIN = 0.05 * (OPEN - CLOSED)
PERIOD = 2_000_000


def judged(duty, *voltages):
    """What is found after a second under a duty, the voltage [V] going through these values at an even pace."""
    watch = Contradiction(limits_of(read_actuator("pierburg")), Ends(CLOSED, OPEN, MARGIN))
    for tick in range(500):
        place = tick / 500 * (len(voltages) - 1)
        left = int(place)
        right = min(left + 1, len(voltages) - 1)
        voltage = voltages[left] + (place - left) * (voltages[right] - voltages[left])
        watch.take(voltage + 0.003 * (-1) ** tick, duty, tick * PERIOD)
    return watch.found


@pytest.mark.parametrize(
    ("duty", "voltages"),
    [(0.5, (CLOSED, OPEN)), (1.0, (OPEN, OPEN)), (-0.5, (OPEN, CLOSED)), (-1.0, (CLOSED, CLOSED)), (0.3, (2.0, 2.0))],
)
def test_a_shaft_that_obeys_is_left_alone(duty, voltages):
    assert judged(duty, *voltages) is None


def test_rest_away_from_the_stop_and_motion_the_other_way_are_found():
    assert judged(-1.0, CLOSED + 0.5, CLOSED + 0.5).name == "rest_under_duty"
    assert judged(1.0, CLOSED, CLOSED).name == "rest_under_duty"
    assert judged(1.0, OPEN, CLOSED).name == "motion_against_duty"
    assert judged(-1.0, CLOSED, OPEN).name == "motion_against_duty"
