"""What the data can tell apart: when a larger explanation is worth its quantities, and which ones fit alike."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.estimator import Estimator, Fit

SIGNIFICANT = 60.0
"""Gain in chi2, in effective samples, that one more quantity must bring; calibrated on recordings with none."""
TIED = 12.0
"""Difference in chi2, in effective samples, below which two explanations of one size are not told apart."""
REFUTED = 1.1
"""Error on the validation samples, over that of an explanation that fits the training samples alike or is smaller, from
which one is out."""
FORMULATION = 1.15e-4
"""What simulations of one effect may differ by [rad, root mean square], each right in its own way: 0.3 mV of Hall
voltage, the most that going from steps of 10 us to 5 changes for any effect in the textbook form (`docs/proof.md`)."""
PROMISING = 15.0
"""Gain in chi2 that a first look must promise on top of an adequate explanation to be followed up."""
ADEQUATE = 1.03
"""Training error over noise up to which an explanation accounts for all there is."""
COMPLETE = 1.01
"""Training error over noise at which the search for explanations of one size ends."""
EXPLAINED = 1.10
"""Error over noise, on training samples, from which structure is left that no tried explanation removes."""
WHITE = 1.5
"""Repetition of a residual up to which it passes for white noise."""


def gain(smaller: Fit, larger: Fit) -> float:
    """What the larger explanation gains in chi2, counted in effective samples."""
    return (smaller.misfit - larger.misfit) / larger.repetition


def betters(larger: Fit, smaller: Fit, estimator: Estimator) -> bool:
    """Whether a larger explanation gains more than chance and the difference of simulators can give it.

    One that fails on the validation samples, where the smaller does not, has only been bent to what trains.
    """
    more = larger.explanation.size - smaller.explanation.size
    if gain(smaller, larger) <= SIGNIFICANT * more + allowance(smaller, estimator.data) / larger.repetition:
        return False
    return estimator.validation_misfit(larger) <= _highest(estimator.validation_misfit(smaller), larger)


def white(fit: Fit) -> bool:
    """Whether an explanation leaves white noise, be it some percent more than estimated: the estimate is uncertain."""
    return fit.ratio < EXPLAINED and fit.repetition < WHITE


def adequate(fit: Fit) -> bool:
    """Whether an explanation leaves nothing worth a search among others of its size."""
    return fit.ratio <= ADEQUATE or white(fit)


def complete(fit: Fit) -> bool:
    """Whether an explanation leaves so little that the search among those of its size may end."""
    return fit.ratio <= COMPLETE or white(fit)


def accounts_for_all(fit: Fit, data: Data) -> bool:
    """Whether an explanation with an effect leaves white noise, and beyond it no more than simulators may differ by."""
    small = bool(fit.explanation.variants) and fit.misfit < fit.solution.residual.size + allowance(fit, data)
    return small and fit.repetition < WHITE


def overlooks(fit: Fit, estimator: Estimator) -> bool:
    """Whether an explanation without an effect accounts for the samples that train, but not for those that choose."""
    if fit.explanation.variants or not adequate(fit):
        return False
    samples = int(np.count_nonzero(estimator.data.validation))
    return estimator.validation_misfit(fit) > samples * (EXPLAINED * fit.ratio) ** 2


def allowance(fit: Fit, data: Data) -> float:
    """Chi2 by which two simulations of an explanation may differ; without an effect they agree."""
    if not fit.explanation.variants:
        return 0.0
    return float(fit.solution.residual.size * (FORMULATION / (data.noise * data.angle_per_unit)) ** 2)


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
    return max(REFUTED**2 * least, least + SIGNIFICANT * fit.repetition)
