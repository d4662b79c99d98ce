"""Where a first fit may do with the first part of each recording, and where it may not."""

from __future__ import annotations

from pierburg_ros.effects import EFFECT
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.estimation.likelihood import counted
from pierburg_ros.inference.explanation import Variant

LATE = 0.5
"""Squared error beyond the noise in the first part, as a share of that in the whole, below which a first fit uses whole
recordings. Derived: the first part would show less than half of what is left to explain."""


def where_shown(base: Fit, whole: Estimator) -> tuple[Estimator, Fit]:
    """The estimator of the first part and `base` there, or of `whole` recordings if these show most of its error."""
    first = whole.first_part
    late = _excess(base, first) < LATE * _excess(base, whole)
    return (whole, base) if late else (first, first.restated(base))


def takes_time(variant: Variant) -> bool:
    """Whether an effect depends on the time since the start: the first part of a recording may not show it."""
    effect = EFFECT[variant.effect]
    return effect.dated or effect.memory == "lasting"


def _excess(fit: Fit, estimator: Estimator) -> float:
    """The squared error of a fit beyond the noise, on average over the training samples."""
    data = estimator.data
    residual = data.residual(fit.model, fit.switch)[data.train]
    return counted(residual, data.half_step) / max(residual.size, 1) - 1.0
