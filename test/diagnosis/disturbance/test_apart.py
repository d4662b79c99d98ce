"""What acted on a recording and is no physics of the actuator is set apart where it explains what nothing else does."""

from dataclasses import replace

import numpy as np
import pytest
from support.recordings import NOISE, NOMINAL, data_on, recording

from pierburg_ros.diagnosis.disturbance.apart import (
    NOTHING,
    bridge_for_load,
    nominal_elsewhere,
    slow_quantities,
    with_open_bridge,
    without_stretch,
)
from pierburg_ros.diagnosis.disturbance.course import Course
from pierburg_ros.diagnosis.disturbance.slow import ZERO, Supply, Zero
from pierburg_ros.diagnosis.disturbance.wandered import Wandered, wandered
from pierburg_ros.diagnosis.disturbance.window import confined
from pierburg_ros.diagnosis.search.beam import Beam
from pierburg_ros.diagnosis.search.found import search
from pierburg_ros.estimation.estimator import Estimator
from pierburg_ros.estimation.likelihood import EXPLAINED
from pierburg_ros.inference.data import inputs_of
from pierburg_ros.inference.explanation import Explanation, Variant
from pierburg_ros.plant import simulate
from pierburg_ros.recording import Channel

ONE = recording({})
NOISES = NOISE * np.random.default_rng(5).standard_normal(ONE.time.size)


def driven(model=NOMINAL, **inputs):
    """ONE as a valve makes it under other inputs."""
    given = replace(inputs_of(ONE), **inputs)
    return replace(ONE, measured=simulate(model, given, ONE.time) + NOISES)


def fitted_to(given):
    data = data_on(given)
    estimator = Estimator(data, NOMINAL)
    return data, estimator, estimator.at(Explanation())


def held(values):
    """`values` at the samples of ONE as a channel for its changes of duty."""
    return np.interp(inputs_of(ONE).time, ONE.time, values)


def held_by_a_hand():
    """ONE as the nominal valve makes it while something pulls to and fro on it for three seconds."""
    hand = NOMINAL.with_values(
        {
            "external_load.amplitude": 0.2,
            "external_load.frequency": 0.8,
            "external_load.start": 9.0,
            "external_load.end": 12.0,
        }
    )
    return replace(ONE, measured=simulate(hand, inputs_of(ONE), ONE.time) + NOISES)


def with_the_bridge_open(model=NOMINAL):
    """ONE as a valve makes it whose bridge is open for three seconds."""
    time = inputs_of(ONE).time
    return driven(model, enabled=(time < 9.0) | (time >= 12.0))


def test_seconds_of_a_hand_are_left_out():
    given = held_by_a_hand()
    data, estimator, fit = fitted_to(given)
    assert fit.ratio > 10.0
    rest, left = without_stretch(data, estimator, fit, given)
    (omission,) = rest.left_out
    start, end = omission.span
    assert omission.why == NOTHING and 8.0 < start < 9.5 and 11.5 < end < 14.5
    assert left.ratio < EXPLAINED
    assert len(rest.runs) == 2 and not any(np.any((r.time > start) & (r.time < end)) for r in rest.runs)


def test_an_open_bridge_is_simulated_as_one():
    given = with_the_bridge_open()
    data, estimator, fit = fitted_to(given)
    rest, left = without_stretch(data, estimator, fit, given)
    assert not rest.left_out and "bridge seems to have been open" in rest.remarks[-1]
    assert left.ratio < EXPLAINED < 0.1 * fit.ratio
    # a bridge whose state was logged is no question
    logged = replace(given, enabled=Channel(np.array([0.0]), np.array([1.0])))
    told = without_stretch(data_on(logged), estimator, fit, logged)
    assert told is None or told[0].left_out


def test_a_load_that_came_and_went_gives_way_to_an_open_bridge():
    given = with_the_bridge_open(NOMINAL.with_values({"spring_stiffness": 0.3}))
    found = search(data_on(given), NOMINAL, jobs=1, beam=Beam(depth=0))
    load = Variant("external_load", ("torque", "start", "end"))
    values = {"external_load.torque": 0.2, "external_load.start": 9.0, "external_load.end": 12.0}
    drifted = found.estimator.fit(Explanation(("spring_stiffness",)), forgiving=True)
    fit = found.estimator.at(Explanation(("spring_stiffness",), (load,)), {**drifted.values, **values})
    powered, known = bridge_for_load(replace(found, chosen=fit), [given])
    assert known.enabled.at(np.array([8.9, 9.1, 12.1])).tolist() == [1, 0, 1]
    assert Estimator(powered, NOMINAL).fit(Explanation(("spring_stiffness",)), drifted.values).ratio < EXPLAINED
    assert bridge_for_load(replace(found, chosen=drifted), [given]) is None
    assert bridge_for_load(replace(found, chosen=fit), [given, given]) is None


def test_a_hand_is_no_open_bridge():
    given = held_by_a_hand()
    data, estimator, fit = fitted_to(given)
    assert with_open_bridge(data, estimator, fit, given, (9.0, 12.0)) is None


@pytest.mark.parametrize(
    "changes",
    [
        {"coulomb_friction": 0.25},
        {"sensor_lag.time_constant": 0.02},
        {"cogging_torque.amplitude": 0.03, "cogging_torque.periods_per_motor_revolution": 2.0},
    ],
    ids=str,
)
def test_physics_is_not_left_out(changes):
    data, estimator, fit = fitted_to(recording(changes))
    assert fit.ratio > EXPLAINED and without_stretch(data, estimator, fit, ONE) is None


