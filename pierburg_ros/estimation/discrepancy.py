"""The discrepancy as part of the likelihood: a disturbance beside sensor noise that no model of physics describes."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.optimize import minimize

from pierburg_ros.arrays import Flags, Signal
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.run import Run
from pierburg_ros.kernel import kernel

SPAN = 24
"""Number of samples over which the movement of the shaft is measured. Chosen: 0.05 s at 500 Hz; not varied."""
CERTAIN = 4.0
"""Number of standard deviations of the noise from which a difference is a movement. Derived: white noise reaches it
with a probability of 6e-5."""
REACHES = np.array([0.003, 0.03, 0.3])
"""Shares of the way of a recording at which the search for the reach of a discrepancy starts. Chosen: a factor of ten
apart; not varied."""
MEMORIES = np.array([0.005, 0.05, 0.5])
"""Correlation times at which the search starts, as shares of the longest recording. Chosen: a factor of ten apart; not
varied."""
SHORTEST, LONGEST = 1.0, 2.0
"""Range of the correlation time in the search, in samples and in longest recordings. Derived: a disturbance that is
forgotten within a sample is white noise. One that lasts twice as long as a recording is the same at both its ends."""
SMALLEST, LARGEST = 1e-3, 10.0
"""Range of its size in the search, in noises and in sizes of the residual. Derived: a thousandth of the noise changes
no likelihood, and a disturbance of ten times the residual is not seen to vary."""
FORGOTTEN = 50.0
"""Time of a discrepancy's clock after which it is forgotten. Derived: exp(-sqrt(3) 50) is 2e-38."""
TINY = 1e-12
"""Variance [noise^2] of a discrepancy that counts as none. Derived: it changes innovations by as little as rounding
does."""
HUGE = 1e200
"""Product of variances at which the filter takes its logarithm. Derived: floats reach 1e308, and no variance 1e100."""
NEAREST = 1e-3
"""Shortest reach in the search, as a share of the way of a recording. Chosen: a thousandth of it, 0.05 rad where the
valve goes through its travel thirty times; not varied."""
SIMPLICES = (1.0, {"xatol": 0.2, "fatol": 5.0}), (-0.7, {"xatol": 0.02, "fatol": 0.5})
"""Sizes of the simplices, in logarithms, with which the search begins and begins again where it has ended, and how
nearly each ends. Measured: a simplex may become flat before it reaches the minimum. Of n = 114 searches (19 trials of
seed 903) one simplex of a twentieth of the start misses it by more than 0.5 in -2 log likelihood in 11, by 358 at most,
in 77 evaluations on average; these two in none, by 0.12 at most, in 88. The wide one by itself, to the end: 70
evaluations, 3 misses, 22 at most. Of n = 55 searches near a known discrepancy the second one alone misses none by more
than 0.6, where it begins up to 1,115 above, in 48."""


@dataclass(frozen=True)
class Discrepancy:
    """A disturbance added to the measured signal, in place of what a simulation lacks.

    It is a Gaussian process of standard deviation `size` [noise]. Its clock runs with time and with the way of the
    shaft: it forgets within `memory` [s] at rest, and within `reach` [noise] of movement. A shaft that sets off at the
    wrong moment ends elsewhere and stays there until it moves again. (Kennedy and O'Hagan, Bayesian calibration of
    computer models, J. R. Stat. Soc. B 63, 2001.) The error that it predicts from earlier samples is no evidence.

    Its covariance is (1 + sqrt(3) s) exp(-sqrt(3) s) after a time s of the clock (Matern, of smoothness 3/2: Rasmussen
    and Williams, Gaussian Processes for Machine Learning, 2006, eq. 4.17), as a process of two states (Hartikainen and
    Sarkka, Kalman filtering and smoothing solutions to temporal Gaussian process regression models, IEEE MLSP 2010). It
    has a slope and no kinks, like an angle under a wrong torque. The error from a wrong torque is therefore predicted,
    and is no evidence for an effect that adapts to it.
    """

    size: float
    memory: float
    reach: float


