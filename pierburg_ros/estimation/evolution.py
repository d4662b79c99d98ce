"""A population that moves towards the minimum of a rough cost: evolution strategy with covariance matrix adaptation."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.estimation.least_squares import Map

HISTORY = (10.0, 30.0)
"""Generations whose best points agree before it ends: so many, and so many times the quantities over the points of one.
Given: the tutorial's criterion `TolFun`."""


@dataclass(frozen=True)
class _Rates:
    """How fast a population of `points` in `dimension` quantities learns (Hansen 2016, table 1)."""

    weights: Signal
    mass: float
    step: float
    damping: float
    path: float
    one: float
    many: float
    length: float


def evolved(
    cost: Callable[[Signal], float],
    begin: Signal,
    covariance: Signal,
    bounds: tuple[Signal, Signal],
    points: int,
    generations: int,
    over: Map = map,
    tolerance: float = 1.0,
) -> Signal:
    """The lowest point that so many `generations` of `points` each have come upon, shape (quantities,).

    The first ones are drawn around `begin` with a `covariance`, shape (quantities, quantities), later ones as the
    better half of all before tell, within `bounds`: only the order of costs counts, so jumps of a cost do no harm. It
    ends earlier where the best of the last generations, or all of one, differ by less than the `tolerance`: of chi2, 1
    is one standard deviation. `over` maps the cost over a generation. Equal input gives equal points.

    Source: N. Hansen, The CMA Evolution Strategy: A Tutorial, arXiv:1604.00772 (2016).
    """
    size, rates = begin.size, _rates(begin.size, points)
    random = np.random.default_rng(1)
    mean, shape, sigma = begin.copy(), np.array(covariance, np.float64), 1.0
    step_path, shape_path = np.zeros(size), np.zeros(size)
    lowest, best = np.inf, begin
    history = list[float]()
    last = int(np.ceil(HISTORY[0] + HISTORY[1] * size / points))
    for generation in range(1, generations + 1):
        lengths, axes = np.linalg.eigh(shape)
        lengths = np.sqrt(np.maximum(lengths, np.finfo(float).tiny))
        drawn = mean + sigma * (random.standard_normal((points, size)) * lengths) @ axes.T
        drawn = np.clip(drawn, *bounds)
        costs = np.array(list(over(cost, list(drawn))))
        order = np.argsort(costs)
        if costs[order[0]] < lowest:
            lowest, best = float(costs[order[0]]), drawn[order[0]]
        history.append(float(costs[order[0]]))
        recent = history[-last:]
        agreed = len(recent) == last and max(recent) - min(recent) < tolerance
        if agreed or costs[order[-1]] - costs[order[0]] < tolerance:
            break
        moves = (drawn[order[: rates.weights.size]] - mean) / sigma
        move = rates.weights @ moves
        mean = mean + sigma * move
        own = axes @ ((axes.T @ move) / lengths)
        step_path = (1.0 - rates.step) * step_path + np.sqrt(rates.step * (2.0 - rates.step) * rates.mass) * own
        long = float(np.linalg.norm(step_path)) / np.sqrt(1.0 - (1.0 - rates.step) ** (2 * generation))
        held = float(long < (1.4 + 2.0 / (size + 1.0)) * rates.length)
        shape_path *= 1.0 - rates.path
        shape_path += held * np.sqrt(rates.path * (2.0 - rates.path) * rates.mass) * move
        shape *= 1.0 - rates.one - rates.many + (1.0 - held) * rates.one * rates.path * (2.0 - rates.path)
        shape += rates.one * np.outer(shape_path, shape_path) + rates.many * (moves.T * rates.weights) @ moves
        sigma *= float(np.exp(rates.step / rates.damping * (np.linalg.norm(step_path) / rates.length - 1.0)))
    return best


def _rates(size: int, points: int) -> _Rates:
    better = points // 2
    weights = np.log(better + 0.5) - np.log(np.arange(1, better + 1))
    weights /= np.sum(weights)
    mass = 1.0 / float(np.sum(weights**2))
    step = (mass + 2.0) / (size + mass + 5.0)
    one = 2.0 / ((size + 1.3) ** 2 + mass)
    return _Rates(
        weights,
        mass,
        step,
        1.0 + step + 2.0 * max(0.0, np.sqrt((mass - 1.0) / (size + 1.0)) - 1.0),
        (4.0 + mass / size) / (size + 4.0 + 2.0 * mass / size),
        one,
        min(1.0 - one, 2.0 * (mass - 2.0 + 1.0 / mass) / ((size + 2.0) ** 2 + mass)),
        np.sqrt(size) * (1.0 - 1.0 / (4.0 * size) + 1.0 / (21.0 * size**2)),
    )
