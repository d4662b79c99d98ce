"""Stretches simulated from the measured state."""

import numpy as np
import pytest
from support.recordings import NOISE, NOMINAL, data_on, recording

from pierburg_ros.diagnosis.evidence.stretches import forgotten, leading_to, restarted


def test_cover_every_sample_once_and_keep_what_trains():
    data = data_on(recording({}, duration=12.3))
    cut = restarted(data, 1.0)
    assert len(cut.runs) == 13
    np.testing.assert_array_equal(np.concatenate([run.time for run in cut.runs]), data.runs[0].time)
    np.testing.assert_array_equal(cut.train, data.train)
    np.testing.assert_array_equal(cut.validation, data.validation)


def test_the_right_model_fits_stretches_nearly_down_to_the_noise():
    """The start of a stretch is averaged from the samples around it, so it is off by a fraction of the noise."""
    data = data_on(recording({}))
    error = restarted(data, 1.0).residual(NOMINAL) * data.noise
    assert np.sqrt(np.mean(error**2)) < 1.5 * NOISE


def test_an_error_is_forgotten_at_the_next_start():
    data = data_on(recording({"spring_preload": 0.33}))
    whole, cut = (np.mean(np.square(some.residual(NOMINAL))) for some in (data, restarted(data, 0.5)))
    assert cut < 0.3 * whole


def test_loads_keep_to_the_time_of_the_recording():
    load = {"external_load.torque": 0.15, "external_load.start": 9.0, "external_load.end": 14.0}
    error = restarted(data_on(recording(load)), 1.0).residual(NOMINAL.with_values(load))
    assert np.sqrt(np.mean(error**2)) < 1.5


def test_a_stretch_that_begins_on_a_stop_begins_exactly_there():
    data = data_on(recording({}))
    starts = np.array([run.start.state(NOMINAL, run.quantity)[0] for run in restarted(data, 0.25).runs])
    assert np.all((starts >= 0.0) & (starts <= np.pi / 2))
    assert np.count_nonzero(starts == 0.0) > 0


def test_stretches_begin_where_the_model_that_is_simulated_reads_them():
    """A sensor of other ends sees the same valve: its stretches fit as well as those of the nominal one."""
    ends = {"hall_voltage_closed": 0.55, "hall_voltage_open": 4.4}
    data = data_on(recording(ends))
    error = restarted(data, 1.0).residual(NOMINAL.with_values(ends))
    assert np.sqrt(np.mean(error**2)) < 1.5


@pytest.mark.parametrize(
    ("effects", "expected"),
    [((), True), (("sensor_lag", "backlash"), True), (("sensor_lag", "thermal_resistance"), False)],
)
def test_only_heat_outlasts_a_stretch(effects, expected):
    assert forgotten(effects) == expected


def test_stretches_lead_to_every_sample_that_tests_but_the_first():
    data = data_on(recording({}, duration=24.0))
    run = data.runs[0]
    led = leading_to(data, 1.0, 0.2)
    counted = np.concatenate([part.time[~(part.train | part.validation)] for part in led.runs])
    test = run.time[data.test]
    np.testing.assert_array_equal(counted, test[test - run.time[0] >= 0.8])
    for part in led.runs:
        late = part.time[~(part.train | part.validation)] - part.time[0]
        assert np.all((late > 0.8 - 0.003) & (late < 1.0 + 0.003))
    error = led.residual(NOMINAL)[led.test] * data.noise
    assert np.sqrt(np.mean(error**2)) < 1.5 * NOISE
