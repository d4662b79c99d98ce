"""The residual torque: finds a torque that was put there, and helps where the catalogue does not."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from pierburg_ros.diagnosis.evidence.data import evidence_of
from pierburg_ros.diagnosis.search.explanation import Explanation
from pierburg_ros.diagnosis.verdict.recalibrations import recalibrations
from pierburg_ros.diagnosis.verdict.residual_shape import described, described_over_time, fit_shape, nodes
from support.recordings import NOMINAL, PIERBURG, recording

from pierburg_ros.recording import read_recording

pytestmark = pytest.mark.search

RELAXATION = Path(__file__).parents[2] / "../shared/practice/practice-20"
STIFFER = {"nonlinear_spring.cubic_stiffness": 0.04}


def as_described(_):
    """The nominal model, whatever the data."""
    return NOMINAL


@pytest.fixture(scope="module")
def hidden():
    """A stiffening spring that the shape does not know of, and what the nominal model makes of it."""
    data = evidence_of([recording(STIFFER, duration=36.0)], PIERBURG)
    return data, fit_shape(data, [as_described])


def test_takes_the_torque_that_was_hidden(hidden):
    """Within 0.008 N.m up to 1.1 rad: further up the prior holds the shape down, since few samples ask for much."""
    _, shape = hidden
    grid = shape.model.residual_torque
    middle = grid["torque"][:, grid["velocity"] > 0.0].mean(axis=1)
    inner = (grid["angle"] > 0.3) & (grid["angle"] < 1.1)
    np.testing.assert_allclose(middle[inner], 0.04 * grid["angle"][inner] ** 3, atol=0.008)


def test_lowers_the_error_on_samples_that_did_not_train_it(hidden):
    data, shape = hidden
    assert shape.after < 0.5 * shape.before
    residual = data.residual(shape.model)[data.choosing] * data.noise
    assert shape.after == pytest.approx(np.sqrt(np.mean(residual**2)))


def test_is_fitted_to_training_samples_only(hidden):
    data, shape = hidden
    run = data.runs[0]
    spoilt = replace(run, measured=np.where(run.training, run.measured, 2.0))
    grid = nodes(data)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("pierburg_ros.diagnosis.verdict.residual_shape.nodes", lambda _: grid)
        patch.setattr("pierburg_ros.diagnosis.verdict.residual_shape.restarted", restarted_like(data))
        again = fit_shape(replace(data, runs=(spoilt,)), [as_described])
    np.testing.assert_allclose(again.model.residual_torque["torque"], shape.model.residual_torque["torque"])


def restarted_like(data):
    """Restarts at the states of `data`, with the measured samples of whatever is given."""
    from pierburg_ros.diagnosis.evidence.stretches import restarted

    def restart(given, length):
        measured = np.concatenate([run.measured for run in given.runs])
        cut = restarted(data, length)
        edges = np.cumsum([run.time.size for run in cut.runs])[:-1]
        parts = np.split(measured, edges)
        runs = tuple(replace(run, measured=part) for run, part in zip(cut.runs, parts, strict=True))
        return replace(cut, runs=runs)

    return restart


def test_model_file_keeps_the_shape(hidden, tmp_path):
    data, shape = hidden
    shape.model.write(tmp_path / "model.yaml")
    again = type(NOMINAL).read(tmp_path / "model.yaml")
    run = data.runs[0]
    np.testing.assert_allclose(run.simulated(again), run.simulated(shape.model), atol=1e-9)


def test_words_say_where_and_which_way():
    angle, velocity = np.array([0.0, 1.0]), np.array([-1.0, 1.0])
    text = described(angle, velocity, np.array([[-0.02, 0.01], [0.0, 0.05]]))
    assert "0.050 N.m that closes at 57 degrees and 1 rad/s" in text
    assert "0.020 N.m that opens at 0 degrees and -1 rad/s" in text
    assert "resists the movement" in text


def test_words_say_how_it_goes_over_time():
    time = np.linspace(0.0, 60.0, 13)
    assert "grows by 0.060 N.m" in described_over_time(time, 0.001 * time)
    assert "without a trend" in described_over_time(time, 0.02 * np.sin(time))
    assert "too little movement" in described_over_time(time, np.full(time.size, np.nan))


@pytest.mark.skipif(not RELAXATION.exists(), reason="the practice recordings are not beside this checkout")
def test_helps_where_the_spring_relaxes():
    """A Maxwell element, which no catalogue effect is; the holdout recording is of another excitation."""
    data = evidence_of([read_recording(RELAXATION / "train.mcap")], PIERBURG)
    shape = fit_shape(data, recalibrations(NOMINAL, Explanation(PIERBURG.free[:5])))
    unseen = evidence_of([read_recording(RELAXATION / "holdout.mcap")], PIERBURG)
    nominal, final = (np.mean(unseen.residual(model) ** 2) for model in (NOMINAL, shape.model))
    assert final < nominal
