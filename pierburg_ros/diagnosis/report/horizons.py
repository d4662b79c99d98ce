"""Prediction error of a model: its error some time after it has been set to the measured state."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from pierburg_ros.diagnosis.evidence.stretches import forgotten, leading_to, restarted
from pierburg_ros.diagnosis.schema import Horizon
from pierburg_ros.estimation.data import Data, rms
from pierburg_ros.estimation.run import Switch
from pierburg_ros.plant import Model

HORIZONS = (0.1, 0.3, 1.0, 3.0)
"""Times after the start from the measured state [s]. Given: the times that the report promises."""
LAST = 0.2
"""Share of a stretch, at its end, over which the error is taken. Chosen: it averages the noise; not varied."""

Simulated = tuple[Model, Switch | None]


def horizons(data: Data, models: Sequence[Simulated]) -> list[Horizon]:
    """RMSE of the nominal, the recalibrated and the final model after each of `HORIZONS`, and over whole runs.

    The errors are those of test samples, which neither fit nor choice has used. Each sample lies in the last part of a
    stretch. A brief memory of a model (play, bristles) starts afresh with each stretch. A longer memory (heat) is a
    state that an angle sensor does not show: such a model has an error over whole runs only.
    """
    found = []
    for after in (*HORIZONS, math.inf):
        stretches = leading_to(data, after, LAST * after) if math.isfinite(after) else restarted(data, after)
        # a recording may be too short for any stretch
        samples = stretches.test if stretches.runs else np.zeros(0, dtype=bool)
        errors = [
            rms(stretches.residual(model, switch)[samples]) * data.noise
            if samples.any() and (forgotten(model.active_effects) or math.isinf(after))
            else math.nan
            for model, switch in models
        ]
        nominal, recalibrated, final = errors
        found.append(Horizon(after=after, nominal_rmse=nominal, recalibrated_rmse=recalibrated, final_rmse=final))
    return found
