"""What the rule of a closed loop says of times and units, and that it says nothing against the motion."""

from dataclasses import replace

import numpy as np
import pytest
from support.servo import GAIN, SERVO, TIME, in_loop

from pierburg_ros.audit import audit
from pierburg_ros.audit.loop import rule
from pierburg_ros.audit.signals import Signals
from pierburg_ros.recording import Channel, Recording


def late(recording: Recording, by: float) -> Recording:
    return replace(recording, command=Channel(recording.command.time + by, recording.command.values))


def test_a_loop_is_read_from_its_signals():
    found = rule(Signals.of(in_loop()), SERVO)
    assert found is not None and found.late == 0
    assert (found.by_setpoint, found.by_angle) == pytest.approx((GAIN, -GAIN), rel=1e-3)


@pytest.mark.parametrize("by", [0.02, 0.05])
def test_an_input_that_fits_the_angle_of_a_moment_ago_was_stamped_late(by):
    one = in_loop()
    assert audit([one], SERVO) == []
    (fault,) = audit([late(one, by)], SERVO)
    assert fault.signal == "duty" and fault.what == f"stamped {1e3 * by:.3g} ms late"


def test_a_slow_controller_is_no_fault():
    """Its duty fits what was before, too, but the shaft moves as it says."""
    slow = in_loop(slow=8)
    assert rule(Signals.of(slow), SERVO).late == 8
    assert audit([slow], SERVO) == []


def test_an_angle_in_another_unit_than_the_setpoint_is_named():
    one = in_loop()
    (fault,) = audit([replace(one, measured=one.measured / (2.0 * np.pi))], SERVO)
    assert fault.mend == "`position: {unit: rev}`" or "turns read as radians" in fault.what


def test_a_setpoint_that_nothing_follows_says_nothing():
    one = in_loop()
    assert rule(Signals.of(replace(one, setpoints=Channel(TIME, np.sin(7.0 * TIME)))), SERVO) is None


@pytest.mark.parametrize("gain", [0.4, 1.08])
def test_input_and_angle_that_were_exchanged_are_named(gain):
    """Read so, the setpoint weighs 1 in the "duty" and the "angle" 1 / gain."""
    one = in_loop(gain=gain, size=0.3)
    assert audit([one], SERVO) == []
    read = replace(one, measured=one.command.at(TIME), command=Channel(TIME, one.measured))
    (fault,) = audit([read], SERVO)
    assert fault.what == "duty and position exchanged"


def test_a_controller_that_weighs_its_setpoint_less_is_no_fault():
    assert audit([in_loop(weight=0.8)], SERVO) == []
