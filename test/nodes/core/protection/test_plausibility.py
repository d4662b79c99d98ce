"""Which samples are passed over, and which are believed."""

import math

import pytest

from pierburg_ros.nodes.core.protection.plausibility import CONFIRMATIONS, Plausibility, band

TICK = 2_000_000


@pytest.fixture
def plausibility():
    return Plausibility(band(0.42, 4.52, 0.05, 29.4, math.pi / 2))


def judged(plausibility, voltages):
    """Name of the objection to each voltage, tick by tick."""
    found = [plausibility.objection(voltage, tick * TICK) for tick, voltage in enumerate(voltages)]
    return [each.name if each else None for each in found]


@pytest.mark.parametrize("voltage", [0.0, 5.0, 4.73, 0.21, -1e306, 1e306])
def test_rails_and_more_are_outside_the_band(plausibility, voltage):
    assert judged(plausibility, [2.0, voltage, 2.0]) == [None, "hall_voltage_implausible", None]


@pytest.mark.parametrize("voltage", [math.nan, math.inf, -math.inf])
def test_what_is_not_finite_is_named_so(plausibility, voltage):
    assert judged(plausibility, [voltage, 2.0]) == ["hall_voltage_not_finite", None]


def test_a_spike_inside_the_band_is_passed_over(plausibility):
    assert judged(plausibility, [2.0, 3.0, 2.0]) == [None, "hall_voltage_too_fast", None]


def test_the_fastest_shaft_is_believed(plausibility):
    step = 19.6 * 4.1 / (math.pi / 2) * 0.002
    assert set(judged(plausibility, [0.42 + step * k for k in range(40)])) == {None}


def test_a_jump_that_stays_is_believed_after_a_few_samples(plausibility):
    found = judged(plausibility, [2.0] + [3.0] * 5)
    assert found == [None] + ["hall_voltage_too_fast"] * (CONFIRMATIONS - 1) + [None] * (6 - CONFIRMATIONS)


def test_samples_that_contradict_each_other_are_never_believed(plausibility):
    assert set(judged(plausibility, [2.0] + [3.0, 4.0] * 3)[1:]) == {"hall_voltage_too_fast"}


def test_after_a_pause_the_shaft_may_be_anywhere_in_the_band(plausibility):
    plausibility.objection(0.5, 0)
    assert plausibility.objection(4.4, 60_000_000) is None
