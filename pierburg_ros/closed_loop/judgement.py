"""A tuned controller judged: every step on every plant, ten seeds of noise."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import astuple, dataclass, fields
from functools import partial

import numpy as np
from numpy.typing import NDArray

from pierburg_ros.closed_loop.course import Course
from pierburg_ros.closed_loop.designs import Design
from pierburg_ros.closed_loop.goal import QUANTITIES, Goal, settling_bounds
from pierburg_ros.closed_loop.loop import simulate_runs
from pierburg_ros.closed_loop.metrics import Metrics
from pierburg_ros.closed_loop.plants import NOMINAL
from pierburg_ros.closed_loop.tune import NOISE, RATE
from pierburg_ros.control import Settings
from pierburg_ros.plant import Model
from pierburg_ros.workers import workers

NOISE_SEEDS = range(100, 110)  # none of those that tuning saw
PLACE = {field.name: place for place, field in enumerate(fields(Metrics))}

Table = NDArray[np.float64]


@dataclass(frozen=True)
class Judgement:
    """The responses of a tuned controller: by plant, metrics of shape (seeds, steps, metrics)."""

    name: str
    settings: Settings
    plants: Mapping[str, Model]
    responses: Mapping[str, Table]

    def median(self, plant: str, metric: str) -> Table:
        """Median of a metric over the seeds, shape (steps,)."""
        median: Table = np.median(self.responses[plant][:, :, PLACE[metric]], axis=0)
        return median

    def worst(self, plant: str, metric: str) -> Table:
        """Largest of a metric over the seeds, shape (steps,)."""
        worst: Table = self.responses[plant][:, :, PLACE[metric]].max(axis=0)
        return worst

    def shares(self, plant: str, goal: Goal) -> Table:
        """Medians of what the goal limits as shares of their limits, shape (steps, 4)."""
        bounds = settling_bounds(self.plants[NOMINAL], RATE)
        if plant == NOMINAL:
            limits = goal.nominal_limits(bounds)
        else:
            limits = goal.other_limits(np.maximum(self.median(NOMINAL, "settling"), bounds))
        return np.column_stack([self.median(plant, name) for name in QUANTITIES]) / limits


def judge(
    design: Design,
    settings: Settings,
    plants: Mapping[str, Model],
    on_plant: Callable[[], None] = lambda: None,
    jobs: int | None = None,
) -> Judgement:
    """Run a tuned controller over the whole course on every plant, `jobs` runs at a time."""
    responses = {}
    with workers(jobs) as pool:
        for name, model in plants.items():
            responses[name] = np.array(list(pool.map(partial(respond, design, settings, model), NOISE_SEEDS)))
            on_plant()
    return Judgement(design.name, settings, plants, responses)


def respond(design: Design, settings: Settings, model: Model, seed: int) -> Table:
    """Metrics of every step of one run, shape (steps, metrics)."""
    course = Course()
    run = simulate_runs(model, settings, course.setpoints(RATE), RATE, NOISE, seed, control=design.control)
    return np.array([astuple(metrics) for metrics in course.metrics(run)])
