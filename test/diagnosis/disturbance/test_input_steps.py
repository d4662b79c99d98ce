"""What may have been applied between the steps in which an input was logged."""

import numpy as np
import pytest

from pierburg_ros.diagnosis.disturbance.rounding import between_steps
from pierburg_ros.plant import Inputs
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
