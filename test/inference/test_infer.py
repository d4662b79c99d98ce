"""Recordings in, a choice out."""

from dataclasses import replace

import numpy as np
import pytest
from support.recordings import NOISE, NOMINAL, recording, recording_in_closed_loop

from pierburg_ros.actuators import read_actuator
from pierburg_ros.closed_loop import simulate_runs
from pierburg_ros.control import Settings
from pierburg_ros.inference.choice import Choice
from pierburg_ros.inference.fit import rms_of
from pierburg_ros.inference.infer import infer
from pierburg_ros.inference.intervals import intervals
from pierburg_ros.plant import Inputs, Model, simulate
from pierburg_ros.recording import Channel, Recording

pytestmark = pytest.mark.search

PENDULUM = Model.nominal(read_actuator("ak80"))


def named(choice: Choice) -> set[str]:
    return set(choice.chosen.explanation.effects)


def test_the_model_as_described_is_consistent():
    choice = infer([recording({})], NOMINAL).choice
    assert choice.verdict == "consistent"
    assert choice.chosen.size == 0


def test_a_drift_is_a_drift():
    choice = infer([recording({"armature_resistance": 5.2})], NOMINAL).choice
    assert choice.verdict == "parameter_drift"
    assert choice.chosen.explanation.drifted == ("armature_resistance",)
    assert choice.chosen.values["armature_resistance"] == pytest.approx(5.2, rel=0.01)


@pytest.mark.parametrize(
    "hidden",
    [
        {"load_dependent_friction.coefficient": 0.12},
        {"input_delay.delay": 0.012},
        {"sensor_hysteresis.width": 0.015},
        {"external_load.torque": 0.04, "external_load.start": 7.3, "external_load.end": 15.1},
    ],
    ids=lambda hidden: next(iter(hidden)).split(".")[0],
)
def test_an_effect_beside_a_drift_in_closed_loop_is_named(hidden):
    choice = infer([recording_in_closed_loop({**hidden, "spring_preload": 0.31})], NOMINAL).choice
    assert choice.verdict == "missing_physics"
    assert named(choice) == {next(iter(hidden)).split(".")[0]}
    assert {name: choice.chosen.values[name] for name in hidden} == pytest.approx(hidden, rel=0.15)
    assert choice.chosen.values["spring_preload"] == pytest.approx(0.31, rel=0.02)


@pytest.mark.parametrize("begin", [0.0, 3.3, 5.7])
@pytest.mark.parametrize("hidden", [{}, {"drag.quadratic": 0.02}], ids=["nothing", "drag"])
def test_where_a_recording_was_cut_shows_nothing(begin, hidden):
    time = np.arange(0.0, 24.0, 0.004)
    torque = 2.0 * np.sin(2.6 * time) + 1.2 * np.sin(7.3 * time + 1.0)
    angle = simulate(PENDULUM.with_values(hidden), Inputs(time, torque), time)
    angle += 0.001 * np.random.default_rng(0).standard_normal(time.size)
    kept = time >= begin
    driven = Channel(time[kept] - begin, torque[kept])
    cut = Recording("cut", "position", time[kept] - begin, angle[kept], driven, input="torque")
    choice = infer([cut], PENDULUM).choice
    assert choice.explained
    assert named(choice) == {name.split(".")[0] for name in hidden}
    assert choice.chosen.explanation.drifted == ()


def test_what_misses_blocks_that_were_held_out_is_not_called_explained():
    described = recording({})
    within = (described.time > 9.3) & (described.time < 9.9)
    choice = infer([replace(described, measured=described.measured + np.where(within, 0.03, 0.0))], NOMINAL).choice
    assert choice.verdict == "unexplained"
    assert np.any(choice.chosen.fitter.data.train[within])


def test_a_load_from_a_moment_on_is_told_from_no_change_of_the_preload_then():
    hidden = {"external_load.torque": 0.03, "external_load.start": 9.1}
    choice = infer([recording(hidden)], NOMINAL).choice
    either = {"external_load", "spring_preload"}
    assert choice.explained
    assert choice.chosen.size == 1
    assert {*choice.ties} | {*choice.alternatives} == either
    moment = "external_load.start" if named(choice) else "spring_preload@time"
    low, high = intervals(choice.handed)[moment].ci95
    assert low <= 9.1 <= high


def test_two_effects_are_named():
    hidden = {"cogging_torque.amplitude": 0.02, "cogging_torque.periods_per_motor_revolution": 3.0}
    hidden |= {"sensor_lag.time_constant": 0.015}
    choice = infer([recording(hidden)], NOMINAL).choice
    assert named(choice) == {"cogging_torque", "sensor_lag"}


def test_an_effect_that_equals_two_drifts_is_named_with_the_tie():
    choice = infer([recording({"viscous_friction.coefficient": 0.03})], NOMINAL).choice
    assert named(choice) == {"viscous_friction"}
    assert ("armature_resistance", "torque_constant") in choice.ties["viscous_friction"]


def test_several_drifts_do_not_stand_for_an_effect():
    # three other drifts, and drag, leave only noise too, and next to these static friction promises nothing
    begins = np.array([0.0, 9.0, 12.0, 15.0, 18.0, 21.0, 23.0, 25.0, 27.0, 29.0, 31.0, 34.0])
    setpoints = np.array([0.0, 0.35, 0.87, 1.22, 0.61, 1.05, 1.12, 0.98, 0.17, 0.24, 1.4, 0.0])
    time = np.arange(0.0, 36.0, 0.002)
    hidden = {"static_friction.breakaway_torque": 0.27, "static_friction.stribeck_velocity": 0.1}
    valve, course = NOMINAL.with_values({**hidden, "spring_preload": 0.31}), np.searchsorted(begins, time, "right") - 1
    run = simulate_runs(valve, Settings(), setpoints[course][np.newaxis], noise=NOISE)
    rests = Recording("rests", "hall_voltage", time, run.hall_voltage[0], Channel(time, run.duty[0]))
    choice = infer([rests], NOMINAL).choice
    assert named(choice) == {"static_friction"}
    assert choice.chosen.explanation.drifted == ("spring_preload",)


def test_the_model_handed_out_predicts_best_of_all_that_were_fitted():
    choice = infer([recording({"load_dependent_friction.coefficient": 0.12})], NOMINAL).choice
    held_out = choice.predictor.fitter.data.validation
    least = min(rms_of(fit, held_out) for fit in choice.fits)
    assert rms_of(choice.predictor, held_out) <= 1.01 * least


def test_the_number_of_jobs_changes_nothing():
    hidden = recording({"pwm_deadband.width": 0.02})
    one, two = (infer([hidden], NOMINAL, jobs=jobs).choice for jobs in (1, 2))
    assert one.chosen.values == two.chosen.values
    assert [fit.chi2 for fit in one.fits] == [fit.chi2 for fit in two.fits]
    assert one.chosen.fitter.effort.simulations == two.chosen.fitter.effort.simulations
    assert np.array_equal(one.predictor.residual, two.predictor.residual)
