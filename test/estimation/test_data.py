"""What fits see of recordings: noise, and the samples that train, validate and test."""

from dataclasses import replace

import numpy as np
import pytest
from support.recordings import NOISE, NOMINAL, data_on, recording

from pierburg_ros.errors import InputError
from pierburg_ros.estimation.data import all_training, data_of, held_back, with_validation
from pierburg_ros.recording import Recording


@pytest.mark.parametrize("duration", [5.0, 60.0])
def test_of_eight_blocks_six_train_one_validates_and_one_tests(duration: float) -> None:
    data = data_on(recording({}, duration=duration))
    assert np.mean(data.train) == pytest.approx(0.75, abs=0.02)
    assert np.mean(data.validation) == pytest.approx(0.125, abs=0.02)
    assert np.all(data.train.astype(int) + data.validation + data.test == 1)
    # Blocks last 1.5 s, or a sixteenth of a short recording: 5 cycles of 4 edges, or 2.
    assert np.count_nonzero(np.diff(data.train.astype(int))) == (20 if duration == 60.0 else 8)


def test_what_is_held_back_is_taken_from_training() -> None:
    data = data_on(recording({}))
    inner = held_back(data)
    assert np.mean(inner.train) == pytest.approx(0.5, abs=0.02)
    assert np.all(data.train | ~inner.train)
    np.testing.assert_array_equal(inner.validation, data.validation)


def test_after_the_choice_all_train_but_what_tests() -> None:
    data = data_on(recording({}))
    last = with_validation(data)
    np.testing.assert_array_equal(last.train, ~data.test)
    np.testing.assert_array_equal(last.test, data.test)
    assert not np.any(last.validation)


def test_without_parts_every_sample_trains() -> None:
    for data in (data_of([recording({}, duration=5.0)], NOMINAL), all_training(data_on(recording({}, duration=5.0)))):
        assert np.all(data.train)
        assert not np.any(data.validation) and not np.any(data.test)


def test_the_true_model_leaves_residuals_of_size_one() -> None:
    data = data_on(recording({}))
    assert data.noise == pytest.approx(NOISE, rel=0.03)
    assert np.std(data.residual(NOMINAL)) == pytest.approx(1.0, abs=0.03)


def test_residuals_of_several_recordings_follow_one_another() -> None:
    first, second = recording({}, duration=4.0), recording({}, duration=6.0, seed=1)
    both, alone = data_on(first, second), data_on(first)
    residual = both.residual(NOMINAL) * both.noise
    assert residual.size == first.time.size + second.time.size == both.train.size
    np.testing.assert_allclose(residual[: first.time.size], alone.residual(NOMINAL) * alone.noise)


def test_a_first_part_is_the_same_recording_cut_short() -> None:
    data = data_on(recording({}, duration=10.0))
    part = data.cut(4.0)
    assert part.duration == pytest.approx(4.0, abs=0.003)
    np.testing.assert_array_equal(part.residual(NOMINAL), data.residual(NOMINAL)[: part.train.size])


def test_recordings_of_two_quantities_are_refused() -> None:
    volts = recording({}, duration=5.0)
    angle = Recording("bench", "position", volts.time, (volts.measured - 0.42) / 4.1 * np.pi / 2, volts.command)
    with pytest.raises(InputError, match="hold Hall voltage and position; expected one quantity"):
        data_of([volts, angle], NOMINAL)


def test_no_recording_is_refused() -> None:
    with pytest.raises(InputError, match="There is no recording to fit"):
        data_of([], NOMINAL)


@pytest.mark.parametrize("begin", [0.64, 1.24, 2.42, 2.78, 3.04, 3.34, 5.72])
def test_a_recording_may_begin_anywhere(begin: float) -> None:
    """Of a valve that lags behind an inductance and a delay: at rest on the spring, in motion, pressed open."""
    true = {"armature_inductance.inductance": 0.01, "input_delay.delay": 0.01}
    data = data_on(recording(true).select(begin, 24.0))
    run = data.runs[0]
    error = data.residual(NOMINAL.with_values(true))
    assert np.sqrt(np.mean(error[run.time - run.time[0] < 4.0] ** 2)) < 1.05


def test_stamps_that_are_off_count_as_noise_and_as_no_evidence() -> None:
    """Samples and duty are stamped off by a tenth of a period: the true model leaves no more than the noise told."""
    true = recording({})
    random = np.random.default_rng(3)

    def shaken(time: np.ndarray) -> np.ndarray:
        return np.sort(time + 0.0002 * random.standard_normal(time.size))

    duty = replace(true.command, time=shaken(true.command.time))
    off = data_on(replace(true, time=shaken(true.time), command=duty))
    sharp = data_on(true)
    assert sharp.unlike < 1e-3 * sharp.noise and off.unlike > 0.1 * off.noise
    assert off.noise == pytest.approx(np.hypot(sharp.noise, off.unlike), rel=0.02)
    left = np.sqrt(np.mean(np.square(off.residual(NOMINAL))))
    assert 0.9 < left < 1.03 < left * off.noise / sharp.noise
