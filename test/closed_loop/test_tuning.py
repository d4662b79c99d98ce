"""Tuning: what counts as a shortfall, a short search, the report, and that the defaults reach the goals."""

import math

import numpy as np
import pytest

from pierburg_ros.closed_loop.course import STEPS, Course
from pierburg_ros.closed_loop.designs import DESIGNS
from pierburg_ros.closed_loop.goal import Goal
from pierburg_ros.closed_loop.judgement import judge
from pierburg_ros.closed_loop.plants import HOT, NOMINAL, STICKY, plant_set
from pierburg_ros.closed_loop.report import BEGIN, END, insert, report
from pierburg_ros.closed_loop.tune import BEYOND, GOAL_MARGIN, STATED, Task, shortfall, tune
from pierburg_ros.control import Settings

FEW = {name: plant_set()[name] for name in (*STATED, "sensor lag")}


def test_nothing_is_short_of_a_goal_that_is_met_with_margin():
    limits = np.ones((16, 4))
    assert shortfall([0.5 * limits], limits) == pytest.approx(4 * BEYOND * 0.5)


def test_shortfall_is_the_logarithm_of_the_excess():
    limits = np.ones((16, 4))
    doubled = limits.copy()
    doubled[:, 0] = 2.0 * GOAL_MARGIN
    assert shortfall([doubled], limits) - shortfall([limits * 0], limits) == pytest.approx(
        math.log(2.0) + BEYOND * (3.0 + 2.0 * GOAL_MARGIN) + 3.0 * math.log(1.0 / GOAL_MARGIN)
    )


def test_limits_follow_from_the_goal_and_are_wider_for_other_plants():
    bounds = np.linspace(0.1, 0.3, len(STEPS))
    goal = Goal(settling=3.0, overshoot=0.05, steady_state_error=0.01, hunting=0.004, longer=1.5, wider=2.5)
    nominal = goal.nominal_limits(bounds)
    np.testing.assert_allclose(nominal[:, 0], 3.0 * bounds)
    assert nominal[0, 1:] == pytest.approx([0.05, 0.01, 0.004])
    other = goal.other_limits(np.full(len(STEPS), 0.1))
    assert other[0] == pytest.approx([0.15, 0.05, 0.025, 0.004])


def test_a_worse_controller_costs_more_and_counting_may_stop():
    task = Task(DESIGNS["PIFLC"], Goal(), FEW)
    course = Course(0.3, 0.3, 0.5)
    good, slow = Settings(), Settings(pi_output_support=2.0)
    assert task.cost(good, course) < task.cost(slow, course)
    assert task.cost(slow, course, at_most=0.01) > 0.01


@pytest.mark.search
@pytest.mark.parametrize("name", DESIGNS)
def test_a_short_search_is_repeatable_and_stays_within_its_bounds(name):
    design = DESIGNS[name]
    task = Task(design, Goal(), {plant: FEW[plant] for plant in STATED} | {"sensor lag": FEW["sensor lag"]})
    first, again = (tune(task, generations=1, members=4, seed=5) for _ in range(2))
    assert first == again
    for setting, (low, high) in design.tuned.items():
        assert 0.99 * low <= abs(getattr(first, setting)) <= 1.01 * high


LATE = {HOT: {"5° opening from the stop", "20° opening from the stop"}}
"""Steps that the default settings miss, as docs/control.md says: the first after a start, with an empty integrator."""


@pytest.fixture(scope="module")
def judgement():
    return judge(DESIGNS["PIFLC"], Settings(), {name: FEW[name] for name in STATED})


@pytest.mark.search
@pytest.mark.parametrize("plant", [NOMINAL, HOT, STICKY])
def test_the_default_settings_reach_the_stated_goals(judgement, plant):
    """Median of ten seeds at 3 mV, one sample of delay, on the true angle, from both sides."""
    shares = judgement.shares(plant, Goal())
    missed = {STEPS[step].label for step in np.flatnonzero(shares.max(axis=1) > 1.0)}
    assert missed == LATE.get(plant, set())


@pytest.mark.search
def test_the_report_replaces_what_stood_between_its_markers(judgement):
    comparison = report(Goal(), [judgement])
    for title in ("Settings found", "Goals", "Every plant", "Steps on the plant: nominal"):
        assert f"### {title}" in comparison
    document = insert("# Control\n", comparison)
    assert document.startswith("# Control\n\n" + BEGIN)
    assert insert(document, "new") == f"# Control\n\n{BEGIN}\n\nnew\n{END}\n"
