"""A seeded differential evolution that gives up on a candidate as soon as it is worse than its rival."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pierburg_ros.arrays import Signal
from pierburg_ros.workers import workers

Cost = Callable[[Signal, float], float]  # cost of a point; may stop counting above the second argument

SHARE_TOWARDS_BEST = 0.7  # of the candidates; the rest explore around their parent
CROSSOVER = 0.8
WEIGHTS = (0.4, 0.9)  # of the differences, drawn for each candidate


@dataclass(frozen=True)
class Population:
    """Points of shape (members, parameters) and their costs, best first."""

    points: NDArray[np.float64]
    costs: Signal


def search(
    cost: Cost,
    bounds: Sequence[tuple[float, float]],
    generations: int,
    members: int,
    seed: int = 0,
    on_generation: Callable[[float], None] = lambda best: None,
    jobs: int | None = None,
) -> Population:
    """The last population of a search for the least `cost` within `bounds`, `jobs` costs at a time.

    Differential evolution after Storn and Price, Journal of Global Optimization 11 (1997) 341-359.
    """
    random = np.random.default_rng(seed)
    low, high = np.array(bounds, dtype=float).T
    points = random.uniform(low, high, (members, low.size))
    with workers(jobs) as pool:
        costs = np.array(list(pool.map(cost, points, [np.inf] * members)))
        for _ in range(generations):
            candidates = offspring(random, points, points[costs.argmin()], low, high)
            tried = np.array(list(pool.map(cost, candidates, costs)))
            better = tried < costs
            points[better], costs[better] = candidates[better], tried[better]
            on_generation(float(costs.min()))
    order = np.argsort(costs)
    return Population(points[order], costs[order])


def offspring(
    random: np.random.Generator, points: NDArray[np.float64], best: Signal, low: Signal, high: Signal
) -> NDArray[np.float64]:
    """One candidate for each point; a value beyond the bounds is drawn anew."""
    members, size = points.shape
    one, other = (points[random.permutation(members)] for _ in range(2))
    weight = random.uniform(*WEIGHTS, (members, 1))
    towards_best = random.random((members, 1)) < SHARE_TOWARDS_BEST
    moved = points + weight * (np.where(towards_best, best - points, 0.0) + one - other)
    crossed = random.random(points.shape) < CROSSOVER
    crossed[np.arange(members), random.integers(size, size=members)] = True
    candidates = np.where(crossed, moved, points)
    outside = (candidates < low) | (candidates > high)
    return np.where(outside, random.uniform(low, high, points.shape), candidates)
