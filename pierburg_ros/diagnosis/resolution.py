"""The steps of the converter, which are seen in the samples themselves and need no fit.

Rounding a simulation does not make it fit better while the noise carries samples over the steps: noise of standard
deviation s leaves an error of 0.8 s d (squared) beside a rounded signal with steps d, and s^2 + d^2 / 12 beside a
smooth one, which is less up to d = 8 s.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from pierburg_ros.diagnosis.evidence_data import EvidenceData
from pierburg_ros.diagnosis.explanation import Variant
from pierburg_ros.diagnosis.search import Fit
from pierburg_ros.effects import EFFECT

COARSE = 3.0
"""Steps of so many standard deviations of the noise before rounding decide what is measured."""
OFF_GRID = 0.02
"""Distance from the grid, in steps, that rounding of the file format may cause."""


def coarse_step(data: EvidenceData) -> float:
    """Step [measured unit] on whose grid all samples lie, if it is coarse beside the noise; otherwise 0."""
    step = min(_grid(run.measured) for run in data.runs)
    noise = np.sqrt(max(data.noise**2 - step**2 / 12.0, 0.0))
    plausible = EFFECT["sensor_quantization"].parameter("step").plausible[0]
    return step if step >= plausible and step > COARSE * noise else 0.0


def _grid(measured: np.ndarray) -> float:
    """Smallest step between values if all are whole steps apart, otherwise 0."""
    values = np.unique(measured)
    if values.size < 3:
        return 0.0
    step = float(np.min(np.diff(values)))
    apart = (values - values[0]) / step
    step *= float(apart[-1]) / max(round(float(apart[-1])), 1)
    apart = (values - values[0]) / step
    return step if np.max(np.abs(apart - np.round(apart))) < OFF_GRID else 0.0


def rounded(fit: Fit, step: float) -> Fit:
    """`fit` with its model's samples rounded to `step`; what it leaves is that of the smooth one."""
    variant = Variant("sensor_quantization", (), (("step", step),))
    values = {"sensor_quantization.step": step}
    switch = fit.switch and replace(fit.switch, model=fit.switch.model.with_values(values))
    model = fit.model.with_values(values)
    return replace(
        fit, explanation=fit.explanation.plus(variant), values={**fit.values, **values}, model=model, switch=switch
    )
