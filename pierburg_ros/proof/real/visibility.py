"""Whether a real recording can show what is put into it: apart from drift, and beside what remains there.

As for blind trials (`proof/visibility.py`), with what a machine leaves of its model in the place of what is simulated
beside the effect. No search is asked: only the recording as it is, its model, and the model with the change.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.inference.data import data_of
from pierburg_ros.inference.explanation import Explanation
from pierburg_ros.inference.fit import Fitter, ladder
from pierburg_ros.inference.least_squares import BRIEF
from pierburg_ros.inference.search import free_parameters
from pierburg_ros.plant import Model
from pierburg_ros.proof.visibility import VISIBLE
from pierburg_ros.recording import Recording


@dataclass(frozen=True)
class Visibility:
    """How far a change stands out of what remains.

    `distance` is squared, from the nearest single drift, in standard deviations of what remains, in effective samples. `moves` is what the change leaves in the signal once all that may drift is
    refitted, `remains` what the model without it misses then; root mean squares in the measured unit.
    """

    distance: float
    moves: float
    remains: float

    @property
    def shown(self) -> bool:
        """Whether the recording tells the change from a drift, and it moves the signal more than what else remains."""
        return self.distance >= VISIBLE and self.moves >= self.remains


def visibility(recording: Recording, model: Model, changed: Model, name: str) -> Visibility:
    """Judge what changes a `recording` of a machine like `model` as it changes that to `changed`, by the number `name`.

    All is linear around the model, with the longest pull of a fit.
    InputError where the recording cannot be used.
    """
    data = data_of([recording], model)
    fitter = Fitter(data, model, ladder(data)[-1])
    drifts = tuple(each for each in free_parameters(model) if each != name)
    left = fitter.fit(Explanation(drifts), model.values, BRIEF)
    described = fitter.fit(Explanation(), model.values, 0)
    change = (fitter.residual(changed) - fitter.residual(model))[data.train]
    slopes = {drift: fitter.slopes(described, Explanation((drift,))) for drift in drifts}
    counted = left.repetition * max(left.ratio**2, 1.0)
    nearest = min((_beside(change, slope) for slope in slopes.values()), default=float(change @ change)) / counted
    together = np.concatenate([np.zeros((change.size, 0)), *slopes.values()], axis=1)
    moves = math.sqrt(_beside(change, together) / change.size) * data.noise
    return Visibility(nearest, moves, left.ratio * data.noise)


def _beside(change: Signal, slopes: Signal) -> float:
    """Squared size of a change that no combination of some slopes, shape (samples, drifts), makes."""
    basis = np.linalg.qr(slopes)[0]
    rest = change - basis @ (basis.T @ change)
    return float(rest @ rest)
