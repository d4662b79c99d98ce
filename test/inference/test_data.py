"""Recordings as a fit uses them: which samples count, and what is too little to fit."""

from dataclasses import replace

import numpy as np
import pytest
from support.recordings import NOMINAL, data_on, recording

from pierburg_ros.errors import InputError
from pierburg_ros.inference.choice import Score
from pierburg_ros.inference.explanation import Explanation, Variant
from pierburg_ros.inference.fit import Fitter, ladder
from pierburg_ros.plant import Inputs, simulate
from pierburg_ros.recording import Channel
from pierburg_ros.recording.loss import Loss

LOGGED = recording({})


def paused(every: float, length: float):
    """The recording with its duty unknown for a `length` [s] in each `every` [s], its samples missing there too."""
    spans = tuple((start, start + length) for start in np.arange(0.02, LOGGED.time[-1], every).tolist())
    kept = np.ones(LOGGED.time.size, dtype=bool)
    for start, end in spans:
        kept &= (LOGGED.time <= start) | (LOGGED.time >= end)
    lost = Loss("duty", None, LOGGED.command.time.size, spans)
    return replace(LOGGED, time=LOGGED.time[kept], measured=LOGGED.measured[kept], losses=(lost,))


def test_pauses_in_which_the_shaft_cannot_be_moved_leave_all_samples():
    """A logger that writes for 2 ms in each 40 ms: the duty before and after is the same but where it steps."""
    logged = paused(0.04, 0.002)
    assert np.mean(data_on(logged).counts) > 0.7 and np.mean(data_on(LOGGED).counts) > 0.95


def test_after_a_pause_a_fit_begins_anew():
    """Two seconds in which the duty changed: a shaft that is elsewhere after it is no error of the model."""
    kept = (LOGGED.time <= 9.0) | (LOGGED.time >= 11.0)
    lost = Loss("duty", None, LOGGED.command.time.size, ((9.0, 11.0),))
    duty = Channel(LOGGED.time[kept], LOGGED.command.values[kept])
    paused = replace(LOGGED, time=LOGGED.time[kept], measured=LOGGED.measured[kept], command=duty, losses=(lost,))
    data = data_on(paused)
    for constant in ladder(data):
        assert Fitter(data, NOMINAL, constant).fit(Explanation(), NOMINAL.values, 0).ratio < 1.02


def test_a_simulation_without_noise_is_held_to_what_correct_simulators_differ_by():
    """0.3 mV of the valve: else the last digits of a fit would decide between explanations."""
    exact = replace(LOGGED, measured=simulate(NOMINAL, Inputs(LOGGED.time, LOGGED.command.values), LOGGED.time))
    data = data_on(exact)
    assert 2e-4 < data.noise < 4e-4
    fitter = Fitter(data, NOMINAL, ladder(data)[0])
    right = fitter.fit(Explanation(), NOMINAL.values, 0)
    near = fitter.fit(Explanation(), {**NOMINAL.values, "armature_resistance": 4.1391}, 0)
    score = Score.of([right, near])
    assert near.chi2 > 1e6 * right.chi2 and score.alike(near, right)


def test_a_load_that_no_sample_shows_ending_has_no_end():
    """So it acts beyond the recording, too; one that ends within does end."""
    load = Variant("external_load", ("torque", "start", "end"))
    for end, found in ((0.0, 0.0), (17.0, 17.0)):
        made = recording({"external_load.torque": 0.02, "external_load.end": end})
        fitter = Fitter(data_on(made), NOMINAL, ladder(data_on(made))[0])
        begun = {"external_load.torque": 0.015, "external_load.end": end or 23.5}
        values = fitter.fit(Explanation((), (load,)), {**NOMINAL.values, **begun}).values
        assert values["external_load.torque"] == pytest.approx(0.02, rel=0.05)
        assert values["external_load.end"] == pytest.approx(found, abs=0.2) and values["external_load.start"] == 0.0


def test_where_the_duty_is_hardly_known_nothing_is_fitted():
    with pytest.raises(InputError, match="leaves 10 samples to fit, expected 64 at least: in the rest its duty is not"):
        data_on(paused(0.5, 0.45))
