"""How far stamps are off, of signals with stamps that were moved by a known amount."""

import numpy as np
import pytest

from pierburg_ros.recording.stamps import stamp_error

PERIOD = 0.002
NOISE = 0.001
OFF = 0.0002


def swinging(time):
    """A signal of 2 V that swings at 1 Hz and moves at 12.6 V/s at most."""
    return 2.0 * np.sin(2.0 * np.pi * time)


def measured(true, seed=100):
    return swinging(true) + NOISE * np.random.default_rng(seed).standard_normal(true.size)


def test_a_clock_that_is_even_is_not_off():
    time = PERIOD * np.arange(5000)
    assert stamp_error(time, measured(time), NOISE) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("seed", range(5))
def test_stamps_are_off_by_what_they_were_moved(seed):
    true = PERIOD * np.arange(20_000)
    stamped = true + OFF * np.random.default_rng(seed).standard_normal(true.size)
    assert stamp_error(stamped, measured(true), NOISE) == pytest.approx(OFF, rel=0.2)


@pytest.mark.parametrize("seed", range(5))
def test_samples_that_are_uneven_indeed_are_not_off(seed):
    """The stamps are right: a tenth of the unevenness is what noise leaves open."""
    time = PERIOD * np.arange(20_000) + OFF * np.random.default_rng(seed).standard_normal(20_000)
    assert stamp_error(time, measured(time), NOISE) < 0.15 * OFF


def test_a_signal_at_rest_does_not_tell():
    stamped = PERIOD * np.arange(20_000) + OFF * np.random.default_rng(0).standard_normal(20_000)
    assert stamp_error(stamped, np.full(stamped.size, 2.0), 1e-12) == 0.0


def test_a_gap_is_no_error_of_a_stamp():
    time = PERIOD * np.arange(5000)
    time[2500:] += 1.0
    assert stamp_error(time, measured(time), NOISE) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("samples", (2, 5, 11, 20))
def test_short_signals_have_an_answer(samples):
    time = PERIOD * np.arange(samples)
    assert stamp_error(time, measured(time), NOISE) == pytest.approx(0.0, abs=1e-9)
