"""What the shaft does, on a course that is known."""

from dataclasses import replace

import numpy as np
import pytest
from support.motions import drawn, run_along

from pierburg_ros.actuators import read_actuator
from pierburg_ros.diagnosis.motion import motion_of, slope
from pierburg_ros.diagnosis.quality import limits_of
from pierburg_ros.plant import Inputs

ROTOR = """
name: rotor
drive: voltage
load: none
sensor: speed
parameters:
  armature_resistance: {nominal: 10.0, minimum: 1.0, maximum: 100.0, origin: made up, free: false}
  torque_constant: {nominal: 0.2, minimum: 0.02, maximum: 2.0, origin: made up}
  gear_ratio: {nominal: 1.0, minimum: 0.5, maximum: 2.0, origin: made up, free: false}
  coulomb_friction: {nominal: 0.01, minimum: 0.0, maximum: 1.0, origin: made up}
  total_inertia: {nominal: 0.0003, minimum: 1.0e-6, maximum: 0.1, origin: made up}
  supply_voltage: {nominal: 7.4, minimum: 5.0, maximum: 9.0, origin: made up, free: false}
"""
TIME = np.sort(np.random.default_rng(2).uniform(0.0, 4.0, 2000))


def test_reads_angle_velocity_and_rest():
    motion = drawn()
    assert motion.angle[:500] == pytest.approx(0.0, abs=0.005)
    assert motion.velocity[(motion.time > 2.1) & (motion.time < 2.9)] == pytest.approx(1.0, abs=0.1)
    assert motion.moving.mean() == pytest.approx(2.5 / 10.0, abs=0.02)
    assert motion.time[motion.departures] == pytest.approx([2.0, 5.0, 7.0], abs=0.03)
    assert motion.time[motion.reversals] == pytest.approx([5.0], abs=0.03)


def test_counts_time_at_rest_and_since_reversal():
    motion = drawn()

    def at(values, moment):
        return values[np.searchsorted(motion.time, moment)]

    assert at(motion.time_at_rest, 1.5) == pytest.approx(1.5, abs=0.03)
    assert at(motion.time_at_rest, 5.1) == pytest.approx(2.0, abs=0.05)
    assert at(motion.time_at_rest, 5.8) == 0.0
    assert at(motion.time_since_reversal, 6.5) == pytest.approx(1.5, abs=0.03)
    assert at(motion.stop_distance, 4.0) == pytest.approx(np.pi / 2 - 1.0, abs=0.005)


def test_knows_the_stops():
    motion = drawn()
    assert motion.closed[motion.time < 1.9].all() and motion.closed[motion.time > 7.6].all()
    assert not motion.closed[(motion.time > 2.1) & (motion.time < 7.3)].any()
    assert not motion.open.any()


def test_a_speed_that_is_far_above_its_noise_moves(tmp_path):
    """Half a radian a second of noise at 90 Hz: an angle with as much would show no motion."""
    (tmp_path / "rotor.yaml").write_text(ROTOR)
    rotor = read_actuator(tmp_path / "rotor.yaml")
    time = np.arange(0.0, 9.0, 0.011)
    speed = np.where((time > 3.0) & (time < 6.0), 20.0, 0.0) + 0.5 * np.random.default_rng(1).standard_normal(time.size)
    inputs = Inputs(time, np.zeros(time.size))
    run = replace(run_along(), time=time, measured=speed, inputs=inputs, quantity="speed")
    motion = motion_of(run, rotor, 0.5)
    assert motion.moving[(time > 3.0) & (time < 6.0)].all() and not motion.moving[time < 3.0].any()
    assert limits_of([run], rotor, 0.5)[-1].finding.startswith("The shaft only goes forwards")


def test_slope_of_a_line_is_exact_at_uneven_times():
    assert slope(TIME, 3.0 * TIME - 1.0, 0.05) == pytest.approx(3.0)
