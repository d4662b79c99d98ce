"""Recordings that lack messages: where they are cut, and what the losses within a piece may add to the error."""

from dataclasses import replace

import numpy as np
import pytest
from support.recordings import NOISE, NOMINAL, recording

from pierburg_ros.errors import InputError
from pierburg_ros.estimation.data import all_training, data_of, in_parts
from pierburg_ros.estimation.estimator import Estimator
from pierburg_ros.estimation.initial_state import first_rest
from pierburg_ros.estimation.intervals import covariance
from pierburg_ros.estimation.pieces import pieces
from pierburg_ros.estimation.run import parts_of
from pierburg_ros.inference.explanation import Explanation
from pierburg_ros.recording import Channel, Recording
from pierburg_ros.recording.loss import Loss, numbered_loss


def without(made: Recording, lost: np.ndarray) -> Recording:
    """`made` without the duty messages at `lost`, flags of shape (messages,), and with what their numbers tell."""
    time, values, number = made.command.time[~lost], made.command.values[~lost], np.arange(lost.size)[~lost]
    return replace(made, command=Channel(time, values), losses=(numbered_loss("duty", time, number),))


def every_sample(made: Recording) -> Recording:
    """`made` with a duty message for every sample."""
    return replace(made, command=Channel(made.time, made.command.at(made.time, before=0.0)))


def steps_lost(share: float, seed: int = 0) -> tuple[Recording, Recording]:
    """Random steps of duty, whole and with a share of the duty messages missing."""
    whole = every_sample(recording({}, duration=40.0))
    lost = np.random.default_rng(seed).random(whole.command.time.size) < share
    lost[0] = lost[-1] = False
    return whole, without(whole, lost)


def test_a_whole_recording_is_one_piece() -> None:
    whole, _ = steps_lost(0.0)
    cut = pieces(whole, NOMINAL)
    assert cut.parts == [whole] and cut.uncertainty == 0.0 and cut.left_out == ()


def test_losses_while_the_duty_stands_cost_nothing() -> None:
    whole, _ = steps_lost(0.0)
    stands = np.zeros(whole.command.time.size, dtype=bool)
    stands[1:-1] = (np.diff(whole.command.values)[1:] == 0.0) & (np.diff(whole.command.values)[:-1] == 0.0)
    lost = stands & (np.random.default_rng(1).random(stands.size) < 0.2)
    cut = pieces(without(whole, lost), NOMINAL)
    assert len(cut.parts) == 1 and cut.uncertainty == 0.0


def test_a_step_that_may_have_come_at_any_moment_is_cut_out() -> None:
    whole, _ = steps_lost(0.0)
    steps = np.flatnonzero(np.abs(np.diff(whole.command.values)) > 0.1) + 1
    lost = np.zeros(whole.command.time.size, dtype=bool)
    lost[steps[3]] = True
    cut = pieces(without(whole, lost), NOMINAL)
    assert list(cut.left_out) == [(whole.command.time[steps[3] - 1], whole.command.time[steps[3] + 1])]
    assert len(cut.parts) == 2 and cut.parts[1].time[0] >= cut.left_out[0][1]


def test_what_follows_a_gap_begins_at_a_standstill() -> None:
    _, lossy = steps_lost(0.2)
    parts, cut = parts_of(lossy, NOMINAL)
    assert len(cut.left_out) > 3
    for part in parts[1:]:
        assert np.ptp(part.measured[:25]) < 10.0 * NOISE


def test_a_piece_begins_where_the_shaft_no_longer_creeps() -> None:
    time = 0.002 * np.arange(2000)
    creeping = 1.0 + 0.02 * np.exp(-time / 0.15)
    rest = first_rest(creeping + NOISE * np.random.default_rng(3).standard_normal(time.size), NOISE)
    assert rest is not None and creeping[rest] - 1.0 < 1.5 * NOISE
    assert first_rest(1.0 + time, NOISE) is None


def test_the_true_model_leaves_the_noise_and_what_the_losses_add() -> None:
    whole, lossy = steps_lost(0.2)
    held = replace(lossy, losses=())
    errors = {
        name: np.std(data_of([made], NOMINAL).residual(NOMINAL))
        for name, made in (("whole", whole), ("pieces", lossy), ("held", held))
    }
    assert errors["whole"] == pytest.approx(1.0, abs=0.05)
    assert errors["pieces"] < 1.2 < errors["held"]


def test_a_jittery_duty_adds_to_the_noise() -> None:
    whole, _ = steps_lost(0.0)
    random = np.random.default_rng(2)
    jittery = replace(
        whole,
        command=Channel(
            whole.command.time, np.clip(whole.command.values + 0.01 * random.standard_normal(whole.time.size), -1, 1)
        ),
    )
    lost = random.random(whole.command.time.size) < 0.2
    lost[0] = lost[-1] = False
    few = pieces(without(jittery, lost & (random.random(lost.size) < 0.25)), NOMINAL).uncertainty
    many = pieces(without(jittery, lost), NOMINAL).uncertainty
    assert 0.0 < few < many


def test_nothing_but_gaps_is_refused() -> None:
    whole, _ = steps_lost(0.0)
    middle = tuple((float(t), float(t) + 0.5) for t in np.arange(0.0, 39.0, 0.55))
    with pytest.raises(InputError, match="has no stretch of 100 samples with a known duty"):
        parts_of(replace(whole, losses=(Loss("duty", 3000, 20000, middle),)), NOMINAL)


def test_a_fit_with_pieces_that_do_not_train_has_a_covariance() -> None:
    _, lossy = steps_lost(0.2)
    estimator = Estimator(in_parts(data_of([lossy], NOMINAL)), NOMINAL)
    fit = estimator.fit(Explanation(("armature_resistance",)))
    known, slopes = covariance(estimator, fit)
    assert np.isfinite(known.matrix).all() and slopes.shape == (fit.solution.residual.size, 1)


def test_the_duration_is_that_of_the_first_recording_that_is_left() -> None:
    data = all_training(data_of([recording({}, duration=12.0), recording({}, duration=20.0)], NOMINAL))
    assert data.several and data.duration == pytest.approx(11.998)
    assert replace(data, runs=data.runs[1:]).duration == pytest.approx(19.998)
