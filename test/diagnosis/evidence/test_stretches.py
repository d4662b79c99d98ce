"""Stretches simulated from the measured state."""

import numpy as np
from support.recordings import NOISE, NOMINAL, PIERBURG, recording

from pierburg_ros.diagnosis.evidence.data import evidence_of
from pierburg_ros.diagnosis.evidence.stretches import restarted


def test_cover_every_sample_once_and_keep_what_trains():
    data = evidence_of([recording({}, duration=12.3)], PIERBURG)
    cut = restarted(data, 1.0)
    assert len(cut.runs) == 13
    np.testing.assert_array_equal(np.concatenate([run.time for run in cut.runs]), data.runs[0].time)
    np.testing.assert_array_equal(cut.training, data.training)
    np.testing.assert_array_equal(cut.choosing, data.choosing)


def test_the_right_model_fits_stretches_nearly_down_to_the_noise():
    """The start of a stretch is averaged from the samples around it, so it is off by a fraction of the noise."""
    data = evidence_of([recording({})], PIERBURG)
    error = restarted(data, 1.0).residual(NOMINAL) * data.noise
    assert np.sqrt(np.mean(error**2)) < 1.5 * NOISE


def test_an_error_is_forgotten_at_the_next_start():
    data = evidence_of([recording({"spring_preload": 0.33})], PIERBURG)
    whole, cut = (np.mean(np.square(some.residual(NOMINAL))) for some in (data, restarted(data, 0.5)))
    assert cut < 0.3 * whole


def test_loads_keep_to_the_time_of_the_recording():
    load = {"external_load.torque": 0.15, "external_load.start": 9.0, "external_load.end": 14.0}
    error = restarted(evidence_of([recording(load)], PIERBURG), 1.0).residual(NOMINAL.with_values(load))
    assert np.sqrt(np.mean(error**2)) < 1.5


def test_a_stretch_that_begins_on_a_stop_begins_exactly_there():
    data = evidence_of([recording({})], PIERBURG)
    starts = np.array([run.initial_angle for run in restarted(data, 0.25).runs])
    assert np.all((starts >= 0.0) & (starts <= np.pi / 2))
    assert np.count_nonzero(starts == 0.0) > 0
