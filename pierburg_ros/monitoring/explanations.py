"""Fits what could explain recent movements: nothing but the supply, or one parameter that drifted."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pierburg_ros.monitoring.evidence import Evidence, evidence
from pierburg_ros.monitoring.movements import Movement, Signal
from pierburg_ros.plant import Model

SUPPLY = "supply_voltage"
SUPPLY_SPREAD = 0.1
"""Standard deviation of the logarithm of an unlogged supply over the model's.

Twelve to 14.5 V around 13.5 V are -0.12 to +0.07.
"""
WANDER = 0.0075
"""Change of that logarithm within a second, standard deviation; it grows with the square root of time.

The whole range from 12 to 14.5 V, 0.19, within ten minutes: 0.19 / sqrt(600).
"""
KNOWN_SUPPLY = 1e-6
"""Both of them where the supply is logged."""
WIDE = 0.5
"""Standard deviation of the logarithm of a drifted parameter before anything is known: a factor of 1.65."""
MOST_ITERATIONS = 8
"""Most Gauss-Newton steps; movements of the valve with a parameter 40 % off need 3 to 5."""
CONVERGED = 0.1
"""A fit is done when its parameter moves by less than this share of its standard error."""
LARGEST_CHANGE = 0.3
"""Largest change of a logarithm in one step: friction makes the prediction straight over no more."""


@dataclass(frozen=True)
class Explanation:
    """A parameter (or none) whose change explains the movements, and how well it does."""

    name: str | None
    change: float  # logarithm of parameter over model
    error: float  # standard error of that
    supply: Signal  # logarithm of the supply over the model's at each movement
    cost: float  # residual energy in variances of the noise, with what the changes themselves cost
    samples: int


def supply_prior(movements: Sequence[Movement], known: bool) -> NDArray[np.float64]:
    """Inverse covariance of the supply's logarithms at the movements: Gauss-Markov around the model's value."""
    spread, wander = (KNOWN_SUPPLY, KNOWN_SUPPLY) if known else (SUPPLY_SPREAD, WANDER)
    starts = np.array([movement.samples.time[0] for movement in movements])
    decay = np.exp(-np.abs(starts[:, np.newaxis] - starts) * (wander / spread) ** 2 / 2.0)
    covariance = spread**2 * decay + np.eye(starts.size) * KNOWN_SUPPLY**2
    return np.asarray(np.linalg.inv(covariance))


def solved(
    pieces: Sequence[Evidence], column: int | None, supply: int, prior: NDArray[np.float64]
) -> tuple[Signal, NDArray[np.float64]]:
    """Best [change, supply at each movement], and its covariance.

    `column` and `supply` number the parameters in the evidence; without a column the change stays 0.
    """
    count = len(pieces)
    matrix = np.zeros((count + 1, count + 1))
    right = np.zeros(count + 1)
    matrix[1:, 1:] = prior
    matrix[0, 0] = WIDE**-2
    for index, piece in enumerate(pieces, 1):
        matrix[index, index] += piece.information[supply, supply]
        right[index] += piece.gain[supply]
        if column is not None:
            matrix[0, 0] += piece.information[column, column]
            matrix[0, index] += piece.information[column, supply]
            matrix[index, 0] += piece.information[column, supply]
            right[0] += piece.gain[column]
    covariance = np.linalg.inv(matrix)
    return np.asarray(covariance @ right, dtype=float), np.asarray(covariance, dtype=float)


def fitted(
    model: Model, movements: Sequence[Movement], name: str | None, known: bool, begin: Signal | None = None
) -> Explanation:
    """The explanation by `name` (None: by the supply alone), iterated from `begin`, [change, supply ...]."""
    names = [SUPPLY] if name in (None, SUPPLY) else [name, SUPPLY]
    column = None if name is None else 0
    prior = supply_prior(movements, known)
    now = np.zeros(len(movements) + 1) if begin is None else begin
    kept, lowest, errors = now, math.inf, now
    for _ in range(MOST_ITERATIONS):
        pieces = [evidence(model, m, names, _about(name, now[0], v)) for m, v in zip(movements, now[1:], strict=True)]
        cost = _cost(pieces, now, prior)
        if cost > lowest:
            now = 0.5 * (now + kept)
            continue
        best, covariance = solved(pieces, column, len(names) - 1, prior)
        kept, lowest, errors = now, cost, np.sqrt(np.diag(covariance))
        step = best - now
        if np.all(np.abs(step) < CONVERGED * errors):
            break
        now = now + step * min(1.0, LARGEST_CHANGE / float(np.max(np.abs(step))))
    samples = sum(m.samples.time.size for m in movements)
    return Explanation(name, float(kept[0]), float(errors[0]) if name else 0.0, kept[1:], lowest, samples)


def _about(name: str | None, change: float, supply: float) -> Signal:
    """Where to linearise: the supply may itself be what changed."""
    return np.array([change + supply]) if name in (None, SUPPLY) else np.array([change, supply])


def _cost(pieces: Sequence[Evidence], now: Signal, prior: NDArray[np.float64]) -> float:
    """Residual energy where the pieces were linearised, and what the changes cost themselves."""
    energy = sum(p.energy - 2.0 * p.gain @ p.about + p.about @ p.information @ p.about for p in pieces)
    return float(energy + now[1:] @ prior @ now[1:] + (now[0] / WIDE) ** 2)
