"""Faults of the sensor and what they are answered with, sample by sample; a healthy sensor notices nothing."""

import math

import numpy as np
import pytest

from pierburg_ros.actuators import read_actuator
from pierburg_ros.control import Controller, Setpoints
from pierburg_ros.nodes.core.controller_parameters import CONTROLLER, PROTECTION, WINDING
from pierburg_ros.nodes.core.guarded_controller import RETURN, GuardedController
from pierburg_ros.nodes.core.sampled_controller import SampledController

TICK = 2_000_000
DEFAULTS = {each.name: each.default for each in (*CONTROLLER, *PROTECTION, *WINDING)}


def loop():
    return SampledController(Controller(), Setpoints(initial=0.8))


def guarded(**values):
    return GuardedController(loop(), read_actuator("pierburg"), {**DEFAULTS, **values})


class Bench:
    """The sliding equation of the paper with the numbers of Table I, and a sensor that can be broken."""

    def __init__(self, controller, noise=0.003):
        self.controller, self.noise = controller, noise
        self.random = np.random.default_rng(1)
        self.angle, self.duty, self.tick = 0.0, 0.0, 0

    def good(self):
        drive = 2.677 * self.duty - 0.29 - 0.1419 * self.angle
        if abs(drive) > 0.2007:
            self.angle += 0.002 * (drive - math.copysign(0.2007, drive)) / 0.1627
        self.angle = min(max(self.angle, 0.0), math.pi / 2)
        return 0.42 + 4.1 * self.angle / (math.pi / 2) + self.noise * self.random.standard_normal()

    def run(self, samples, broken=None):
        """Duties of so many samples, `broken` turning a good one and its number into what the sensor says."""
        duties = []
        for k in range(samples):
            self.tick += 1
            voltage = self.good()
            self.duty = self.controller.duty(broken(voltage, k) if broken else voltage, self.tick * TICK)
            duties.append(self.duty)
        return duties


def first_zero(duties):
    """Seconds until the duty is 0."""
    return duties.index(0.0) * 0.002


@pytest.mark.parametrize("noise", [0.0, 0.003, 0.02])
def test_a_healthy_loop_gets_bit_for_bit_the_duties_of_the_law(noise):
    plain, protected = Bench(loop(), noise), Bench(guarded(), noise)
    for setpoint in (0.8, 1.5, 0.1, 0.0, 1.5707, 0.7):
        plain.controller.setpoints.offer(setpoint)
        protected.controller.loop.setpoints.offer(setpoint)
        assert protected.run(1000) == plain.run(1000)
    assert protected.controller.counts.passed_over == 0


@pytest.mark.parametrize(
    ("voltage", "name"),
    [
        (0.0, "hall_voltage_implausible"),
        (5.0, "hall_voltage_implausible"),
        (1e306, "hall_voltage_implausible"),
        (math.nan, "hall_voltage_not_finite"),
    ],
)
def test_a_broken_sensor_is_named_and_the_duty_0_within_50_ms_and_stays(voltage, name):
    bench = Bench(guarded())
    assert bench.run(500)[-1] > 0.1
    duties = bench.run(500, lambda *_: voltage)
    assert first_zero(duties) < 0.05
    assert set(duties[25:]) == {0.0}
    assert bench.controller.lost.name == name


def test_a_frozen_sensor_is_found_within_50_ms_of_a_duty_that_should_move_the_shaft():
    bench = Bench(guarded(frozen_retry=0.0))
    bench.run(500)
    bench.controller.loop.setpoints.offer(1.4)
    duties = bench.run(2000, lambda *_: 2.3)
    assert first_zero(duties) < 0.05
    assert set(duties[25:]) == {0.0}
    assert bench.controller.lost.name == "hall_voltage_frozen"
    assert bench.run(200)[-1] > 0.1


def test_a_frozen_sensor_is_tried_again_ever_more_seldom():
    bench = Bench(guarded())
    bench.run(500)
    bench.controller.loop.setpoints.offer(1.4)
    duties = np.array(bench.run(10_000, lambda *_: 2.3))
    assert np.count_nonzero(duties) < 0.02 * duties.size
    tries = np.flatnonzero(np.diff((duties != 0.0).astype(int)) == 1) * 0.002
    assert np.all(np.diff(np.diff(tries)) > 0.5)


def test_single_spikes_do_not_swing_the_duty():
    bench = Bench(guarded())
    bench.run(1500)
    calm = np.ptp(bench.run(1000))
    assert np.ptp(bench.run(1000, lambda good, k: 5.0 if k % 100 == 50 else good)) <= 1.5 * calm + 0.02
    assert bench.controller.lost is None


@pytest.mark.parametrize("on_fault", ["release", "hold", "close"])
def test_the_return_leaves_from_the_duty_that_was_out(on_fault):
    bench = Bench(guarded(on_fault=on_fault))
    bench.run(1000)
    last = bench.run(300, lambda *_: 5.0)[-1]
    duties = [last, *bench.run(RETURN + 1)]
    assert np.max(np.abs(np.diff(duties))) < 0.25
    assert bench.controller.lost is None


def test_hold_keeps_the_duty_for_its_time_and_close_drives_towards_closed():
    held, closed = Bench(guarded(on_fault="hold", hold_time=0.2)), Bench(guarded(on_fault="close"))
    before = held.run(1000)[-1]
    duties = held.run(200, lambda *_: 5.0)
    assert len(set(duties[20:100])) == 1
    assert duties[20] == pytest.approx(before, abs=0.1)
    assert duties[-1] == 0.0
    closed.run(1000)
    assert closed.run(200, lambda *_: 5.0)[-1] == -0.2


def test_one_good_sample_among_bad_ones_is_no_return():
    bench = Bench(guarded())
    bench.run(1000)
    bench.run(100, lambda *_: 5.0)
    assert set(bench.run(200, lambda good, k: good if k % 3 == 0 else 0.0)) == {0.0}


def test_the_same_time_again_repeats_the_duty_until_silence_is_said():
    controller = guarded()
    bench = Bench(controller)
    duty = bench.run(100)[-1]
    assert duty > 0.0
    assert controller.duty(0.5, bench.tick * TICK) == duty
    assert controller.silence("the clock stands still", 0.0) == 0.0
    assert controller.duty(0.5, bench.tick * TICK) == 0.0


def test_a_jump_of_the_clock_is_bounded_and_counted_and_the_duty_does_not_jump():
    bench = Bench(guarded())
    before = bench.run(1500)[-100:]
    bench.tick += 500_000
    after = bench.run(100)
    assert bench.controller.counts.bounded_steps == 1
    assert max(after) <= max(before) + 0.1
    assert min(after) >= min(before) - 0.1


def test_a_shaft_blocked_for_30_s_under_a_live_sensor_is_limited_and_then_released():
    bench = Bench(guarded())
    duties = np.array(bench.run(15_000, lambda *_: 1.0 + 0.003 * bench.random.standard_normal()))
    current = duties * 13.5 / 4.139
    assert np.max(current[:1000]) > 2.0
    assert np.max(np.convolve(current**2, np.ones(5000) / 5000, "valid")[2000:]) < 2.0
    assert duties[-1] == 0.0 or bench.controller.winding.limited or 0.0 in duties[6000:]
