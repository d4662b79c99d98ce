"""What the data can tell apart: when a larger explanation is worth its quantities, and which ones fit alike."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.estimation.likelihood import EXPLAINED, TIED

SIGNIFICANT = 60.0
"""Gain in chi2, in effective samples, that one more quantity must bring. Measured: with it none of n = 100 blind
trials without an effect is given one, and 406 of 411 shown effects are named. Four times `PROMISING`. An error that
lasts is told by as much: white noise speaks for one with 18 at most (n = 3000, 22,500 samples each), noise whose
neighbours are correlated by 0.3 with 48 (n = 200), what n = 65 right explanations leave with 21, and a false one that
left 1.01 times the noise with 784."""
PROMISING = 15.0
"""Gain in chi2 that a first fit must promise on top of an adequate explanation to be followed up. Measured: in n = 13
recordings without an effect, drifted ones included, none gained as much."""


def gain(smaller: Fit, larger: Fit) -> float:
    """What the larger explanation gains in chi2, counted in effective samples."""
    return (smaller.misfit - larger.misfit) / larger.repetition


def gains_enough(smaller: Fit, larger: Fit, more: int) -> bool:
    """Whether so many quantities `more` gain what each has to, beyond what simulations of the smaller may differ by."""
    return gain(smaller, larger) > SIGNIFICANT * more + allowance(smaller) / larger.repetition


def betters(larger: Fit, smaller: Fit, estimator: Estimator) -> bool:
    """Whether a larger explanation gains more than chance and the difference of simulators can give it.

    It may not fail on the validation samples where the smaller one does not: then it fits the training samples alone.
    """
    more = larger.explanation.size - smaller.explanation.size
    if not gains_enough(smaller, larger, more):
        return False
    return estimator.validation_misfit(larger) <= _highest(estimator.validation_misfit(smaller), larger)


def adequate(fit: Fit) -> bool:
    """Whether an explanation accounts for all: it leaves nothing but noise, of a size that may be estimated low.

    What remains is one more quantity, and told by as much as any other.
    """
    return fit.ratio < EXPLAINED and fit.structure < SIGNIFICANT


def names_all(fit: Fit) -> bool:
    """Whether an explanation with an effect accounts for all."""
    return bool(fit.explanation.variants) and adequate(fit)


def overlooks(fit: Fit, estimator: Estimator) -> bool:
    """Whether an explanation without an effect accounts for training but not for validation samples."""
    if fit.explanation.variants or not adequate(fit):
        return False
    samples = int(np.count_nonzero(estimator.data.validation))
    return estimator.validation_misfit(fit) > samples * (EXPLAINED * fit.ratio) ** 2


def allowance(fit: Fit) -> float:
    """Chi2 of what is no evidence though it lasts."""
    return fit.solution.residual.size * fit.unlike**2


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
