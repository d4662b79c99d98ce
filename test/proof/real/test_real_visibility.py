"""What a recording can show of a change, beside what its model misses."""

from dataclasses import replace

import numpy as np
import pytest
from support.recordings import NOISE, NOMINAL, recording

from pierburg_ros.proof.real.visibility import visibility

DELAY = "input_delay.delay"


def delayed(by):
    return NOMINAL.with_values({DELAY: by})


@pytest.fixture(scope="module")
def clean():
    """A recording of the nominal valve."""
    return recording({}, duration=8.0, seed=3)


@pytest.fixture(scope="module")
def wandering(clean):
    """The same beside a wave of a hundred noises that no model has."""
    wave = 100.0 * NOISE * np.sin(2.0 * np.pi * 0.7 * clean.time)
    return replace(clean, measured=clean.measured + wave)


def test_a_long_delay_is_shown_and_a_very_short_one_is_not(clean):
    long, short = (visibility(clean, NOMINAL, delayed(by), DELAY) for by in (0.02, 2e-5))
    assert long.shown and long.moves > 3.0 * NOISE
    assert not short.shown and short.distance < 100.0


def test_twice_the_delay_moves_twice_as_far(clean):
    one, two = (visibility(clean, NOMINAL, delayed(by), DELAY) for by in (0.002, 0.004))
    assert two.moves == pytest.approx(2.0 * one.moves, rel=0.1)
    assert two.distance == pytest.approx(4.0 * one.distance, rel=0.2)


def test_what_moves_less_than_what_remains_is_not_shown(clean, wandering):
    seen, hidden = (visibility(each, NOMINAL, delayed(0.01), DELAY) for each in (clean, wandering))
    assert hidden.moves == pytest.approx(seen.moves, rel=0.1)
    assert seen.shown and hidden.remains > hidden.moves and not hidden.shown
    assert hidden.distance < seen.distance


def test_a_change_that_a_drift_makes_as_well_is_not_shown(clean):
    """At a standstill and in motion a voltage drives as a torque constant over a resistance does."""
    supply = visibility(clean, NOMINAL, NOMINAL.with_values({"supply_voltage": 13.6}), "supply_voltage")
    assert supply.moves < supply.remains and not supply.shown