def test_a_stretch_is_confined_where_it_is():
    data = data_on(ONE)
    residual = np.random.default_rng(1).standard_normal(ONE.time.size)
    assert confined(data, residual) is None
    residual[(ONE.time > 10.0) & (ONE.time < 13.0)] *= 20.0
    start, end = confined(data, residual)
    assert 9.4 < start <= 10.0 and 13.0 <= end < 13.6
    residual[ONE.time > 20.0] *= 20.0
    assert confined(data, residual) is None


def test_a_supply_that_wandered_is_told_from_the_motion():
    true = 13.5 * (1.0 + 0.07 * np.sin(2.0 * np.pi * ONE.time / 15.0))
    given = driven(supply_voltage=held(true))
    data, estimator, fit = fitted_to(given)
    supply = Supply(13.5, data.scales.time)
    found = wandered(data, fit, supply, estimator)
    assert max(found.trained, found.validated) < EXPLAINED < 0.1 * fit.ratio
    known = supply.known(given, found.course, found.values).supply_voltage
    middle = (ONE.time > 2.0) & (ONE.time < 22.0)
    assert np.sqrt(np.mean((known.at(ONE.time) - true)[middle] ** 2)) < 0.15


def test_a_supply_that_is_known_does_what_the_fitted_one_did():
    """Else what the two differ by is found as an effect: 0.3 of a noise of 1 mV where the supply is held for 10 ms."""
    data = data_on(ONE)
    course = Course.over(float(ONE.time[0]), float(ONE.time[-1]), data.scales.time)
    values = 0.07 * np.sin(2.0 * np.pi * course.knots / 15.0)
    supply = Supply(13.5, data.scales.time)
    fitted = supply.simulated(data.runs[0], course)(NOMINAL, values)
    known = data_on(supply.known(ONE, course, values)).runs[0].simulated(NOMINAL)
    assert np.max(np.abs(known - fitted)) < 1e-6


def test_a_sensor_whose_zero_wandered_is_told_from_the_motion():
    drift = 0.04 * np.cos(2.0 * np.pi * ONE.time / 20.0)
    data, estimator, fit = fitted_to(replace(ONE, measured=ONE.measured + drift))
    zero = Zero("V", ZERO * data.scales.reading)
    found = wandered(data, fit, zero, estimator)
    assert max(found.trained, found.validated) < EXPLAINED < fit.ratio
    assert np.max(np.abs(found.course.basis(ONE.time) @ found.values - drift)) < 2.0 * NOISE


@pytest.mark.parametrize("slow", [Supply(13.5, 0.095), Zero("V", 0.08)], ids=["supply", "zero"])
def test_what_wanders_does_not_stand_for_physics(slow):
    data, estimator, fit = fitted_to(
        recording({"static_friction.breakaway_torque": 0.3, "static_friction.stribeck_velocity": 0.1})
    )
    found = wandered(data, fit, slow, estimator)
    assert max(found.trained, found.validated) > 2.0


def test_a_course_is_smooth_between_its_knots_and_still_beyond():
    course = Course.over(0.0, 24.0, 0.095)
    values = np.sin(2.0 * np.pi * course.knots / 12.0)
    inside = np.linspace(4.0, 20.0, 100)
    assert np.max(np.abs(course.basis(inside) @ values - np.sin(2.0 * np.pi * inside / 12.0))) < 0.01
    assert course.basis(np.array([30.0])) @ values == pytest.approx(values[-1])


def test_only_a_supply_that_was_not_recorded_may_have_wandered():
    data = data_on(ONE)
    logged = replace(ONE, supply_voltage=Channel(ONE.time[:1], np.array([13.5])))
    assert [type(each) for each in slow_quantities(ONE, data, NOMINAL)] == [Zero, Supply]
    assert [type(each) for each in slow_quantities(logged, data, NOMINAL)] == [Zero]


def test_what_a_course_leaves_is_no_evidence():
    """An error of 1.25 noises where 1 is the sensor's: 0.75 of the noise moves whole stretches."""
    data = data_on(ONE)
    course = Course.over(0.0, 24.0, data.scales.time)
    kept = Wandered(course, np.zeros(course.knots.size), 1.0, 1.25).kept_apart(data)
    assert kept.noise == pytest.approx(1.25 * data.noise) and kept.unlike == pytest.approx(0.75 * data.noise)
    assert Wandered(course, np.zeros(course.knots.size), 0.99, 0.98).kept_apart(data) == data


def test_a_stretch_with_most_of_the_motion_is_not_left_out():
    """A valve that stands still but for five seconds: whatever is wrong with it shows in these."""
    time = inputs_of(ONE).time
    still = Channel(time, np.where((time > 10.0) & (time < 15.0), inputs_of(ONE).command, -0.1))
    true = NOMINAL.with_values({"coulomb_friction": 0.25})
    moved = simulate(true, inputs_of(replace(ONE, command=still)), ONE.time) + NOISES
    given = replace(ONE, measured=moved, command=still)
    data, _, fit = fitted_to(given)
    assert fit.ratio > EXPLAINED and nominal_elsewhere(data, NOMINAL, [given]) is None


def test_where_the_nominal_model_explains_the_rest_one_stretch_is_left_out_at_once():
    given = held_by_a_hand()
    data, _, _ = fitted_to(given)
    assert nominal_elsewhere(data, NOMINAL, [given]).left_out[0].why == NOTHING
    assert nominal_elsewhere(data, NOMINAL, [given, given]) is None
    stiff = replace(given, measured=given.measured + 0.1 * (given.measured - 2.0))
    assert nominal_elsewhere(data_on(stiff), NOMINAL, [stiff]) is None
