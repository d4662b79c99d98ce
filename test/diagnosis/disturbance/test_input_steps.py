"""What may have been applied between the steps in which an input was logged."""

import numpy as np
import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.diagnosis.disturbance.rounding import Rounding, between_steps
from pierburg_ros.diagnosis.search.selection import allowance
from pierburg_ros.estimation.data import data_of
from pierburg_ros.estimation.estimator import Estimator
from pierburg_ros.identification.experiment.synthetic import synthetic_recording
from pierburg_ros.inference.explanation import Explanation
from pierburg_ros.plant import Inputs, Model
from pierburg_ros.recording import Channel, Recording

TIME = np.arange(400) * 0.01


@pytest.mark.parametrize(("driven_by", "largest"), [("duty", 1.0), ("torque", 4.0), ("current", 30.0)])
def test_an_input_is_off_by_half_a_step_at_most(driven_by, largest):
    """A duty ends at 1, a torque or a current does not."""
    step = 0.02 * largest
    logged = step * np.round(largest * np.sin(3.0 * TIME) / step)
    recording = Recording("run", "position", TIME, np.sin(TIME), Channel(TIME, logged), input=driven_by)
    between = between_steps(Inputs(TIME, logged), recording, step).command
    off = np.abs(between - logged)
    assert np.max(off) <= 0.5 * step + 1e-12 and np.mean(off) > 0.15 * step
    assert driven_by != "duty" or np.max(np.abs(between)) <= 1.0


def test_what_steps_may_do_counts_as_noise_and_as_no_evidence():
    valve = Model.nominal(read_actuator("pierburg"))
    times = np.arange(3000) / 500.0
    recording = synthetic_recording(valve, times, np.repeat(np.random.default_rng(0).uniform(0.0, 0.3, 15), 200))
    data = data_of([recording], valve)
    rounding = Rounding(recording, 0.01, size=4.0 * data.noise)
    apart = rounding.kept_apart(data)
    assert apart.noise == pytest.approx(np.sqrt(17.0) * data.noise)
    fit = Estimator(apart, valve).fit(Explanation())
    assert allowance(fit) == pytest.approx(16.0 / 17.0 * times.size, rel=1e-3)
    settled, unsettled = (rounding.said(data, unsettled=each).remarks[-1] for each in (False, True))
    assert "which counts as noise" in settled and "no effect can be concluded" in unsettled
