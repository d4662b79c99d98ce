"""The conversation with a simulated device: losses, repeats, resets, wrapping numbers, the clocks, the time-out."""

import random

import numpy as np
import pytest
from support.simulated_device import SimulatedDevice

from pierburg_ros.serial_line.link import Link

PERIOD = 2_000_000  # ns


def conversation(device, link, samples, spoil=lambda data: data, duty=None, delay=0):
    """What the link received of so many samples, each answered with a duty."""
    received = []
    for index in range(samples):
        received += link.take(spoil(device.tick()), index * PERIOD + delay)
        if duty is not None:
            device.take(link.command(duty, 0.05))
    return received


def test_a_duty_reaches_the_device_and_moves_the_valve():
    device, link = SimulatedDevice(), Link()
    received = conversation(device, link, 500, duty=0.22)
    assert [each.state.duty for each in received[1:]] == pytest.approx([0.22] * 499)
    assert received[-1].state.hall_voltage > received[0].state.hall_voltage + 0.5
    assert (link.lost, link.repeated, link.damaged, link.restarts) == (0, 0, 0, 0)


def test_lost_states_are_counted_by_their_numbers():
    device, link, chance = SimulatedDevice(), Link(), random.Random(1)
    kept = []

    def spoil(data):
        kept.append(len(kept) == 0 or chance.random() > 0.2)
        return data if kept[-1] else b""

    received = conversation(device, link, 1000, spoil)
    last = max(index for index, one in enumerate(kept) if one)
    assert len(received) == sum(kept)
    assert link.lost == kept[:last].count(False)


def test_repeated_frames_give_one_state():
    device, link = SimulatedDevice(), Link()
    assert len(conversation(device, link, 100, lambda data: data * 2)) == 100
    assert link.repeated == 100


def test_damaged_bytes_never_become_a_state():
    device, link, chance = SimulatedDevice(), Link(), random.Random(2)
    sent = []

    def spoil(data):
        clean = Link().take(data, 0)
        sent.append(clean[0].state)
        changed = bytearray(data)
        if chance.random() < 0.3:
            changed[chance.randrange(len(changed))] = chance.randrange(256)
        return bytes(changed)

    received = conversation(device, link, 2000, spoil)
    assert all(each.state in sent for each in received)
    assert len(received) > 1000
    assert link.damaged > 100


def test_a_reset_is_told_and_times_go_on():
    device, link = SimulatedDevice(), Link()
    conversation(device, link, 300)
    device.reset()
    received = []
    for index in range(300, 600):
        received += link.take(device.tick(), index * PERIOD)
    assert [each.restarted for each in received] == [True] + [False] * 299
    assert link.restarts == 1
    assert link.lost == 0
    assert np.allclose([each.time for each in received], np.arange(300, 600) * PERIOD, atol=1000)


def test_numbers_and_clock_wrap_without_loss():
    device, link = SimulatedDevice(ticks=2**32 - 400_000, number=2**16 - 100), Link()
    received = conversation(device, link, 500)
    assert (link.lost, link.repeated) == (0, 0)
    assert np.all(np.diff([each.time for each in received]) > 0)


def test_the_device_returns_to_duty_0_when_commands_stop():
    device, link = SimulatedDevice(), Link()
    conversation(device, link, 50, duty=0.3)
    received = []
    for index in range(50, 100):
        received += link.take(device.tick(), index * PERIOD)
    held = [each.state.duty > 0.0 for each in received]
    assert held.index(False) in (25, 26, 27)
    assert not any(held[27:])
    assert received[-1].state.timed_out


@pytest.mark.parametrize("drift", [-300e-6, 0.0, 100e-6])
def test_stamps_follow_a_drifting_clock_through_jitter_of_the_line(drift):
    """Delays of 0.2 ms and more, exponential with 2 ms, as a busy host sees them; stamps may be late by the least."""
    device, link, chance = SimulatedDevice(), Link(), np.random.default_rng(3)
    errors = []
    for index in range(15_000):
        truth = round(index * PERIOD * (1.0 + drift))
        arrival = truth + 200_000 + round(chance.exponential(2e6))
        errors += [each.time - truth for each in link.take(device.tick(), arrival)]
    settled = np.array(errors[10_000:])
    assert link.rate == pytest.approx(drift, abs=40e-6)
    assert np.all(settled > 0)
    assert np.quantile(settled, 0.99) < 500_000
