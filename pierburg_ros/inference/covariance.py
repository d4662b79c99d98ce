"""Covariance of a fit: from white noise, or from blocks of the residual where that is not white."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.special import ndtri, stdtrit

from pierburg_ros.arrays import Flags, Signal
from pierburg_ros.inference.evidence import repetition

RANK = 1e-5
"""Singular values below this share of the largest are rounding errors, not information. Derived: central differences of
1e-5 are wrong by about 1e-10, far below. Values between the two were not tried."""


@dataclass(frozen=True)
class Covariance:
    """Covariance `matrix` of the coordinates, shape (names, names), and the factor from standard deviation to 95 %.

    `undetermined`, shape (names,): the recording does not determine this coordinate, and its covariance is void.
    `noise` is the standard deviation of the residual. `white`: the residual looks like sensor noise, so the classical
    covariance holds. Otherwise the covariance is the sandwich over `blocks` stretches of the residual, each a few
    correlation times long. It accounts for correlated noise, but corrects no error of the model.
    """

    matrix: Signal
    undetermined: Flags
    factor: float
    noise: float
    white: bool
    blocks: int


@dataclass(frozen=True)
class Spread:
    """Covariance `matrix` of coordinates, shape (names, names), and the factor from standard deviation to 95 %."""

    matrix: Signal
    factor: float


def covariance_of(jacobian: Signal, residuals: tuple[Signal, ...]) -> Covariance:
    """Covariance of a least-squares fit from its Jacobian, shape (samples, names), and its residuals."""
    residual = np.concatenate(residuals)
    freedom = max(residual.size - jacobian.shape[1], 1)
    variance = float(residual @ residual) / freedom
    inverse, undetermined = _inverse(jacobian)
    length = max(correlation_length(part) for part in residuals)
    if length <= 1:
        factor = float(ndtri(0.975))
        return Covariance(variance * inverse, undetermined, factor, variance**0.5, True, residual.size)
    scores = block_scores(jacobian, residuals, 4 * length)
    blocks = len(scores)
    middle = scores.T @ scores * blocks / max(blocks - 1, 1)
    pieces = max(float(blocks), residual.size / repetition(residual))
    factor = float(stdtrit(max(pieces - jacobian.shape[1], 1.0), 0.975))
    return Covariance(inverse @ middle @ inverse, undetermined, factor, variance**0.5, False, blocks)


def at_least_effective(slopes: Signal, residuals: tuple[Signal, ...]) -> Covariance:
    """`covariance_of`, or the covariance by effective samples if that says less, on average over coordinates.

    The sums over few long blocks say little of how they vary: at a minimum they cancel each other.
    """
    known, residual = covariance_of(slopes, residuals), np.concatenate(residuals)
    floor = known.noise**2 * repetition(residual) * _inverse(slopes)[0]
    own, least = np.diagonal(known.matrix), np.maximum(np.diagonal(floor), 1e-300)
    return known if np.mean(own / least) >= 1.0 else replace(known, matrix=floor)


def spread(slopes: Signal, residuals: tuple[Signal, ...], before: Signal, rounding: float = 0.0) -> Spread:
    """Covariance from slopes, shape (samples, names), residuals, one array a run, and deviations `before`, (names,).

    `rounding` is the mean square of the error of a coarse converter, which residuals are without.

    Freedom is counted in effective samples: sums over few long blocks say how much the residual varies, not how many
    times.
    """
    residual = np.concatenate(residuals)
    repeated = repetition(residual)
    square = float(residual @ residual) / max(residual.size - before.size, 1) + rounding
    variance = max(square, 1e-300) * repeated
    freedom = max(residual.size / repeated - before.size, 1.0)
    left, lengths, directions = np.linalg.svd(slopes * before, full_matrices=False)
    lengths = np.where(lengths > RANK * lengths[0], lengths, 0.0)
    scaled = (left * lengths) @ directions
    inverse = (directions.T / (lengths**2 / variance + 1.0)) @ directions
    inflation = np.ones(before.size)
    length = max(correlation_length(part) for part in residuals)
    if length > 1:
        scores = block_scores(scaled, residuals, 4 * length)
        blocks = len(scores)
        middle = scores.T @ scores * blocks / max(blocks - 1, 1) / variance**2 + np.eye(before.size)
        sandwich = np.diagonal(inverse @ middle @ inverse)
        inflation = np.sqrt(np.maximum(sandwich / np.diagonal(inverse), 1.0))
    return Spread(inverse * np.outer(inflation * before, inflation * before), float(stdtrit(freedom, 0.975)))


def _inverse(jacobian: Signal) -> tuple[Signal, Flags]:
    """Inverse of jacobian' jacobian in the directions that the data determine, and the names with a part in others."""
    _, lengths, directions = np.linalg.svd(jacobian, full_matrices=False)
    known = lengths > RANK * max(lengths[0], 1e-300)
    scaled = directions[known] / lengths[known, None]
    return scaled.T @ scaled, np.linalg.norm(directions[~known], axis=0) > 0.05


def correlation_length(residual: Signal) -> int:
    """Number of samples over which the residual is correlated; 1 for white noise.

    It counts the lags up to the first whose autocorrelation is below 0.05, or below what white noise shows by chance (4
    standard deviations) if that is more.
    """
    centred = residual - residual.mean()
    size = centred.size
    spectrum = np.abs(np.fft.rfft(centred, 2 * size)) ** 2
    power = np.fft.irfft(spectrum)[: max(size // 4, 2)]
    if power[0] <= 0.0 or power[1] < 4.0 / np.sqrt(size) * power[0]:
        return 1
    below = np.flatnonzero(power < max(4.0 / np.sqrt(size), 0.05) * power[0])
    return int(max(below[0], 2)) if below.size else power.size


def block_scores(jacobian: Signal, residuals: tuple[Signal, ...], length: int) -> Signal:
    """Sums of jacobian times residual over blocks of at least `length` samples, shape (blocks, names)."""
    scores, first = [], 0
    for part in residuals:
        product = jacobian[first : first + part.size] * part[:, None]
        first += part.size
        starts = np.arange(0, max(part.size - length, 0) + 1, length)
        scores.append(np.add.reduceat(product, starts, axis=0))
    return np.concatenate(scores)
