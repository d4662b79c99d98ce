"""The least-squares problem of a fit: residuals of whole recordings and how they follow the parameters."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.errors import InputError
from pierburg_ros.estimation.resimulation import Resimulation
from pierburg_ros.estimation.scaling import Scaling
from pierburg_ros.plant import Model
from pierburg_ros.recording.recording import Recording

COARSE_STEP = 0.005
"""Difference step far from the minimum: 0.5 % of a positive parameter, to look across stick and slip."""
FINE_STEP = 1e-5
"""Difference step near the minimum: a covariance needs the slope within its own interval."""
FINEST_STEP = 1e-7
"""Difference step where a bend lies within the fine one; the stiffer effects are too noisy for it."""
SMOOTH = 1e-4
"""Largest relative difference of the slopes ahead and behind where the residual is smooth."""
WEAK = 0.05
"""A coordinate that its own slope tells no better than this may still be told by jumps."""
JUMP_STEPS = (1e-4, 1e-3, COARSE_STEP)
"""Steps tried, finest first, for a parameter that acts in jumps."""
RUNAWAY = 1e3
"""Residual that stands for a model that cannot be simulated, in the measured unit."""


class Problem:
    """Residuals, measured less simulated, of the recordings one after another, shape (samples,)."""

    def __init__(self, recordings: Sequence[Recording], scaling: Scaling, threads: int | None = None) -> None:
        if not recordings:
            raise InputError("There is no recording to fit; expected one or more. Name a file.")
        if len({recording.quantity for recording in recordings}) > 1:
            raise InputError(
                "The recordings hold Hall voltage and position; expected one quantity. Fit them one by one."
            )
        self.runs = [Resimulation(recording, scaling.base.actuator) for recording in recordings]
        self.measured = np.concatenate([recording.measured for recording in recordings])
        self.lengths = [recording.measured.size for recording in recordings]
        self.scaling = scaling
        self.threads = threads
        self.evaluations = 0

    def residuals(self, points: Sequence[Signal]) -> Signal:
        """Residuals at each of `points` (coordinates), shape (points, samples)."""
        models = [self.scaling.model(np.asarray(point)) for point in points]
        return self.of_models(models)

    def of_models(self, models: Sequence[Model]) -> Signal:
        """Residuals of each of `models`, shape (models, samples)."""
        self.evaluations += len(models)
        simulated = np.hstack([run.simulated(models, self.threads) for run in self.runs])
        return np.nan_to_num(self.measured - simulated, nan=RUNAWAY, posinf=RUNAWAY, neginf=-RUNAWAY)

    def residual(self, point: Signal) -> Signal:
        """Residual at `point`, shape (samples,)."""
        return np.asarray(self.residuals([point])[0])

    def jacobian(self, point: Signal, step: float) -> Signal:
        """Derivative of the residual by central differences, one-sided at a bound; shape (samples, names)."""
        ahead = np.minimum(point + step * np.eye(point.size), self.scaling.upper)
        behind = np.maximum(point - step * np.eye(point.size), self.scaling.lower)
        values = self.residuals([*ahead, *behind])
        distance = np.diagonal(ahead - behind)
        return np.asarray(((values[: point.size] - values[point.size :]) / distance[:, None]).T)

    def sharp_jacobian(self, point: Signal) -> Signal:
        """The Jacobian for covariances, each column with the step that sees the least bend around `point`.

        A shaft that only just breaks loose bends the residual, and fits like to end on such a bend. Columns
        taken across it do not add up: an exact tie of parameters would look as if the recording broke it.
        """
        jacobian, bend = self._bend(point, FINE_STEP)
        if np.any(bend > SMOOTH):
            closer, less = self._bend(point, FINEST_STEP)
            jacobian = np.where(less < bend, closer, jacobian)
        noise = float(np.linalg.norm(self.residual(point))) / np.sqrt(self.measured.size)
        for index in np.flatnonzero(np.linalg.norm(jacobian, axis=0) * WEAK < noise).tolist():
            jacobian[:, index] = self._across_jumps(point, index, jacobian[:, index], noise)
        return jacobian

    def _across_jumps(self, point: Signal, index: int, column: Signal, noise: float) -> Signal:
        """The column of a parameter that acts in jumps, as when the shaft breaks loose a sample later.

        Taken with the finest step that sees jumps, its length held down so that the deviation is no less.
        """
        for step in JUMP_STEPS:
            offset = step * np.eye(point.size)[index]
            high = np.minimum(point + offset, self.scaling.upper)
            low = np.maximum(point - offset, self.scaling.lower)
            ahead, behind = self.residuals([high, low])
            jumps = (ahead - behind) / (high - low)[index]
            length = float(np.linalg.norm(jumps))
            if length * step > noise:
                return np.asarray(jumps * noise / (length * step))
        return column

    def _bend(self, point: Signal, step: float) -> tuple[Signal, Signal]:
        """The Jacobian at `point` and, for each column, how far the slopes ahead and behind are apart."""
        jacobian, middle = self.jacobian(point, step), self.residual(point)
        ahead = np.minimum(point + step * np.eye(point.size), self.scaling.upper)
        distance = np.maximum(np.diagonal(ahead) - point, 1e-300)
        one_sided = ((self.residuals(list(ahead)) - middle) / distance[:, None]).T
        length = np.maximum(np.linalg.norm(jacobian, axis=0), 1e-300)
        return jacobian, np.asarray(np.linalg.norm(one_sided - jacobian, axis=0) / length)

    def parts(self, residual: Signal) -> tuple[Signal, ...]:
        """`residual` cut into the recordings it comes from."""
        return tuple(np.split(residual, np.cumsum(self.lengths)[:-1]))
