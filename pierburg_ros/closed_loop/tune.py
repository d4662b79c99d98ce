"""Gains and sets of a controller for a stated goal, over the set of plants."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.closed_loop.course import STEPS, Course
from pierburg_ros.closed_loop.designs import Design
from pierburg_ros.closed_loop.goal import QUANTITIES, Goal, Table, settling_bounds, values
from pierburg_ros.closed_loop.loop import simulate_runs
from pierburg_ros.closed_loop.plants import HOT, NOMINAL, STICKY
from pierburg_ros.closed_loop.search import search
from pierburg_ros.control import Settings
from pierburg_ros.errors import InputError
from pierburg_ros.plant import Model

NOISE = 0.003  # of the Hall voltage, RMS [V]
RATE = 500.0  # [Hz]
STATED = (NOMINAL, HOT, STICKY)  # the plants for which the goals are stated: they count most
OTHERS_WEIGHT = 0.06  # weight of the mean of the other plants
WORST = 0.01  # weight of the worst plant of all
GOAL_MARGIN = 0.85  # within this share of its limit a quantity costs little more
HOPELESS = 10.0  # times its limit or more: counts as this
BEYOND = 0.02  # what being better still is worth, beside reaching the limit
TUNING_SEEDS = {True: (0, 1, 2), False: (3,)}  # of the noise, for the plants with stated goals and the others
SHORT_COURSE = Course(approach=0.3, hold=0.35, watch=1.2)  # enough to rank candidates
FINAL_CANDIDATES = 6  # are judged once more on the whole course, which sees slow hunting


@dataclass(frozen=True)
class Task:
    """A controller to tune for a goal over plants, by name; `NOMINAL` is one of them."""

    design: Design
    goal: Goal
    plants: Mapping[str, Model]
    stated: Sequence[str] = STATED
    """The plants that count most, `NOMINAL` first."""

    def cost(self, settings: Settings, course: Course, at_most: float = math.inf) -> float:
        """How far the responses fall short of the goal; counting stops above `at_most`."""
        responses = [self.response(NOMINAL, settings, course, seed) for seed in TUNING_SEEDS[True]]
        bounds = settling_bounds(self.plants[NOMINAL], RATE)
        total = worst = shortfall(responses, self.goal.nominal_limits(bounds)) / len(self.stated)
        settling = np.maximum(np.median(responses, axis=0)[:, 0], bounds)
        other_limits = self.goal.other_limits(settling)
        rest = [name for name in self.plants if name not in self.stated]
        others = [*self.stated[1:], *rest]
        for name in others:
            if total > at_most or total == math.inf:
                break
            stated = name in self.stated
            responses = [self.response(name, settings, course, seed) for seed in TUNING_SEEDS[stated]]
            missed = shortfall(responses, other_limits)
            total += missed / len(self.stated) if stated else OTHERS_WEIGHT * missed / len(rest)
            worst = max(worst, missed)
        return total + WORST * worst

    def response(self, name: str, settings: Settings, course: Course, seed: int) -> Table:
        """What the goal limits, for each step, shape (steps, 4); infinite where the plant breaks down."""
        model, control = self.plants[name], self.design.control
        try:
            run = simulate_runs(model, settings, course.setpoints(RATE), RATE, NOISE, seed, control=control)
        except InputError:
            return np.full((len(STEPS), len(QUANTITIES)), np.inf)
        return values(course.metrics(run))


def shortfall(responses: Sequence[Table], limits: Table) -> float:
    """Logarithmic excess over the limits, summed over quantities, averaged over responses and steps."""
    ratios = np.minimum(np.array(responses) / limits, HOPELESS)
    excess = np.log(np.maximum(ratios / GOAL_MARGIN, 1.0)) + BEYOND * ratios
    return float(excess.sum(axis=-1).mean())


def tune(
    task: Task,
    generations: int,
    members: int,
    seed: int = 1,
    on_generation: Callable[[float], None] = lambda best: None,
    jobs: int | None = None,
    known: Sequence[Settings] = (),
) -> Settings:
    """The best settings found or `known`, `jobs` candidates tried at a time; the same seed finds the same."""

    def cost(point: Signal, at_most: float) -> float:
        return task.cost(task.design.settings(point), SHORT_COURSE, at_most)

    found = search(cost, task.design.bounds, generations, members, seed, on_generation, jobs)
    finalists = [*known, *(task.design.settings(point) for point in found.points[:FINAL_CANDIDATES])]
    return min(finalists, key=lambda settings: task.cost(settings, Course()))
