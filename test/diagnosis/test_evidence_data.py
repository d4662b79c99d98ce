"""What the diagnosis looks at: the samples it keeps for judging."""

import numpy as np
import pytest
from recordings import NOISE, NOMINAL, PIERBURG, recording

from pierburg_ros.actuators import read_actuator
from pierburg_ros.diagnosis.evidence_data import evidence_of, training_blocks
from pierburg_ros.errors import InputError


def test_a_quarter_of_the_samples_judges_in_whole_blocks() -> None:
    time = np.arange(0.0, 60.0, 0.002)
    training = training_blocks(time)
    assert np.mean(~training) == pytest.approx(0.25, abs=0.01)
    assert np.count_nonzero(np.diff(training.astype(int))) == 10


def test_the_true_model_leaves_residuals_of_size_one() -> None:
    data = evidence_of([recording({})], PIERBURG)
    assert data.noise == pytest.approx(NOISE, rel=0.03)
    assert np.std(data.residual(NOMINAL)) == pytest.approx(1.0, abs=0.03)


def test_another_actuator_is_refused() -> None:
    with pytest.raises(InputError, match=r"holds hall_voltage, but actuator xl330 measures position"):
        evidence_of([recording({})], read_actuator("xl330"))
