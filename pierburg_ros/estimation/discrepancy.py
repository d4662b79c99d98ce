"""What no model of physics says, as part of the likelihood: a disturbance that wanders beside the sensor's noise."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.optimize import minimize

from pierburg_ros.arrays import Flags, Signal
from pierburg_ros.estimation.data import Data
from pierburg_ros.kernel import kernel

SPAN = 24
"""Samples over which the way of the shaft is taken. Chosen: 0.05 s at 500 Hz; not varied."""
CERTAIN = 4.0
"""So many standard deviations of the noise make a movement. Derived: white noise does so with 6e-5."""
REACHES = np.array([0.003, 0.03, 0.3])
"""Shares of the way of a recording from which the reach of a discrepancy is searched. Chosen: a factor of ten apart;
not varied."""
MEMORIES = np.array([0.005, 0.05, 0.5])
"""Correlation times from which it is searched, as shares of the longest recording. Chosen: a factor of ten apart; not
varied."""
SHORTEST, LONGEST = 1.0, 2.0
"""Range of the correlation time that is searched, in samples and in longest recordings. Derived: what forgets within a
sample is white noise, and what lasts twice as long as a recording is the same at both its ends."""
SMALLEST, LARGEST = 1e-3, 10.0
"""Range of its size that is searched, in noises and in sizes of the residual. Derived: a thousandth of the noise
changes no likelihood, and what is ten times the residual is not seen to vary."""
NEAREST = 1e-3
"""Shortest reach that is searched, as a share of the way of a recording. Chosen: a thousandth of it, 0.05 rad where the
valve goes through its travel thirty times; not varied."""


@dataclass(frozen=True)
class Discrepancy:
    """A disturbance added to the measured signal: it stands for what a simulation lacks.

    An Ornstein-Uhlenbeck process of standard deviation `size` [noise] whose clock runs with time and with the way of
    the shaft: it forgets within `memory` [s] at rest, and within `reach` [noise] of movement. A shaft that sets off at
    the wrong moment ends elsewhere and stays there until it moves again. (Kennedy and O'Hagan, Bayesian calibration of
    computer models, J. R. Stat. Soc. B 63, 2001.) What it predicts from the samples before is no evidence.
    """

    size: float
    memory: float
    reach: float


class Kalman:
    """The Kalman filter of discrepancies beside white noise over the samples of some runs, those `seen` known."""

    def __init__(self, data: Data, seen: Flags) -> None:
        runs, noise = data.runs, data.noise
        self.seen = seen
        self.steps = np.concatenate([np.append(np.inf, np.diff(run.time)) for run in runs])
        self.run = np.repeat(np.arange(len(runs)), [run.time.size for run in runs])
        self.way = np.concatenate([way(run.measured / noise) for run in runs])

    def filtered(self, discrepancy: Discrepancy) -> Filter:
        """The filter for one discrepancy."""
        own = discrepancy.size, discrepancy.memory, discrepancy.reach
        return Filter(self.seen, *_gains(self.steps, self.way, self.seen, *own))

    def most_likely(self, residual: Signal) -> Discrepancy:
        """The discrepancy under which a residual [noise], shape (samples,), is most likely."""

        def cost(point: Signal) -> float:
            return evidence(self.filtered(Discrepancy(*np.exp(point))), residual)

        scale = max(float(np.std(residual[self.seen])), 0.1)
        whole = float(np.max(np.bincount(self.run, weights=self.way), initial=0.0)) + 1.0
        longest = float(np.max(np.bincount(self.run, weights=np.where(np.isinf(self.steps), 0.0, self.steps))))
        sample = float(np.median(self.steps))
        starts = [np.log([scale, memory, reach]) for memory in longest * MEMORIES for reach in whole * REACHES]
        bounds = [
            (math.log(SMALLEST), math.log(LARGEST * scale)),
            (math.log(SHORTEST * sample), math.log(LONGEST * longest)),
            (math.log(NEAREST * whole), math.log(whole)),
        ]
        options = {"xatol": 0.02, "fatol": 0.5}
        best = minimize(cost, min(starts, key=cost), method="Nelder-Mead", bounds=bounds, options=options).x
        return Discrepancy(*(float(value) for value in np.exp(best)))


@dataclass(frozen=True)
class Filter:
    """What turns residuals into innovations for one `Discrepancy`.

    Samples that are `seen`, how much of a prediction they `keep` of the one before, the `gain` and the `spread` of the
    innovations; all of shape (samples,).
    """

    seen: Flags
    keep: Signal
    gain: Signal
    spread: Signal

    def __call__(self, residual: Signal) -> Signal:
        """Innovations of a residual, shape (samples,), over their standard deviation, where it is seen."""
        return np.asarray(_innovations(residual, self.seen, self.keep, self.gain, self.spread)[self.seen])

    @cached_property
    def log_spread(self) -> float:
        """Sum of the logarithms of the innovations' standard deviations."""
        return float(np.sum(np.log(self.spread[self.seen])))


def evidence(filtered: Filter, residual: Signal) -> float:
    """Minus twice the logarithm of the likelihood of a residual, shape (samples,), but for a constant."""
    innovations = filtered(residual)
    return float(innovations @ innovations) + 2.0 * filtered.log_spread


def way(measured: Signal) -> Signal:
    """How far the shaft goes from each sample to the next [noise], 0 where that is not told from the noise."""
    half = SPAN // 2
    padded = np.concatenate([np.full(half, measured[0]), measured, np.full(half, measured[-1])])
    slope = np.abs(padded[2 * half :] - padded[: -2 * half]) / (2 * half)
    return np.asarray(np.where(slope > CERTAIN * math.sqrt(2.0) / (2 * half), slope, 0.0))


@kernel
def _gains(
    steps: Signal, way: Signal, seen: Flags, size: float, memory: float, reach: float
) -> tuple[Signal, Signal, Signal]:
    keep, gain, spread = np.empty(steps.size), np.empty(steps.size), np.empty(steps.size)
    known = 0.0
    for k in range(steps.size):
        keep[k] = np.exp(-steps[k] / memory - way[k] / reach)
        same = keep[k] * keep[k]
        known = same * known + (1.0 - same) * size * size
        spread[k] = np.sqrt(known + 1.0)
        gain[k] = known / (known + 1.0)
        if seen[k]:
            known *= 1.0 - gain[k]
    return keep, gain, spread


@kernel
def _innovations(residual: Signal, seen: Flags, keep: Signal, gain: Signal, spread: Signal) -> Signal:
    result = np.zeros(residual.size)
    state = 0.0
    for k in range(residual.size):
        state *= keep[k]
        if seen[k]:
            innovation = residual[k] - state
            result[k] = innovation / spread[k]
            state += gain[k] * innovation
    return result
