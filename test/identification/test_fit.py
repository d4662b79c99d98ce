"""Fits of whole recordings against closed forms, known truths and known statistics."""

import numpy as np
import pytest
from support.closed_form import FRICTION_ANGLE, GAIN, NOISE, PRELOAD_ANGLE, TIME_CONSTANT

from pierburg_ros.errors import InputError
from pierburg_ros.identification.experiment.excitation import duty_sequence
from pierburg_ros.identification.experiment.synthetic import synthetic_recording
from pierburg_ros.identification.fit import fit
from pierburg_ros.identification.identify import free_names
from pierburg_ros.identification.paper.lumps import fitted_lumps
from pierburg_ros.recording import Recording

TRUE_LUMPS = {
    "time_constant": TIME_CONSTANT,
    "gain": GAIN,
    "preload_angle": PRELOAD_ANGLE,
    "friction_angle": FRICTION_ANGLE,
}


def test_lumps_of_the_closed_form_are_recovered(nominal, closed_form_recording):
    start = nominal.with_values({"armature_resistance": 5.0, "coulomb_friction": 0.18})
    fitted = fit(start, [closed_form_recording], free_names(nominal))
    assert fitted.rmse == pytest.approx(NOISE, rel=0.05)
    for name, lump in fitted_lumps(fitted).items():
        assert lump.value == pytest.approx(TRUE_LUMPS[name], rel=0.001), name


def test_drifted_parameters_are_recovered_within_their_intervals(nominal):
    truth = {"armature_resistance": 5.2, "torque_constant": 0.0205, "coulomb_friction": 0.22}
    time = np.arange(15_000) / 500.0
    duty = duty_sequence("random_steps", nominal, time, seed=3)
    recording = synthetic_recording(nominal.with_values(truth), time, duty, NOISE, seed=3)
    fitted = fit(nominal, [recording], free_names(nominal))
    for name, value in truth.items():
        low, high = fitted.ci95[name]
        assert fitted.values[name] == pytest.approx(value, rel=0.002)
        assert low - (high - low) < value < high + (high - low)


def test_two_recordings_know_more_than_one(nominal, rich_recording, closed_form_recording):
    names = free_names(nominal)
    alone = fit(nominal, [closed_form_recording], names)
    together = fit(nominal, [closed_form_recording, rich_recording], names)
    assert [part.size for part in together.residuals] == [
        closed_form_recording.time.size,
        rich_recording.time.size,
    ]
    assert np.all(together.deviation < alone.deviation)


def test_intervals_cover_the_truth_at_their_nominal_rate(nominal):
    time = np.arange(10_000) / 500.0
    hits = dict.fromkeys(TRUE_LUMPS, 0)
    for seed in range(20):
        duty = duty_sequence("sharp_steps", nominal, time, seed)
        recording = synthetic_recording(nominal, time, duty, NOISE, seed=100 + seed)
        for name, lump in fitted_lumps(fit(nominal, [recording], free_names(nominal))).items():
            hits[name] += lump.ci95[0] <= TRUE_LUMPS[name] <= lump.ci95[1]
    # Of 20 with 95 % each, fewer than 15 happen once in 3000 times.
    assert min(hits.values()) >= 15


def test_breakaway_torque_is_found_from_coulomb_friction_upwards(nominal):
    truth = {"static_friction.breakaway_torque": 0.27, "static_friction.stribeck_velocity": 0.0}
    time = np.arange(15_000) / 500.0
    duty = duty_sequence("ramps", nominal, time, seed=4)
    recording = synthetic_recording(nominal.with_values(truth), time, duty, NOISE, seed=2)
    start = nominal.with_values({"static_friction.breakaway_torque": 0.22})
    fitted = fit(start, [recording], ["coulomb_friction", "static_friction.breakaway_torque"])
    assert fitted.values["coulomb_friction"] == pytest.approx(0.2007, rel=0.002)
    assert fitted.values["static_friction.breakaway_torque"] == pytest.approx(0.27, rel=0.002)
    low, high = fitted.ci95["static_friction.breakaway_torque"]
    assert low < 0.27 < high < 1.02 * low


def test_a_position_recording_of_a_hall_sensor_is_fitted_in_radians(nominal, rich_recording):
    angle = (rich_recording.measured - 0.42) / 4.1 * np.pi / 2
    recording = Recording("bench", "position", rich_recording.time, angle, rich_recording.command)
    volts, radians = (fit(nominal, [r], ["coulomb_friction"]) for r in (rich_recording, recording))
    assert radians.values["coulomb_friction"] == pytest.approx(volts.values["coulomb_friction"], rel=1e-4)
    assert radians.rmse == pytest.approx(volts.rmse / 4.1 * np.pi / 2, rel=1e-3)


def test_nothing_to_fit_is_refused(nominal, rich_recording):
    with pytest.raises(InputError, match="no free parameter"):
        fit(nominal, [rich_recording], [])
    with pytest.raises(InputError, match="no recording"):
        fit(nominal, [], ["coulomb_friction"])
    with pytest.raises(InputError, match="There is no parameter spring"):
        fit(nominal, [rich_recording], ["spring"])