class Kalman:
    """The Kalman filter of discrepancies beside white noise over the samples of some runs; those `seen` are known."""

    def __init__(self, data: Data, seen: Flags) -> None:
        runs, noise = data.runs, data.noise
        self.seen = seen
        self.steps = np.concatenate([_steps(run) for run in runs])
        self.run = np.repeat(np.arange(len(runs)), [run.time.size for run in runs])
        self.way = np.concatenate([way(run.measured / noise) for run in runs])

    def filtered(self, discrepancy: Discrepancy) -> Filter:
        """The filter for one discrepancy."""
        own = discrepancy.size, discrepancy.memory, discrepancy.reach
        return Filter(self.seen, *_gains(self.steps, self.way, self.seen, *own))

    def evidence(self, discrepancy: Discrepancy, residual: Signal) -> float:
        """The `evidence` of a residual [noise], shape (samples,), under one discrepancy."""
        own = discrepancy.size, discrepancy.memory, discrepancy.reach
        return float(_evidence(residual, self.steps, self.way, self.seen, *own))

    def most_likely(
        self, residual: Signal, beside: Signal | None = None, near: Discrepancy | None = None
    ) -> Discrepancy:
        """The discrepancy under which a residual [noise], shape (samples,), is most likely.

        With a column `beside` it, shape (samples,), the best multiple of the column is taken out for each discrepancy.
        If that of almost the same residual is known, the search begins `near` it.
        """

        def cost(point: Signal) -> float:
            own = Discrepancy(*(float(value) for value in np.exp(point)))
            if beside is None:
                return self.evidence(own, residual)
            filtered = self.filtered(own)
            return evidence(filtered, residual - share(filtered, residual, beside) * beside)

        scale = max(float(np.std(residual[self.seen])), 0.1)
        whole = float(np.max(np.bincount(self.run, weights=self.way), initial=0.0)) + 1.0
        longest = float(np.max(np.bincount(self.run, weights=np.where(np.isinf(self.steps), 0.0, self.steps))))
        sample = float(np.median(self.steps))
        bounds = [
            (math.log(SMALLEST), math.log(LARGEST * scale)),
            (math.log(SHORTEST * sample), math.log(LONGEST * longest)),
            (math.log(NEAREST * whole), math.log(whole)),
        ]
        lower, upper = np.transpose(bounds)
        if near is None:
            starts = [np.log([scale, memory, reach]) for memory in longest * MEMORIES for reach in whole * REACHES]
            best = min(starts, key=cost)
        else:
            best = np.clip(np.log([near.size, near.memory, near.reach]), lower, upper)
        for simplex, options in SIMPLICES if near is None else SIMPLICES[1:]:
            corners = _simplex(best, simplex, lower, upper)
            own = {"initial_simplex": corners, **options}
            best = minimize(cost, best, method="Nelder-Mead", bounds=bounds, options=own).x
        return Discrepancy(*(float(value) for value in np.exp(best)))


def _simplex(start: Signal, size: float, lower: Signal, upper: Signal) -> Signal:
    """The corners of a simplex at `start`, shape (quantities + 1, quantities), within bounds."""
    steps = np.where((start + size >= lower) & (start + size <= upper), size, -size)
    return np.asarray(np.clip(np.vstack([start, start + np.diag(steps)]), lower, upper))


def _steps(run: Run) -> Signal:
    """Time [s] to each sample of a run from the one before; infinite at those at which the simulation begins again."""
    steps = np.append(np.inf, np.diff(run.time))
    if run.shooting is not None:
        steps[run.shooting.first] = np.inf
    return steps


@dataclass(frozen=True)
class Filter:
    """The filter that turns residuals into innovations for one `Discrepancy`.

    The arrays `seen` (whether a sample is known) and `spread` (standard deviation of its innovation) have shape
    (samples,). The matrix `keep` that predicts a sample from the one before has shape (samples, 4), the `gain` shape
    (samples, 2).
    """

    seen: Flags
    keep: Signal
    gain: Signal
    spread: Signal

    def __call__(self, residual: Signal) -> Signal:
        """Innovations of a residual, shape (samples,), over their standard deviation, at the samples that are seen."""
        return np.asarray(_innovations(residual, self.seen, self.keep, self.gain, self.spread)[self.seen])

    @cached_property
    def log_spread(self) -> float:
        """Sum of the logarithms of the innovations' standard deviations."""
        return float(np.sum(np.log(self.spread[self.seen])))


def evidence(filtered: Filter, residual: Signal) -> float:
    """Minus twice the log likelihood of a residual, shape (samples,), up to a constant."""
    innovations = filtered(residual)
    return float(innovations @ innovations) + 2.0 * filtered.log_spread


def share(filtered: Filter, residual: Signal, column: Signal) -> float:
    """The multiple of a column, shape (samples,), that makes the rest of a residual most likely."""
    left, own = filtered(residual), filtered(column)
    return float(own @ left) / max(float(own @ own), 1e-300)


