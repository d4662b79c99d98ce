"""The first part of each recording: enough to tell what one more quantity promises, in a fraction of the time."""

from __future__ import annotations

from pierburg_ros.effects import EFFECT
from pierburg_ros.estimation.data import BLOCK, CYCLE
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.estimation.explanation import Variant
from pierburg_ros.estimation.likelihood import counted

FIRST_PART = 2 * CYCLE * BLOCK
"""Length of the part of a recording that a first fit uses, in the actuator's own time. Derived: two cycles of eight
blocks, so that every kind of block occurs twice."""
LATE = 0.5
"""Squared error beyond the noise in the first part, as a share of that in the whole, below which a first fit uses whole
recordings. Derived: the first part would show less than half of what is left to explain."""


def first_part(whole: Estimator) -> Estimator:
    """The same for the first part of each run."""
    return whole.on(whole.data.cut(FIRST_PART * whole.data.scales.time))


def where_shown(base: Fit, whole: Estimator, first: Estimator) -> tuple[Estimator, Fit]:
    """The estimator of the `first` part and `base` there, or of `whole` recordings if these show most of its error."""
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
