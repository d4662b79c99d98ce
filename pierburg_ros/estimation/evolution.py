"""Search for the minimum of a rough cost by a population: evolution strategy with covariance matrix adaptation."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.inference.least_squares import Map

HISTORY = (10.0, 30.0)
"""Number of last generations whose lowest costs must agree at the end: the first value, plus the second times the
quantities over the points of one generation. Given: the tutorial's criterion `TolFun`."""


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
    """The lowest point that `generations` of `points` each have found, shape (quantities,).

    The first points are drawn around `begin` with a `covariance`, shape (quantities, quantities), later ones from what
    the better half of all before shows, within `bounds`. Only the order of costs counts, so jumps of a cost do no harm.
    The search ends earlier where the lowest costs of the last generations, or all of one, differ by less than the
    `tolerance`: of chi2, 1 is one standard deviation. `over` maps the cost over a generation. Equal input gives equal
    points.

    Source: N. Hansen, The CMA Evolution Strategy: A Tutorial, arXiv:1604.00772 (2016).
    """
    population, random = _Population(begin, covariance, points), np.random.default_rng(1)
    lowest, best, history = np.inf, begin, list[float]()
    last = int(np.ceil(HISTORY[0] + HISTORY[1] * begin.size / points))
    for _ in range(generations):
        drawn = np.clip(population.drawn(random), *bounds)
        costs = np.array(list(over(cost, list(drawn))))
        order = np.argsort(costs)
        history.append(float(costs[order[0]]))
        if history[-1] < lowest:
            lowest, best = history[-1], drawn[order[0]]
        recent = history[-last:]
        agreed = len(recent) == last and max(recent) - min(recent) < tolerance
        if agreed or costs[order[-1]] - costs[order[0]] < tolerance:
            break
        population.learn(drawn[order])
    return best


class _Population:
    """The distribution from which `points` are drawn, and how fast it follows the better half of them.

    The points are normally distributed around a `mean`, with a covariance of the square of `sigma` times a `shape`.
    Names in the tutorial: `mass` mu_eff; the rates `step_rate` c_sigma, `path_rate` c_c, `one_rate` c_1, `many_rate`
    c_mu; `damping` d_sigma (table 1 there); `usual` the mean length of a random step.
    """

    def __init__(self, mean: Signal, covariance: Signal, points: int) -> None:
        size, better = mean.size, points // 2
        self.points = points
        self.mean, self.shape, self.sigma = mean.copy(), np.array(covariance, np.float64), 1.0
        self.lengths, self.directions = _axes(self.shape)
        self.step_path, self.shape_path = np.zeros(size), np.zeros(size)
        self.learnt = 0
        self.weights = np.log(better + 0.5) - np.log(np.arange(1, better + 1))
        self.weights /= np.sum(self.weights)
        mass = self.mass = 1.0 / float(np.sum(self.weights**2))
        self.step_rate = (mass + 2.0) / (size + mass + 5.0)
        self.damping = 1.0 + self.step_rate + 2.0 * max(0.0, np.sqrt((mass - 1.0) / (size + 1.0)) - 1.0)
        self.path_rate = (4.0 + mass / size) / (size + 4.0 + 2.0 * mass / size)
        self.one_rate = 2.0 / ((size + 1.3) ** 2 + mass)
        self.many_rate = min(1.0 - self.one_rate, 2.0 * (mass - 2.0 + 1.0 / mass) / ((size + 2.0) ** 2 + mass))
        self.usual = np.sqrt(size) * (1.0 - 1.0 / (4.0 * size) + 1.0 / (21.0 * size**2))

    def drawn(self, random: np.random.Generator) -> Signal:
        """The next points, shape (points, quantities)."""
        steps = random.standard_normal((self.points, self.mean.size)) * self.lengths
        return np.asarray(self.mean + self.sigma * steps @ self.directions.T)

    def learn(self, ordered: Signal) -> None:
        """Move the mean to the better half of the points, the best first, and adapt the shape to this move."""
        size, step, path, one, many = self.mean.size, self.step_rate, self.path_rate, self.one_rate, self.many_rate
        self.learnt += 1
        moves = (ordered[: self.weights.size] - self.mean) / self.sigma
        move = self.weights @ moves
        self.mean = self.mean + self.sigma * move
        unshaped = self.directions @ ((self.directions.T @ move) / self.lengths)
        self.step_path = (1.0 - step) * self.step_path + np.sqrt(step * (2.0 - step) * self.mass) * unshaped
        length = float(np.linalg.norm(self.step_path))
        settled = length / np.sqrt(1.0 - (1.0 - step) ** (2 * self.learnt)) < (1.4 + 2.0 / (size + 1.0)) * self.usual
        self.shape_path *= 1.0 - path
        if settled:
            self.shape_path += np.sqrt(path * (2.0 - path) * self.mass) * move
        self.shape *= 1.0 - one - many + (0.0 if settled else one * path * (2.0 - path))
        self.shape += one * np.outer(self.shape_path, self.shape_path) + many * (moves.T * self.weights) @ moves
        self.sigma *= float(np.exp(step / self.damping * (length / self.usual - 1.0)))
        self.lengths, self.directions = _axes(self.shape)


def _axes(shape: Signal) -> tuple[Signal, Signal]:
    """Lengths of the axes of a covariance, and their directions as columns."""
    squares, directions = np.linalg.eigh(shape)
    return np.sqrt(np.maximum(squares, np.finfo(float).tiny)), directions
