"""What the diagnosis looks at: the samples it keeps for judging."""

import numpy as np
import pytest
from support.recordings import NOISE, NOMINAL, PIERBURG, recording

from pierburg_ros.actuators import read_actuator
from pierburg_ros.diagnosis.evidence.data import after_choice, evidence_of, held_back
from pierburg_ros.diagnosis.evidence.quality import limits_of
from pierburg_ros.errors import InputError


@pytest.mark.parametrize("duration", [5.0, 60.0])
def test_of_eight_blocks_six_train_one_chooses_and_one_judges(duration: float) -> None:
    data = evidence_of([recording({}, duration=duration)], PIERBURG)
    assert np.mean(data.training) == pytest.approx(0.75, abs=0.02)
    assert np.mean(data.choosing) == pytest.approx(0.125, abs=0.02)
    assert np.all(data.training.astype(int) + data.choosing + data.judging == 1)
    assert np.count_nonzero(np.diff(data.training.astype(int))) == (20 if duration == 60.0 else 8)


def test_what_is_held_back_is_taken_from_training() -> None:
    data = evidence_of([recording({})], PIERBURG)
    inner = held_back(data)
    assert np.mean(inner.training) == pytest.approx(0.5, abs=0.02)
    assert np.all(data.training | ~inner.training)
    np.testing.assert_array_equal(inner.choosing, data.choosing)


def test_the_true_model_leaves_residuals_of_size_one() -> None:
    data = evidence_of([recording({})], PIERBURG)
    assert data.noise == pytest.approx(NOISE, rel=0.03)
    assert np.std(data.residual(NOMINAL)) == pytest.approx(1.0, abs=0.03)


def test_another_actuator_is_refused() -> None:
    with pytest.raises(InputError, match=r"holds hall_voltage, but actuator xl330 measures position"):
        evidence_of([recording({})], read_actuator("xl330"))


def test_after_the_choice_all_train_but_what_judges() -> None:
    data = evidence_of([recording({})], PIERBURG)
    last = after_choice(data)
    np.testing.assert_array_equal(last.training, ~data.judging)
    np.testing.assert_array_equal(last.judging, data.judging)
    assert not np.any(last.choosing)


@pytest.mark.parametrize("begin", [0.64, 1.24, 2.42, 2.78, 3.04, 3.34, 5.72])
def test_a_recording_may_begin_anywhere(begin: float) -> None:
    """Of a valve that lags behind an inductance and a delay: at rest on the spring, in motion, pressed open."""
    true = {"armature_inductance.inductance": 0.01, "input_delay.delay": 0.01}
    data = evidence_of([recording(true).select(begin, 24.0)], PIERBURG)
    run = data.runs[0]
    error = data.residual(NOMINAL.with_values(true))
    assert np.sqrt(np.mean(error[run.time - run.time[0] < 4.0] ** 2)) < 1.05
    left_out = [limit for limit in limits_of(data.runs, PIERBURG, data.noise) if limit.kind == "begins_moving"]
    assert len(left_out) == (run.time[0] > 0.0)
