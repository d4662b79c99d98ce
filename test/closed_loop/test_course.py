"""The course of steps and the plants it is run on."""

import math

import numpy as np
import pytest

from pierburg_ros.closed_loop.course import STEPS, STOP_SIZES, WAYS, Course
from pierburg_ros.closed_loop.loop import Run
from pierburg_ros.closed_loop.plants import NOMINAL, RESISTANCE, plant_set
from pierburg_ros.effects import EFFECTS


def test_has_every_size_both_ways_in_two_ways():
    found = [(round(math.degrees(abs(step.target - step.start))), step.opens) for step in STEPS]
    sizes = (5, 20, 50, 80, *STOP_SIZES)
    assert found == [(size, opens) for size in sizes for opens in (True, False) for _ in range(WAYS)]


def test_steps_at_the_closed_stop_begin_or_end_there_and_the_first_has_no_past():
    at_stop = [step for step in STEPS if step.at_stop]
    assert len(at_stop) == len(STOP_SIZES) * 2 * WAYS
    assert all((step.start if step.opens else step.target) == 0.0 for step in at_stop)
    assert [step.before for step in at_stop if step.opens] == pytest.approx([0.0, math.radians(10.0)] * 2)
    assert len({step.label for step in STEPS}) == len(STEPS) / WAYS


def test_each_kind_in_mid_travel_starts_after_opening_and_after_closing():
    for first in range(0, len(STEPS) - sum(step.at_stop for step in STEPS), WAYS):
        arrivals = {step.start > step.before for step in STEPS[first : first + 2]}
        assert arrivals == {True, False}


def test_stays_between_the_stops():
    angles = [angle for step in STEPS for angle in (step.before, step.start, step.target)]
    assert min(angles) >= 0.0 and max(angles) <= math.pi / 2 + 1e-12


def test_the_setpoints_bring_arrival_rest_and_step():
    setpoints = Course(approach=0.1, hold=0.2, watch=0.5).setpoints(100.0)
    assert setpoints.shape == (len(STEPS), 80)
    for step, setpoint in zip(STEPS, setpoints, strict=True):
        assert (setpoint[9], setpoint[10], setpoint[29], setpoint[30]) == (
            step.before,
            step.start,
            step.start,
            step.target,
        )


def test_the_metrics_are_cut_at_the_steps():
    """A shaft that is always where the setpoint was 40 ms ago settles after 40 ms, everywhere."""
    setpoint = Course(approach=0.3, hold=0.4, watch=0.8).setpoints(500.0)
    angle = np.concatenate([np.zeros((len(STEPS), 20)), setpoint[:, :-20]], axis=1)
    run = Run(np.arange(setpoint.shape[1]) / 500.0, setpoint, 0 * angle, 0 * angle, angle)
    for metrics in Course(approach=0.3, hold=0.4, watch=0.8).metrics(run):
        assert metrics.settling == pytest.approx(0.040)
        assert metrics.rise == 0.0
        assert metrics.steady_state_error == pytest.approx(0.0, abs=1e-12)


def test_every_effect_of_the_catalogue_is_among_the_plants():
    used = {effect for model in plant_set().values() for effect in model.active_effects}
    assert used == {effect.id for effect in EFFECTS}


def test_every_plant_acts_as_its_name_says():
    for name, model in plant_set().items():
        expected = () if name in (NOMINAL, *RESISTANCE) else (name.replace(" ", "_"),)
        assert model.active_effects == expected


def test_static_friction_breaks_away_at_1_4_times_coulomb_friction():
    values = plant_set()["static friction"].values
    assert values["static_friction.breakaway_torque"] == pytest.approx(1.4 * 0.2007)  # Table I
