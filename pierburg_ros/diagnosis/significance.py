"""When a larger explanation is worth its additional quantities: by evidence, beyond what simulators differ by."""

from __future__ import annotations

from pierburg_ros.diagnosis.evidence_data import EvidenceData
from pierburg_ros.diagnosis.search import Fit, repetition

SIGNIFICANT = 60.0
"""Gain in chi2, in effective samples, that one more quantity must bring; calibrated on recordings with none."""
FORMULATION = 1.15e-4
"""What simulations of one effect may differ by [rad, root mean square], each right in its own way: 0.3 mV of Hall
voltage, the most that going from steps of 10 us to 5 changes for any effect in the textbook form (`docs/proof.md`)."""

WHITE = 1.5
"""Repetition of a residual up to which it passes for white noise: its estimated size is uncertain by some percent."""


def gain(smaller: Fit, larger: Fit) -> float:
    """What the larger explanation gains in chi2, counted in effective samples."""
    return (smaller.chi2 - larger.chi2) / repetition(larger)


def betters(larger: Fit, smaller: Fit, data: EvidenceData) -> bool:
    """Whether a larger explanation gains more than chance and the difference of simulators can give it."""
    more = larger.explanation.size - smaller.explanation.size
    return gain(smaller, larger) > SIGNIFICANT * more + allowance(smaller, data) / repetition(larger)


def accounts_for_all(fit: Fit, data: EvidenceData) -> bool:
    """Whether an explanation with an effect leaves white noise, and beyond it no more than simulators may differ by."""
    small = bool(fit.explanation.variants) and fit.chi2 < fit.solution.residual.size + allowance(fit, data)
    return small and repetition(fit) < WHITE


def allowance(fit: Fit, data: EvidenceData) -> float:
    """Chi2 by which two simulations of an explanation may differ; without an effect they agree."""
    if not fit.explanation.variants:
        return 0.0
    return float(fit.solution.residual.size * (FORMULATION / (data.noise * data.angle_per_unit)) ** 2)
