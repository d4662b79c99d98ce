"""Recording a trial: open and closed loop, change in the middle, and what a bench would have logged."""

from dataclasses import replace

import numpy as np
import pytest

from pierburg_ros.proof.bench import record
from pierburg_ros.proof.concealment import draw
from pierburg_ros.proof.formulation import simulate_textbook
from pierburg_ros.proof.trial import Change
from pierburg_ros.recording import read_recording

OPEN = replace(draw("consistent", 0, 5), duration=8.0, holdout_duration=4.0, rate=500.0)
CLOSED = replace(draw("consistent", 1, 5), duration=8.0, holdout_duration=4.0, rate=500.0, controller={})


@pytest.mark.parametrize("trial", [OPEN, CLOSED])
def test_the_recording_is_what_the_recorded_duty_does(trial):
    run = record(trial)
    assert np.abs(simulate_textbook(trial.values, run.time, run.duty) - run.ideal).max() < 1e-6
    assert np.std(run.measured - run.ideal) == pytest.approx(trial.noise, rel=0.1)


def test_the_closed_loop_follows_its_setpoints():
    run = record(CLOSED)
    assert run.setpoints is not None and np.ptp(run.setpoints) > 0.5
    angle = (run.ideal - 0.42) / 4.1 * np.pi / 2
    assert np.median(np.abs(angle - np.maximum(run.setpoints, 0.0))) < 0.05


def test_unseen_data_have_other_excitation_and_noise():
    train, unseen = record(OPEN), record(OPEN, holdout=True)
    shared = unseen.time.size
    assert not np.array_equal(train.duty[:shared], unseen.duty)
    assert not np.array_equal((train.measured - train.ideal)[:shared], unseen.measured - unseen.ideal)


def test_a_change_acts_from_its_time_on_and_in_the_unseen_recording():
    change = Change("armature_resistance", 4.0, 4.139, 5.5)
    changed = replace(OPEN, kind="change", change=change)
    run, before = record(changed), record(OPEN)
    apart = np.abs(run.ideal - before.ideal)
    assert apart[run.time < 4.0].max() == 0.0 and apart[run.time > 4.1].max() > 0.001
    unseen = record(changed, holdout=True)
    after = simulate_textbook({"armature_resistance": 5.5}, unseen.time, unseen.duty)
    assert np.abs(unseen.ideal - after).max() < 1e-6


def test_what_is_written_reads_back(tmp_path):
    run = record(CLOSED)
    run.write(tmp_path / "train.mcap")
    recording = read_recording(tmp_path / "train.mcap")
    assert np.array_equal(recording.measured, run.measured)
    assert np.array_equal(recording.command.values, run.duty)
    assert recording.setpoints is not None
    assert np.array_equal(recording.setpoints.at(recording.time), run.setpoints)


def test_a_coarse_converter_is_in_the_log():
    coarse = replace(OPEN, kind="sensor_quantization", effects={"sensor_quantization.step": 0.03})
    measured = record(coarse).measured / 0.03
    assert np.abs(measured - np.round(measured)).max() < 1e-9