def way(measured: Signal) -> Signal:
    """Movement of the shaft from each sample to the next [noise]; 0 where it is not distinguished from the noise."""
    half = SPAN // 2
    padded = np.concatenate([np.full(half, measured[0]), measured, np.full(half, measured[-1])])
    slope = np.abs(padded[2 * half :] - padded[: -2 * half]) / (2 * half)
    return np.asarray(np.where(slope > CERTAIN * math.sqrt(2.0) / (2 * half), slope, 0.0))


@kernel
def _gains(
    steps: Signal, way: Signal, seen: Flags, size: float, memory: float, reach: float
) -> tuple[Signal, Signal, Signal]:
    keep, gain, spread = np.empty((steps.size, 4)), np.empty((steps.size, 2)), np.empty(steps.size)
    level, rate = size * size, 3.0 * size * size
    known = level, 0.0, rate
    for k in range(steps.size):
        kept = _kept(_elapsed(steps[k], way[k], memory, reach))
        p, q, r = _predicted(known, kept, level, rate)
        keep[k] = kept
        spread[k] = math.sqrt(p + 1.0)
        gain[k] = p / (p + 1.0), q / (p + 1.0)
        known = _told((p, q, r), seen[k])
    return keep, gain, spread


@kernel
def _evidence(
    residual: Signal, steps: Signal, way: Signal, seen: Flags, size: float, memory: float, reach: float
) -> float:
    """The evidence of `_gains` and `_innovations`, in one pass that stores nothing."""
    level, rate = size * size, 3.0 * size * size
    known = level, 0.0, rate
    value = slope = squares = logarithms = 0.0
    spreads, before = 1.0, -1.0
    kept = _kept(0.0)
    for k in range(steps.size):
        elapsed = _elapsed(steps[k], way[k], memory, reach)
        if elapsed != before:
            kept, before = _kept(elapsed), elapsed
        a, b, c, d = kept
        p, q, r = _predicted(known, kept, level, rate)
        value, slope = a * value + b * slope, c * value + d * slope
        if seen[k]:
            innovation = residual[k] - value
            share = 1.0 / (p + 1.0)
            squares += innovation * innovation * share
            spreads *= p + 1.0
            if spreads > HUGE:
                logarithms, spreads = logarithms + math.log(spreads), 1.0
            value += p * share * innovation
            slope += q * share * innovation
        known = _told((p, q, r), seen[k])
    return squares + logarithms + math.log(spreads)


@kernel
def _elapsed(step: float, way: float, memory: float, reach: float) -> float:
    """Time of the clock between two samples."""
    return min(step / memory + way / reach, FORGOTTEN)


@kernel
def _predicted(
    known: tuple[float, float, float], kept: tuple[float, float, float, float], level: float, rate: float
) -> tuple[float, float, float]:
    """Covariance of value and slope at the next sample: its difference from the stationary covariance decays."""
    a, b, c, d = kept
    u, v, w = known[0] - level, known[1], known[2] - rate
    p = max(level + a * a * u + 2.0 * a * b * v + b * b * w, 0.0)
    q = a * c * u + (a * d + b * c) * v + b * d * w
    r = rate + c * c * u + 2.0 * c * d * v + d * d * w
    return p, q, r


@kernel
def _told(predicted: tuple[float, float, float], seen: bool) -> tuple[float, float, float]:
    """The covariance after a sample: updated if the sample is seen."""
    p, q, r = predicted
    if seen:
        share = 1.0 / (p + 1.0)
        p, q, r = p * share, q * share, r - q * q * share
    # rounding must not lead to a correlation above 1
    if p > TINY and r * p < q * q:
        r = q * q / p
    return p, q, r


@kernel
def _kept(elapsed: float) -> tuple[float, float, float, float]:
    """Transition matrix of value and slope over some time of the clock, by rows."""
    root = math.sqrt(3.0) * elapsed
    fade = math.exp(-root)
    return (1.0 + root) * fade, elapsed * fade, -3.0 * elapsed * fade, (1.0 - root) * fade


@kernel
def _innovations(residual: Signal, seen: Flags, keep: Signal, gain: Signal, spread: Signal) -> Signal:
    result = np.zeros(residual.size)
    value = slope = 0.0
    for k in range(residual.size):
        a, b, c, d = keep[k]
        value, slope = a * value + b * slope, c * value + d * slope
        if seen[k]:
            innovation = residual[k] - value
            result[k] = innovation / spread[k]
            value += gain[k, 0] * innovation
            slope += gain[k, 1] * innovation
    return result
