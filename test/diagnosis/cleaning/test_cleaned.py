"""Dirty signals are cleaned of what is no motion, and clean ones are left alone to the last bit."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from support.recordings import NOISE, recording

from pierburg_ros.diagnosis.cleaning.cleaned import cleaned
from pierburg_ros.diagnosis.cleaning.hum import hum, standing
from pierburg_ros.diagnosis.cleaning.outliers import outliers
from pierburg_ros.diagnosis.cleaning.saturation import saturated
from pierburg_ros.recording import read_recording

SHARED = Path(__file__).parents[4] / "shared"
RANDOM = np.random.default_rng
ONE = recording({})
"""24 s of random steps, some to the stops: the fastest motion that the valve has."""


def spiked(share, seed=1):
    """ONE with a share of its samples off by 0.1 to 2 V, and where."""
    random = RANDOM(seed)
    where = random.random(ONE.time.size) < share
    height = random.uniform(0.1, 2.0, where.size) * random.choice([-1.0, 1.0], where.size)
    return ONE.measured + np.where(where, height, 0.0), where


@pytest.mark.parametrize("share", [0.001, 0.01, 0.03])
def test_spikes_are_found_and_nothing_else(share):
    measured, where = spiked(share)
    found = outliers(ONE.time, measured)
    assert np.count_nonzero(where & ~found) <= share * np.count_nonzero(where)
    assert np.count_nonzero(found & ~where) == 0


@pytest.mark.parametrize("factor", [1e-3, 1.0, 1e3])
def test_spikes_are_found_in_any_unit(factor):
    measured, _ = spiked(0.01)
    assert np.array_equal(outliers(ONE.time, factor * measured), outliers(ONE.time, measured))


@pytest.mark.parametrize(
    "motion",
    [
        np.abs(np.arange(-500, 500) % 100 - 50.0),
        (np.arange(1000) // 50 % 2).astype(float),
        np.sin(np.arange(1000) / 3.0),
        np.maximum(np.sin(np.arange(1000) / 10.0), 0.0),
        np.round(5.0 * np.sin(np.arange(1000) / 40.0)),
    ],
    ids=["triangles", "jumps", "20 samples a period", "bouncing", "steps of an encoder"],
)
def test_motion_is_no_spike_however_sharp(motion):
    noise = 1e-4 * RANDOM(0).standard_normal(motion.size)
    assert not np.any(outliers(np.arange(motion.size) / 500.0, motion + noise))
    assert not np.any(outliers(np.arange(motion.size) / 500.0, motion))


def test_the_end_of_a_converter_is_found_on_either_side():
    low, high = 0.8, 3.2
    found = saturated(ONE.time, np.clip(ONE.measured, low, high))
    beyond = (ONE.measured <= low) | (ONE.measured >= high)
    assert np.all(found[beyond])
    assert np.all(np.minimum(np.abs(ONE.measured - low), np.abs(ONE.measured - high))[found & ~beyond] < 5.0 * NOISE)


def test_a_stop_is_no_end_of_a_converter():
    resting = np.concatenate([np.full(3000, 0.42), ONE.measured])
    resting[:3000] += NOISE * RANDOM(2).standard_normal(3000)
    time = np.arange(resting.size) / 500.0
    assert not np.any(saturated(time, resting))
    step = 0.02
    assert not np.any(saturated(time, step * np.round(resting / step))), "a coarse converter repeats every value"
    exact = np.concatenate([np.full(3000, 0.42), 0.42 + np.linspace(0.0, 3.0, 3000), np.full(3000, 3.42)])
    assert not np.any(saturated(np.arange(exact.size) / 500.0, exact)), "without noise a stop repeats exactly"


@pytest.mark.parametrize("frequency", [50.0, 60.03, 99.95])
def test_hum_is_told_to_a_tenth(frequency):
    line = 0.01 * np.sin(2.0 * np.pi * frequency * ONE.time + 1.0)
    (found,) = hum(ONE.time, ONE.measured + line)
    assert found.frequency == pytest.approx(frequency, abs=0.02)
    assert np.std(found.at(ONE.time) - line) < 0.1 * np.std(line)


def test_hum_is_heard_only_while_the_shaft_stands():
    """What the duty does 50 times a second is motion."""
    moving = ONE.measured + np.where(standing(ONE.time, ONE.measured), 0.0, 0.02 * np.sin(100.0 * np.pi * ONE.time))
    assert hum(ONE.time, moving) == []
    assert hum(ONE.time[:1500], ONE.measured[:1500]) == []


def test_what_is_clean_is_the_same_recording():
    found = cleaned(ONE)
    assert found.recording is ONE and found.omissions == () and found.remarks == ()


def test_a_motor_that_starts_at_once_was_no_converter_at_its_end():
    """An encoder's speed has noise while it turns, and none at rest."""
    speed = np.where(ONE.time < 3.0, 0.0, 20.0 + 0.2 * np.random.default_rng(1).standard_normal(ONE.time.size))
    assert saturated(ONE.time, speed).any()
    given = replace(ONE, measured=speed, quantity="speed")
    assert cleaned(given).recording is given


def test_each_is_said_with_what_is_left_out():
    measured, _ = spiked(0.01)
    given = replace(ONE, measured=measured + 0.01 * np.sin(100.0 * np.pi * ONE.time))
    found = cleaned(given, number=2)
    assert found.recording.time.size == ONE.time.size - np.count_nonzero(outliers(ONE.time, given.measured))
    (omission,) = found.omissions
    assert omission.number == 2 and "single samples" in omission.why
    assert len(found.remarks) == 2 and "mains" in found.remarks[1]


@pytest.mark.parametrize("folder", ["practice", "data/xl330"])
def test_real_and_practice_recordings_are_left_alone(folder):
    files = sorted((SHARED / folder).rglob("*.mcap"))[::9]
    if not files:
        pytest.skip(f"no recordings in {folder}")
    for file in files:
        given = read_recording(file)
        assert cleaned(given).recording is given
