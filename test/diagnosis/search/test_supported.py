"""Quantities that recordings support although something remains; none where only that is there."""

from dataclasses import replace

import numpy as np
import pytest
from support.recordings import NOISE, NOMINAL, data_on, recording

from pierburg_ros.diagnosis.search.supported import CONFIRMED, Supported, Weight, supported
from pierburg_ros.recording import Recording
from pierburg_ros.workers import workers


def disturbed(changes: dict[str, float], seed: int) -> Recording:
    """A recording of the valve with `changes` beside a slow wave of ten times the noise that no effect makes."""
    clean = recording(changes, duration=16.0, seed=seed)
    random = np.random.default_rng(seed + 100)
    knots = np.linspace(clean.time[0], clean.time[-1], 12)
    wave = np.interp(clean.time, knots, random.normal(0.0, 10.0 * NOISE, knots.size))
    wave[clean.time < 0.5] = 0.0
    return replace(clean, measured=clean.measured + wave)


def found_in(changes: dict[str, float], seed: int = 0) -> Supported | None:
    with workers(1) as pool:
        return supported(data_on(disturbed(changes, seed)), NOMINAL, pool, lambda _: None).named


def test_an_effect_is_named_beside_what_no_effect_makes():
    found = found_in({"input_delay.delay": 0.02})
    assert found is not None and found.scored.fit.explanation.effects == ("input_delay",)
    assert found.scored.fit.values["input_delay.delay"] == pytest.approx(0.02, abs=0.001)
    assert found.scored.discrepancy.size > 3.0


def test_nothing_is_named_where_only_that_is_there():
    assert found_in({}, seed=1) is None


def test_a_quantity_carries_what_it_gains_of_that_and_what_is_left():
    assert Weight(300.0, 100.0).carried == pytest.approx(0.75)
    assert Weight(-5.0, 100.0).carried == 0.0
    assert Weight(100.0, -5.0).carried == 1.0


def test_a_quantity_is_confirmed_by_what_unseen_samples_gain():
    there, bent = (Weight(300.0, 100.0, unseen, 50.0) for unseen in (45.0, 5.0))
    assert there.confirmed and not bent.confirmed
    assert there.confidence > 0.99 > bent.confidence
    assert Weight(300.0, 100.0).confirmed and Weight(300.0, 100.0).confidence == pytest.approx(0.75)
    assert 0.0 < CONFIRMED < 1.0


def test_what_unseen_samples_confirm_is_not_believed_where_it_carries_little():
    """As a supply that sags gains 134 on practice-20, where a spring relaxes and 2,483 is left."""
    little, much = (Weight(134.0, left, 40.0, 50.0) for left in (2483.0, 130.0))
    assert little.confirmed and not little.believed
    assert much.believed
