"""How residuals count as evidence if a converter is coarse, or if samples are correlated."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from pierburg_ros.arrays import Signal

COARSE = 3.0
"""Step of the converter, in standard deviations of the noise, from which rounding decides what is measured. Derived:
the error of such a step, 3 / sqrt(12) = 0.87 of the noise, is as large as the noise."""
OFF_GRID = 0.02
"""Distance from the grid, in steps, that rounding by the file format may cause. Derived: a value off any grid comes as
near with a probability of 4 %, so n distinct ones with 0.04^n. A float32 at 5 V and 1 mV steps needs 0.0005."""
TIED = 12.0
"""Difference of chi2, in effective samples, below which two explanations, or two points of a cost with many local
minima, tie. Chosen: above the 3.84 of one smooth quantity, since by luck the best of many local minima is lower than
the true one. How much lower was not derived, and no other values were tried."""
SURE = 1.96
"""Number of standard deviations to either side that hold 95 %; its square is the rise of chi2 at the ends. Derived: the
97.5 % quantile of the normal distribution."""
EXPLAINED = 1.1
"""An error below this multiple of the noise, or of another error, is not distinguished from it. Measured: the noise
estimate is 3 to 7 % low in 3 of n = 94 recordings. The validation error of 80 blind trials without an effect is at most
2 % above the training error."""
SIGNIFICANT = 60.0
"""Gain in chi2, in effective samples, that one more quantity must bring. Measured: with it, none of n = 100 blind
trials without an effect is given one, and 406 of 411 shown effects are named. It is four times `PROMISING`. The same
threshold decides whether a residual is correlated in time. The evidence for that is 18 at most in white noise (n =
3000, 22,500 samples each), and 48 in noise whose neighbours are correlated by 0.3 (n = 200). It is 21 in the residuals
of n = 65 right explanations, and 784 in that of a wrong one that left 1.01 times the noise."""

FORMULATION = 7.3e-5
"""Root mean square difference, as a share of the travel, between simulations of one effect that are all correct.
Derived: 0.3 mV of the valve's Hall voltage, the largest change over all effects if steps of 5 us replace 10 in the
textbook form; trials differ by 0.005 to 0.2 mV from the simulator (`docs/proof.md`)."""
CLOSE = 8
"""Number of neighbouring samples whose correlation is no evidence of an error: as many as a sensor's filter smears.
Chosen: noise whose neighbours are correlated by 0.3 then does not look like an error that is correlated in time; not
varied."""
FEWEST = 8
"""Smallest number of blocks whose sums show whether an error is correlated in time. Derived: their variance is known to
a half."""


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
    2008, on dither). This is next to nothing where two values are nearer to each other than their noise. `noise`
    includes rounding.
    """
    step = min(float(np.min(np.diff(np.unique(values)), initial=np.inf)) for values in measured)
    if not np.isfinite(step):
        return 0.0
    unrounded = max(noise**2 - step**2 / 12.0, 0.0)
    return float(step / np.sqrt(12.0) * np.exp(-2.0 * np.pi**2 * unrounded / step**2))


def counted(residual: Signal, half_step: float) -> float:
    """Sum of squares of a residual, shape (samples,), in which half a step of the converter is no evidence.

    An error up to half a step depends on where in a step the shaft rests. It counts as its mean square over all places,
    a third of half a step squared. Only the part beyond counts as it is. `half_step` is 0 for fine steps.
    """
    out = beyond(residual, half_step)
    return float(out @ out) + residual.size * half_step**2 / 3.0


def beyond(residual: Signal, half_step: float) -> Signal:
    """The part of a residual, shape (samples,), for which half a step of the converter does not account."""
    if half_step == 0.0:
        return residual
    return np.asarray(np.sign(residual) * np.maximum(np.abs(residual) - half_step, 0.0))


def structure(residual: Signal, allowed: float = 0.0) -> float:
    """Evidence in a residual, shape (samples,), for an error correlated in time, in -2 log likelihood; 0 without any.

    The noise is taken to be white and of unknown size, the error to be constant over a block of samples and of random
    size in each. Sums then vary more between blocks than within (analysis of variance with random effects: Searle,
    Casella and McCulloch, Variance Components, Wiley 1992, section 3.5). Block lengths double from one to the next, and
    the length with the most evidence counts. An error of the `allowed` size (root mean square) is no evidence.
    """
    sums = residual[: residual.size // CLOSE * CLOSE].reshape(-1, CLOSE).sum(axis=1) / np.sqrt(CLOSE)
    length, most = 2, 0.0
    while (count := sums.size // length) >= FEWEST:
        blocks = sums[: count * length].reshape(count, length)
        means = blocks.mean(axis=1, keepdims=True)
        within = float(np.sum(np.square(blocks - means))) / (count * (length - 1)) + CLOSE * length * allowed**2
        varies = length * float(np.mean(np.square(means))) / max(within, 1e-300)
        if varies > 1.0:
            most = max(most, count * (varies - 1.0 - float(np.log(varies))))
        length *= 2
    return most


def repetition(residual: Signal) -> float:
    """Number of samples that count as one: 1 + 2 sum of the autocorrelation up to where it vanishes, at least 1.

    White residuals count in full. A residual with structure counts by its independent stretches.
    """
    centred = residual - residual.mean()
    size = 1 << int(np.ceil(np.log2(2 * centred.size)))
    spectrum = np.abs(np.fft.rfft(centred, size)) ** 2
    correlation = np.fft.irfft(spectrum, size)[: centred.size // 4]
    correlation = correlation / max(float(correlation[0]), 1e-30)
    vanished = np.flatnonzero(correlation < 0.02)
    last = int(vanished[0]) if vanished.size else correlation.size
    return float(1.0 + 2.0 * correlation[1:last].sum())


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
