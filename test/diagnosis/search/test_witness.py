"""A controller as a second witness: what it tells of the sensor and of the log, and where it is silent."""

import warnings
from dataclasses import replace

import numpy as np
import pytest
from support.servo import LACKING, SERVO, TIME, in_loop

from pierburg_ros.diagnosis.search.signals import Signals
from pierburg_ros.diagnosis.diagnose import evidence
from pierburg_ros.diagnosis.remainder.standing import Standing, standing
from pierburg_ros.diagnosis.search.beam import Beam
from pierburg_ros.diagnosis.search.found import search
from pierburg_ros.diagnosis.search.witness import FEWEST, Witness, witnessed
from pierburg_ros.proof.real.channels import with_effect
from pierburg_ros.recording import Channel, Recording

LOOP = in_loop()
EFFECTS = {
    "sensor_lag": {"time_constant": 0.03},
    "sensor_hysteresis": {"width": 0.04},
    "input_delay": {"delay": 0.04},
    "pwm_deadband": {"width": 0.04},
}


def told(recording: Recording) -> Witness | None:
    return witnessed(Signals.of(recording, recording.time.size), SERVO)


def put_in(effect: str, recording: Recording = LOOP) -> Recording:
    """Stated by other formulas than those that the rule is read by."""
    supply = recording.command.__class__(TIME, np.full(TIME.size, 7.4))
    return with_effect(replace(recording, supply_voltage=supply), effect, EFFECTS[effect], SERVO)


@pytest.mark.parametrize("effect", EFFECTS)
def test_the_rule_tells_what_was_put_in(effect):
    found = told(put_in(effect))
    assert found is not None and found.variant.effect == effect and not found.as_well
    ((_, value),), (true,) = found.variant.fixed, EFFECTS[effect].values()
    assert value == pytest.approx(true, rel=0.1)
    (estimate,) = found.estimates.values()
    assert estimate.low <= value <= estimate.high and estimate.identifiable
    assert found.share > 0.9


@pytest.mark.parametrize("effect", EFFECTS)
def test_a_limited_duty_shows_no_angle_and_does_no_harm(effect):
    """A higher gain and larger movements meet the limit."""
    steep = in_loop(gain=2.0, size=1.2)
    assert np.mean(np.abs(steep.command.values) == 1.0) > 0.01
    found = told(put_in(effect, steep))
    assert found is not None and found.variant.effect == effect


def test_a_faultless_loop_says_nothing():
    assert all(told(in_loop(seed=seed)) is None for seed in range(3))


def test_times_that_sampling_hides_are_not_told():
    """A controller that computes from the last sample is 5 ms behind."""
    assert told(in_loop(slow=1)) is None


def test_a_duty_that_is_limited_but_for_the_end_tells_no_delay(monkeypatch):
    """Delayed by more than that end, none of its samples is free."""
    monkeypatch.setattr("pierburg_ros.diagnosis.search.witness.FAR", 30.0)
    few = FEWEST + 10
    limited = np.where(np.sin(40.0 * TIME) > 0.0, 1.0, -1.0)
    duty = np.where(np.arange(TIME.size) < TIME.size - few, limited, LOOP.command.values)
    noisy = LOOP.measured + np.random.default_rng(0).normal(0.0, 0.001, TIME.size)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert told(replace(LOOP, measured=noisy, command=Channel(TIME, duty))) is None


def test_what_rounding_leaves_of_a_rule_is_no_play():
    few = np.arange(TIME.size) >= TIME.size - FEWEST - 10
    limited = np.where(few, LOOP.command.values, np.where(np.sin(40.0 * TIME) > 0.0, 1.0, -1.0))
    assert told(replace(LOOP, command=Channel(TIME, limited))) is None


def test_without_setpoints_there_is_no_rule():
    assert told(replace(put_in("sensor_lag"), setpoints=None)) is None


def test_what_no_proportional_controller_made_has_no_rule():
    """A duty that has nothing to do with setpoint and angle."""
    other = in_loop(seed=5)
    assert told(replace(put_in("sensor_lag"), command=other.command)) is None


@pytest.mark.parametrize("gain", [1.1, 2.0, 4.0])
def test_a_controller_with_an_integral_has_another_rule(gain):
    """A lag seems to explain most of what its rule leaves, but of the loop's error too much is left."""
    for integral in (0.5, 1.0, 2.0):
        assert told(in_loop(gain=gain, integral=integral)) is None


@pytest.fixture
def stands(monkeypatch):
    """What stands by the word of the controller alone, where the motion is described rightly."""
    monkeypatch.setattr("pierburg_ros.diagnosis.remainder.standing._stood", lambda *_: None)

    def of(recording: Recording) -> Standing:
        return standing(search(evidence([recording], LACKING), LACKING, beam=Beam(depth=0)), recording=recording)

    return of


def test_the_motion_decides_between_a_dead_band_and_a_controller_that_makes_up_for_friction(stands):
    """Both step over a band around 0; with a dead band the motor gets no more than without."""
    band, made_up = stands(put_in("pwm_deadband")), stands(in_loop(beyond=0.04))
    assert set(band.weights) == {"pwm_deadband"} and set(band.told) == {"pwm_deadband.width"}
    assert band.weights["pwm_deadband"].confidence > 0.9
    assert made_up.base is None and not made_up.told


def test_the_motion_decides_between_a_lag_and_a_controller_with_a_derivative(stands):
    """The rule is the same; with a lag the shaft is ahead of what is recorded."""
    derived = in_loop(derivative=0.03)
    found = told(derived)
    assert found is not None and found.variant.effect == "sensor_lag"
    lagging, alone = stands(put_in("sensor_lag")), stands(derived)
    assert set(lagging.weights) == {"sensor_lag"} and set(lagging.told) == {"sensor_lag.time_constant"}
    assert alone.base is None and not alone.told


def test_of_a_play_the_controller_alone_speaks(stands):
    stood = stands(put_in("sensor_hysteresis"))
    assert set(stood.weights) == {"sensor_hysteresis"} and stood.base is not None
    assert stood.base.values["sensor_hysteresis.width"] == pytest.approx(0.04, rel=0.1)
