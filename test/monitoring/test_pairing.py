"""Samples and duties brought together, against the order in which the contract has them sent."""

import numpy as np

from pierburg_ros.monitoring.movements import Samples
from pierburg_ros.monitoring.pairing import Angle, Pairing

TICK = 2_000_000  # ns


def ticks(pairing, count, hall_first=True, skip_duty=(), skip_angle=()):
    """Ticks as the plant publishes them: Hall voltage, applied duty, joint states; duty k is k / 1000."""
    for k in range(count):
        at = k * TICK
        if hall_first and k not in skip_angle:
            pairing.angle(Angle(at, at, k, 0.1 * k))
        if k not in skip_duty:
            pairing.duty(at + 10_000, k, k / 1000.0)
        if not hall_first and k not in skip_angle:
            pairing.angle(Angle(at, at + 20_000, k, 0.1 * k))
    return pairing.paired(10**18)


def test_applied_duty_acts_from_the_sample_of_its_tick_on():
    for hall_first in (True, False):
        samples = ticks(Pairing(follows=hall_first, every_tick=True), 100, hall_first)
        assert np.allclose(samples.duty, samples.angle / 100.0)
        assert np.all(samples.whole[1:])


def test_a_commanded_duty_acts_from_the_sample_after_it():
    samples = ticks(Pairing(follows=False, every_tick=False), 100)
    assert np.allclose(samples.duty[1:], samples.angle[:-1] / 100.0)


def test_a_lost_duty_or_sample_leaves_no_whole_sample_there():
    pairing = Pairing(follows=True, every_tick=True)
    samples = ticks(pairing, 100, skip_duty=(40,), skip_angle=(70,))
    broken = np.round(samples.time[~samples.whole] / (TICK * 1e-9)).astype(int)
    assert set(broken) == {0, 40, 41, 71}
    assert pairing.lost == 2


def test_skipped_ticks_are_no_loss_but_a_long_gap_is():
    pairing = Pairing(follows=False, every_tick=False)
    times = np.cumsum([TICK] * 50 + [3 * TICK] + [TICK] * 50 + [40 * TICK] + [TICK] * 50)
    parts = []
    for number, time in enumerate(times):
        pairing.duty(int(time) - 1, number, 0.2)
        pairing.angle(Angle(int(time), int(time), number, 0.0))
        parts.append(pairing.paired(int(time)))
    broken = np.flatnonzero(~Samples.joined(parts).whole)
    assert pairing.lost == 0
    assert broken.tolist() == [0, 101]


def test_a_sample_waits_for_its_duty_and_no_longer_than_half_a_second():
    pairing = Pairing(follows=True, every_tick=False)
    pairing.duty(0, 0, 0.3)
    for number in (1, 2):
        pairing.angle(Angle(number * TICK, number * TICK, number, 0.0))
    assert pairing.paired(3 * TICK).time.size == 0
    assert pairing.paired(3 * TICK + 500_000_000).duty.tolist() == [0.3]


def test_what_is_not_finite_is_no_sample_and_no_duty():
    pairing = Pairing(follows=False, every_tick=False)
    pairing.duty(0, 0, np.nan)
    pairing.duty(1, 1, 2.0)
    pairing.angle(Angle(2, 2, 0, np.inf))
    pairing.angle(Angle(3, 3, 1, 0.5))
    pairing.angle(Angle(4, 4, 2, 0.5))
    samples = pairing.paired(10**18)
    assert samples.angle.tolist() == [0.5]
    assert samples.duty.tolist() == [1.0]


def test_a_measured_supply_counts_until_it_is_old():
    pairing = Pairing(follows=False, every_tick=False)
    pairing.duty(0, 0, 0.1)
    pairing.supply(0, 13.2)
    for number, second in enumerate((1, 2, 3, 9, 10)):
        pairing.angle(Angle(second * 10**9, second * 10**9, number, 0.0))
    supply = pairing.paired(10**18).supply_voltage
    assert supply[:3].tolist() == [13.2] * 3
    assert np.isnan(supply[3])
