"""What the data can tell apart: when a larger explanation is worth its quantities, and which ones fit alike."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.estimation.likelihood import EXPLAINED, TIED

SIGNIFICANT = 60.0
"""Gain in chi2, in effective samples, that one more quantity must bring. Measured: with it none of n = 100 blind
trials without an effect is given one, and 406 of 411 shown effects are named. Four times `PROMISING`."""
FORMULATION = 7.3e-5
"""What simulations of one effect may differ by, root mean square, as a share of the travel, each right in its own way.
Derived: 0.3 mV of the valve's Hall voltage, the most that steps of 5 us in place of 10 change in the textbook form,
over all effects; trials differ by 0.005 to 0.2 mV from the simulator (`docs/proof.md`)."""
PROMISING = 15.0
"""Gain in chi2 that a first fit must promise on top of an adequate explanation to be followed up. Measured: in n = 13
recordings without an effect, drifted ones included, none gained as much."""
ADEQUATE = 1.03
"""Training error over noise up to which an explanation accounts for all there is. Measured: over white noise the ratio
goes up to 1.031 (n = 300, 22,500 samples each; standard deviation 0.008), from the estimate of the noise alone."""
COMPLETE = 1.01
"""Training error over noise at which the search for explanations of one size ends. Measured: 1.3 standard deviations
(0.008, n = 300) of the ratio over white noise."""
PURE = 1.04
"""Repetition of a residual up to which it is white noise, however large. Measured: the most that white noise has (n =
300, 22,500 samples each)."""
WHITE = 1.5
"""Repetition of a residual up to which it passes for white noise. Measured: white noise has at most 1.04 (n = 300,
22,500 samples each); 1.5 is neighbours correlated by 0.2."""


def gain(smaller: Fit, larger: Fit) -> float:
    """What the larger explanation gains in chi2, counted in effective samples."""
    return (smaller.misfit - larger.misfit) / larger.repetition


def gains_enough(smaller: Fit, larger: Fit, more: int, data: Data) -> bool:
    """Whether so many quantities `more` gain what each has to, beyond what simulations of the smaller may differ by."""
    return gain(smaller, larger) > SIGNIFICANT * more + allowance(smaller, data) / larger.repetition


def betters(larger: Fit, smaller: Fit, estimator: Estimator) -> bool:
    """Whether a larger explanation gains more than chance and the difference of simulators can give it.

    It may not fail on the validation samples where the smaller one does not: then it fits the training samples alone.
    """
    more = larger.explanation.size - smaller.explanation.size
    if not gains_enough(smaller, larger, more, estimator.data):
        return False
    return estimator.validation_misfit(larger) <= _highest(estimator.validation_misfit(smaller), larger)


def adequate(fit: Fit) -> bool:
    """Whether an explanation leaves no structure, and so nothing worth a search among others of its size."""
    return unstructured(fit.ratio, fit.repetition)


def unstructured(ratio: float, repetition: float) -> bool:
    """Whether a residual is nothing but noise, by its `ratio` to the noise estimated."""
    return ratio <= ADEQUATE or _white(ratio, repetition)


def complete(fit: Fit) -> bool:
    """Whether an explanation leaves so little that the search among those of its size may end."""
    return fit.ratio <= COMPLETE or _white(fit.ratio, fit.repetition)


def _white(ratio: float, repetition: float) -> bool:
    """Whether a residual is white, up to a tenth above the noise estimated, which is uncertain."""
    return ratio < EXPLAINED and repetition < WHITE


def accounts_for_all(fit: Fit, data: Data) -> bool:
    """Whether an explanation with an effect leaves white noise but for what simulators may differ by.

    In closed loop noise moves the shaft, and its estimate is too low: what is white then is noise, too.
    """
    if not fit.explanation.variants:
        return False
    small = fit.misfit < fit.solution.residual.size + allowance(fit, data)
    return (small and fit.repetition < WHITE) or (fit.ratio < EXPLAINED and fit.repetition <= PURE)


def overlooks(fit: Fit, estimator: Estimator) -> bool:
    """Whether an explanation without an effect accounts for training but not for validation samples."""
    if fit.explanation.variants or not adequate(fit):
        return False
    samples = int(np.count_nonzero(estimator.data.validation))
    return estimator.validation_misfit(fit) > samples * (EXPLAINED * fit.ratio) ** 2


def allowance(fit: Fit, data: Data) -> float:
    """Chi2 by which two simulations of an explanation may differ; without an effect ours and the textbook's agree."""
    formulation = FORMULATION * data.scales.reading if fit.explanation.variants else 0.0
    return float(fit.solution.residual.size * (formulation**2 + data.unlike**2) / data.noise**2)


def alike(best: Fit) -> float:
    """Chi2 up to which a fit is not told apart from `best` by the training samples."""
    return best.misfit + TIED * best.repetition


def tied(best: Fit, among: Iterable[Fit], estimator: Estimator) -> list[Fit]:
    """Those `among` some fits of a search that the data cannot tell from `best`, itself if it is one of them.

    They fit the training samples alike; one that fails on the validation samples, where another does not, is out.
    """
    limit = alike(best)
    fits = [fit for fit in among if fit.misfit <= limit]
    errors = [estimator.validation_misfit(fit) for fit in fits]
    highest = _highest(min(errors, default=0.0), best)
    return [fit for fit, error in zip(fits, errors, strict=True) if error <= highest]


def _highest(least: float, fit: Fit) -> float:
    """Misfit on the validation samples from which a fit is out where another has the `least`."""
    return max(EXPLAINED**2 * least, least + SIGNIFICANT * fit.repetition)
