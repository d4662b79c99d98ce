"""The play of a sensor, read from reversals: beside what no simulation says, and not from rests by friction."""

from dataclasses import replace

import numpy as np
import pytest
from support.recordings import NOISE, NOMINAL, data_on, recording

from pierburg_ros.diagnosis.search.reversals import directions, play_at_reversals
from pierburg_ros.diagnosis.search.scored import scored
from pierburg_ros.diagnosis.search.selection import PROMISING
from pierburg_ros.diagnosis.search.supported import PLAY, with_play
from pierburg_ros.diagnosis.search.weighing import Supported
from pierburg_ros.effects import EFFECT
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.estimator import Estimator
from pierburg_ros.inference.explanation import Explanation, Variant
from pierburg_ros.proof.real.channels import with_effect

WIDTH = 0.05


def measured(width: float) -> Data:
    """The valve, wrong by a slow wave of thirty times the noise, then dragged by a play that the recording adds."""
    clean = recording({}, duration=24.0)
    wave = 30.0 * NOISE * np.sin(2.0 * np.pi * clean.time / 7.0)
    wrong = replace(clean, measured=clean.measured + wave)
    return data_on(with_effect(wrong, "sensor_hysteresis", {"width": width}, NOMINAL) if width else wrong)


def test_the_direction_is_known_away_from_turning_points():
    triangle = np.concatenate([np.arange(0.0, 10.0), np.arange(10.0, 2.0, -1.0), np.arange(2.0, 8.0)])
    way, told = directions(triangle, 1.5)
    np.testing.assert_array_equal(np.flatnonzero(told), [*range(2, 9), *range(12, 17), *range(20, 24)])
    np.testing.assert_array_equal(way[told], np.repeat([1.0, -1.0, 1.0], [7, 5, 4]))


def test_a_play_shows_beside_a_slow_error():
    data = measured(WIDTH)
    found = play_at_reversals(data, Estimator(data, NOMINAL).at(Explanation()))
    assert found is not None and EFFECT[found.variant.effect].play == found.variant.fixed[0][0]
    assert found.variant.fixed[0][1] == pytest.approx(WIDTH, rel=0.1)
    assert found.gain > 300.0 and found.gain > 2.0 * found.left


def test_rests_that_friction_makes_are_no_play():
    data = measured(0.0)
    found = play_at_reversals(data, Estimator(data, NOMINAL).at(Explanation()))
    assert found is None or found.gain < PROMISING


def test_a_model_with_such_a_play_is_asked_for_no_other():
    data = measured(0.0)
    own = NOMINAL.with_values({"sensor_hysteresis.width": WIDTH})
    assert play_at_reversals(data, Estimator(data, own).at(Explanation())) is None


def test_a_play_is_named_only_where_the_likeliest_model_does_not_take_it_away():
    """What stands in for it may not be named: here it is a model that has the play from the start."""
    data = measured(WIDTH)
    estimator, own = Estimator(data, NOMINAL), {"sensor_hysteresis.width": WIDTH}
    bare = estimator.at(Explanation())
    named = Supported(NOMINAL, scored(data, bare), {})
    searched = estimator.at(Explanation((), (Variant("sensor_hysteresis", ("width",)),)), own)
    taken = Estimator(data, NOMINAL.with_values(own)).at(Explanation())
    for reached, has in ((bare, True), (searched, True), (taken, False)):
        found = with_play(named, reached, data, NOMINAL)
        assert [key.effect for key in found.weights if isinstance(key, Variant)] == ["sensor_hysteresis"] * has


def test_a_play_that_is_not_probable_is_doubted(monkeypatch):
    data = measured(WIDTH)
    bare = Estimator(data, NOMINAL).at(Explanation())
    play = play_at_reversals(data, bare)
    weak = replace(play, left=3.0 * play.gain)
    monkeypatch.setattr("pierburg_ros.diagnosis.search.supported.play_at_reversals", lambda *_: weak)
    found = with_play(Supported(NOMINAL, scored(data, bare), {}), bare, data, NOMINAL)
    assert not found.weights
    assert found.doubted["sensor_hysteresis"].confidence == pytest.approx(0.25)


@pytest.mark.parametrize(("gain", "named"), [(0.9, False), (1.1, True)])
def test_a_faint_play_is_not_named(monkeypatch, gain, named):
    """One of 0.0016 rad gained 20 in a closed loop with static friction."""
    data = measured(WIDTH)
    bare = Estimator(data, NOMINAL).at(Explanation())
    faint = replace(play_at_reversals(data, bare), gain=gain * PLAY, left=0.0)
    monkeypatch.setattr("pierburg_ros.diagnosis.search.supported.play_at_reversals", lambda *_: faint)
    assert bool(with_play(Supported(NOMINAL, scored(data, bare), {}), bare, data, NOMINAL).weights) == named
