"""What the data can distinguish: when a larger explanation is worth its quantities, and which ones are tied."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from pierburg_ros.estimation.estimator import Estimator, Fit, adequate
from pierburg_ros.estimation.likelihood import EXPLAINED, SIGNIFICANT, TIED

PROMISING = 15.0
"""Gain in chi2 over an adequate explanation that a first fit must promise to be followed up. Measured: in n = 13
recordings without an effect, drifted ones included, none gained as much."""


def gain(smaller: Fit, larger: Fit) -> float:
    """The gain of the larger explanation in chi2, in effective samples."""
    return (smaller.misfit - larger.misfit) / larger.repetition


def gains_enough(smaller: Fit, larger: Fit, more: int) -> bool:
    """Whether `more` further quantities gain `SIGNIFICANT` each, beyond the `allowance` of the smaller explanation."""
    return gain(smaller, larger) > SIGNIFICANT * more + allowance(smaller) / larger.repetition


def betters(larger: Fit, smaller: Fit, estimator: Estimator) -> bool:
    """Whether a larger explanation gains more than chance and the difference between simulators can give it.

    It may not fail on the validation samples where the smaller one does not: then it would fit the training samples
    alone.
    """
    more = larger.explanation.size - smaller.explanation.size
    if not gains_enough(smaller, larger, more):
        return False
    return estimator.validation_misfit(larger) <= _highest(estimator.validation_misfit(smaller), larger)


def names_all(fit: Fit) -> bool:
    """Whether an explanation has an effect and is adequate."""
    return bool(fit.explanation.variants) and adequate(fit)


def overlooks(fit: Fit, estimator: Estimator) -> bool:
    """Whether an explanation without an effect is adequate on the training but fails on the validation samples."""
    if fit.explanation.variants or not adequate(fit):
        return False
    samples = int(np.count_nonzero(estimator.data.validation))
    return estimator.validation_misfit(fit) > samples * (EXPLAINED * fit.ratio) ** 2


def allowance(fit: Fit) -> float:
    """Chi2 of errors that are correlated in time but are no evidence, such as the difference between simulators."""
    return fit.solution.residual.size * fit.unlike**2


def alike(best: Fit) -> float:
    """Chi2 up to which the training samples do not distinguish a fit from `best`."""
    return best.misfit + TIED * best.repetition


def tied(best: Fit, among: Iterable[Fit], estimator: Estimator) -> list[Fit]:
    """Those `among` the fits of a search that the data do not distinguish from `best`, which may be one of them.

    They fit the training samples equally well. A fit that fails on the validation samples where another does not is
    left out.
    """
    limit = alike(best)
    fits = [fit for fit in among if fit.misfit <= limit]
    errors = [estimator.validation_misfit(fit) for fit in fits]
    highest = _highest(min(errors, default=0.0), best)
    return [fit for fit, error in zip(fits, errors, strict=True) if error <= highest]


def _highest(least: float, fit: Fit) -> float:
    """Highest misfit on the validation samples that a fit may have where another has the `least`."""
    return max(EXPLAINED**2 * least, least + SIGNIFICANT * fit.repetition)
