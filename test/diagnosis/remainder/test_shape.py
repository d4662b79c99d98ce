"""The residual torque: finds a torque that was put there, and helps where the catalogue does not."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from support.recordings import NOMINAL, PIERBURG, data_on, recording

from pierburg_ros.diagnosis.evidence.stretches import restarted
from pierburg_ros.diagnosis.remainder import shape as module
from pierburg_ros.diagnosis.remainder.recalibrations import recalibrations
from pierburg_ros.diagnosis.remainder.shape import Shape, Way, described, described_over_time, fit_shape, nodes
from pierburg_ros.estimation.data import Data
from pierburg_ros.inference.explanation import Explanation
from pierburg_ros.plant import read_model
from pierburg_ros.recording import read_recording

RELAXATION = Path(__file__).parents[3] / "../shared/practice/practice-20"
STIFFER = {"nonlinear_spring.cubic_stiffness": 0.04}


def as_described(_):
    """The nominal model, whatever the data."""
    return NOMINAL


def fitted(data: Data, ways: list[Way]) -> Shape:
    with ThreadPoolExecutor(2) as pool:
        return fit_shape(data, ways, pool)


@pytest.fixture(scope="module")
def hidden():
    """A stiffening spring that the shape does not know of, and what the nominal model makes of it."""
    data = data_on(recording(STIFFER, duration=36.0))
    return data, fitted(data, [as_described])


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
    residual = data.residual(shape.model)[data.validation] * data.noise
    assert shape.after == pytest.approx(np.sqrt(np.mean(residual**2)))


def test_is_fitted_to_training_samples_only(hidden):
    data, shape = hidden
    run = data.runs[0]
    spoilt = replace(run, measured=np.where(run.train, run.measured, 2.0))
    grid = nodes(data)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, "nodes", lambda _: grid)
        patch.setattr(module, "in_stretches", restarted_like(data))
        again = fitted(replace(data, runs=(spoilt,)), [as_described])
    np.testing.assert_allclose(again.model.residual_torque["torque"], shape.model.residual_torque["torque"])


def restarted_like(data):
    """Restarts at the states of `data`, with the measured samples of whatever is given."""

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
    again = read_model(tmp_path / "model.yaml")
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


@pytest.mark.search
@pytest.mark.skipif(not RELAXATION.exists(), reason="the practice recordings are not beside this checkout")
def test_helps_where_the_spring_relaxes():
    """A Maxwell element, which no catalogue effect is; the holdout recording is of another excitation."""
    data = data_on(read_recording(RELAXATION / "train.mcap"))
    shape = fitted(data, recalibrations(NOMINAL, Explanation(PIERBURG.free[:5])))
    unseen = data_on(read_recording(RELAXATION / "holdout.mcap"))
    nominal, final = (np.mean(unseen.residual(model) ** 2) for model in (NOMINAL, shape.model))
    assert final < nominal


def test_the_way_is_taken_that_does_best_on_blocks_held_back():
    """A preload that has drifted is no torque over angle and velocity to be fitted where it can be recalibrated."""
    data = data_on(recording({"spring_preload": 0.33, **STIFFER}, duration=16.0))
    shape = fitted(data, [as_described, lambda _: NOMINAL.with_values({"spring_preload": 0.33})])
    assert shape.base.values["spring_preload"] == 0.33


def test_the_missing_torque_over_time_is_a_mean_where_the_shaft_moves(hidden):
    data, shape = hidden
    time, torque = shape.over_time
    assert time.shape == torque.shape
    assert np.all(np.diff(time) > 0.0) and time[0] > 0.0 and time[-1] < data.duration
    known = torque[np.isfinite(torque)]
    # 0.04 N.m/rad^3 up to the open stop.
    assert known.size > 10 and 0.0 < np.mean(known) < 0.04 * (np.pi / 2) ** 3


@pytest.mark.search
def test_four_ways_to_recalibrate_differ_where_physics_is_missing():
    data = data_on(recording(STIFFER, duration=12.0))
    models = [way(data) for way in recalibrations(NOMINAL, Explanation(("spring_preload",)))]
    assert models[0] is NOMINAL
    preloads = [model.values["spring_preload"] for model in models]
    assert len(set(preloads)) == 4
    # What stiffens with the opening is a larger preload on average, whichever way it is fitted.
    assert min(preloads[1:]) > preloads[0]


def test_nodes_stand_over_all_angles_where_nothing_is_known_to_move(monkeypatch):
    """Behind a converter as coarse as the movements: a real recording of a servo ended in a traceback."""
    data = data_on(recording({}, duration=12.0))
    still = module.motion_of(data.runs[0], data.actuator, data.noise)
    still = replace(still, moving=np.zeros_like(still.moving))
    monkeypatch.setattr(module, "motion_of", lambda *_: still)
    angle, _ = nodes(data)
    assert angle.size > 1 and still.angle.min() <= angle[0] < angle[-1] <= still.angle.max()
