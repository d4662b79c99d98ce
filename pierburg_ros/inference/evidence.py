"""How residuals count as evidence: correlated ones, rounded ones, and one model against another."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from pierburg_ros.arrays import Signal

COARSE = 3.0
"""Step of the converter, in standard deviations of the noise, from which rounding decides what is measured. Derived:
the error of such a step, 3 / sqrt(12) = 0.87 of the noise, is as large as the noise."""
OFF_GRID = 0.02
"""Distance from the grid, in steps, that rounding by the file format may cause. Derived: a value off any grid comes as
near with a probability of 4 %, so n distinct ones with 0.04^n."""
EXPLAINED = 1.1
"""An error below this multiple of the noise is not distinguished from it. Measured: the noise estimate is 3 to 7 % low
in 3 of n = 94 recordings."""
SIGNIFICANT = 60.0
"""Gain in -2 log likelihood, in effective samples, that one more quantity must bring, and that shows an error which is
correlated in time. Measured: right explanations leave 21 at most (n = 65), white noise 18 (n = 3000)."""
TIED = 12.0
"""Difference in the same measure below which two explanations tie. Chosen: above the 3.84 of one smooth quantity, since
the best of many local minima is lower than the true one by luck."""
SMEARED = 8
"""Neighbouring samples whose correlation is no evidence of an error: as many as a sensor's filter smears. Chosen: noise
whose neighbours are correlated by 0.3 does then not look like an error that is correlated in time."""
FEWEST_BLOCKS = 8
"""Least number of blocks whose sums show whether an error is correlated in time. Derived: their variance is known to
a half."""


def certainty(worse: Signal, better: Signal, block: NDArray[np.int64]) -> float:
    """How many standard deviations surely the `better` of two residuals is better, by the spread between blocks.

    `block` is the number of the block of each sample. The test of Vuong, Likelihood ratio tests for model selection and
    non-nested hypotheses (1989): neither of the models need be true.
    """
    _, place = np.unique(block, return_inverse=True)
    size = np.bincount(place)
    first, second = (np.bincount(place, np.square(residual)) / size for residual in (worse, better))
    each = size * np.log(np.maximum(first, 1e-300) / np.maximum(second, 1e-300))
    if each.size < 2:
        return 0.0
    return float(np.sum(each) / max(math.sqrt(each.size) * float(np.std(each, ddof=1)), 1e-300))


def probability(deviations: float) -> float:
    """Probability that a normal variable is below so many standard `deviations`."""
    return 0.5 * math.erfc(-deviations / math.sqrt(2.0))


def repetition(residual: Signal) -> float:
    """Number of samples that count as one: 1 + 2 sum of the autocorrelation up to where it vanishes, at least 1."""
    size = 1 << int(np.ceil(np.log2(2 * residual.size)))
    spectrum = np.abs(np.fft.rfft(residual - residual.mean(), size)) ** 2
    correlation = np.fft.irfft(spectrum, size)[: residual.size // 4]
    correlation = correlation / max(float(correlation[0]), 1e-300)
    vanished = np.flatnonzero(correlation < 0.02)
    last = int(vanished[0]) if vanished.size else correlation.size
    return float(1.0 + 2.0 * correlation[1:last].sum())


def structure(residual: Signal, allowed: float = 0.0) -> float:
    """Evidence in a residual, shape (samples,), for an error correlated in time, in -2 log likelihood; 0 without any.

    The noise is taken to be white and of unknown size, the error to be constant over a block of samples and of random
    size in each. Sums then vary more between blocks than within (analysis of variance with random effects: Searle,
    Casella and McCulloch, Variance Components, Wiley 1992, section 3.5). Block lengths double from one to the next, and
    the length with the most evidence counts. An error of the `allowed` size (root mean square) is no evidence.
    """
    sums = residual[: residual.size // SMEARED * SMEARED].reshape(-1, SMEARED).sum(axis=1) / np.sqrt(SMEARED)
    length, most = 2, 0.0
    while (count := sums.size // length) >= FEWEST_BLOCKS:
        blocks = sums[: count * length].reshape(count, length)
        means = blocks.mean(axis=1, keepdims=True)
        within = float(np.sum(np.square(blocks - means))) / (count * (length - 1)) + SMEARED * length * allowed**2
        varies = length * float(np.mean(np.square(means))) / max(within, 1e-300)
        if varies > 1.0:
            most = max(most, count * (varies - 1.0 - float(np.log(varies))))
        length *= 2
    return most


def beyond(residual: Signal, half_step: float) -> Signal:
    """The part of a residual, shape (samples,), for which half a step of the converter does not account."""
    if half_step == 0.0:
        return residual
    return np.asarray(np.sign(residual) * np.maximum(np.abs(residual) - half_step, 0.0))


def rms(values: Signal) -> float:
    """Root mean square, in the unit of `values`."""
    return float(np.sqrt(np.mean(np.square(values))))


def coarse_step(measured: Sequence[Signal], noise: float, least: float) -> float:
    """Step [measured unit] on whose grid all samples lie, if it is coarse beside the noise and at least `least`.

    Otherwise the result is 0. Rounding a simulation does not improve its fit while the noise carries samples over the
    steps. With steps d, noise of standard deviation s leaves a squared error of 0.8 s d beside a rounded simulation.
    Beside a smooth one it leaves s^2 + d^2 / 12, which is less up to d = 8 s.
    """
    step = min(grid(values) for values in measured)
    unrounded = np.sqrt(max(noise**2 - step**2 / 12.0, 0.0))
    return step if step >= least and step > COARSE * unrounded else 0.0


def lasting_rounding(measured: Sequence[Signal], noise: float) -> float:
    """Root mean square [measured unit] of the rounding error that is the same for all samples of a shaft at rest.

    Without other noise it is the whole rounding error. Noise of standard deviation s carries samples over the steps d.
    It leaves a share of exp(-2 pi^2 s^2 / d^2), to first harmonic (Widrow and Kollar, Quantization Noise, Cambridge
    2008, on dither). `noise` includes rounding.
    """
    step = min(float(np.min(np.diff(np.unique(values)), initial=np.inf)) for values in measured)
    if not np.isfinite(step):
        return 0.0
    unrounded = max(noise**2 - step**2 / 12.0, 0.0)
    return float(step / np.sqrt(12.0) * np.exp(-2.0 * np.pi**2 * unrounded / step**2))


def grid(measured: Signal) -> float:
    """Smallest step between values if all are whole steps apart; otherwise, or for fewer than 3 values, 0."""
    values = np.unique(measured)
    if values.size < 3:
        return 0.0
    step = float(np.min(np.diff(values)))
    apart = (values - values[0]) / step
    step *= float(apart[-1]) / max(round(float(apart[-1])), 1)
    apart = (values - values[0]) / step
    return step if np.max(np.abs(apart - np.round(apart))) < OFF_GRID else 0.0
