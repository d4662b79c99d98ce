"""The balance of torques along a measured motion: what a model lacks where the shaft moves; nothing is simulated.

In motion the motor's torque must equal load, friction, inertia and what effects add. All are known functions of what
was measured, so that a fit has one minimum and takes milliseconds, and an error at one moment stays there. Robotics
calls it the inverse dynamic identification model (Gautier and Khalil, Exciting trajectories for the identification of
base inertial parameters of robots, 1992).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter

from pierburg_ros.actuators import Actuator
from pierburg_ros.arrays import Signal
from pierburg_ros.effects import EFFECT
from pierburg_ros.inference.data import Data
from pierburg_ros.inference.motion import KEPT_OF_FILTER, Motion, motion_of
from pierburg_ros.plant import Model

OUTLYING = 6.0
"""Residual, in median absolute ones, beyond which a sample is left out: it is an event. Derived: of normal errors one
in 20,000."""
EVENT = 4 * KEPT_OF_FILTER + 1
"""Samples around one that tell what lasts there. Derived: an event changes those of two lengths of the filter, which a
median of four does not see."""


@dataclass(frozen=True)
class Balance:
    """The motions of all recordings of one actuator."""

    actuator: Actuator
    motions: tuple[Motion, ...]

    @property
    def size(self) -> int:
        """Number of samples of all motions."""
        return sum(motion.samples.size for motion in self.motions)

    @property
    def duration(self) -> float:
        """Time of the last sample of the longest motion [s]."""
        return max(float(motion.whole.time[-1]) for motion in self.motions)

    def missing(self, values: Mapping[str, float], effects: Sequence[str]) -> Signal:
        """The load torque [N.m] that a model with these `values` and `effects` lacks, positive closes; (samples,)."""
        return np.concatenate([missing(motion, values, effects) for motion in self.motions])

    def residual(self, values: Mapping[str, float], effects: Sequence[str]) -> Signal:
        """The same as the command that is missing, which is known without any parameter; shape (samples,)."""
        return self.missing(values, effects) / self._per_command(values)

    def column(self, values: Mapping[str, float], effect: str) -> Signal:
        """What one effect adds to that residual, shape (samples,)."""
        along = EFFECT[effect].along
        assert along is not None
        return -np.concatenate([along(motion, values) for motion in self.motions]) / self._per_command(values)

    def _per_command(self, values: Mapping[str, float]) -> Signal:
        """The torque [N.m] that a command of 1 makes."""
        return np.concatenate([motion.driven(values, np.ones(motion.samples.size)) for motion in self.motions])

    def without_outliers(self, residual: Signal) -> Balance:
        """The same without the samples in which a `residual` is outlying."""
        return self._only(np.abs(residual))

    def without_events(self, residual: Signal) -> Balance:
        """The same without those in which it leaves that around it: what lasts, as a load for some seconds, stays."""
        parts = np.split(residual, self._ends)
        return self._only(np.abs(np.concatenate([part - median_filter(part, EVENT) for part in parts])))

    def _only(self, size: Signal) -> Balance:
        """The samples in which a `size`, shape (samples,), is not outlying."""
        limit = OUTLYING * np.median(size) if size.size else 0.0
        inside = np.split(size <= limit, self._ends)
        kept = (motion.only(part) for motion, part in zip(self.motions, inside, strict=True))
        return Balance(self.actuator, tuple(kept))

    @property
    def _ends(self) -> NDArray[np.int64]:
        """Where the motions but the last end in arrays over all samples."""
        return np.cumsum([motion.samples.size for motion in self.motions])[:-1]


def balance_of(data: Data, model: Model, constant: float) -> Balance:
    """The balance along all runs, with filters for what a `model` does in a time `constant` [s]."""
    return Balance(data.actuator, tuple(motion_of(run, model, constant) for run in data.runs))


def missing(motion: Motion, values: Mapping[str, float], effects: Sequence[str]) -> Signal:
    """The load torque [N.m] that a model with these `values` lacks along one motion.

    It has these `effects`, and those that its actuator always has.
    """
    lacking = motion.motor_torque(values) - motion.load(values)
    for effect in dict.fromkeys((*motion.whole.actuator.effects, *effects)):
        along = EFFECT[effect].along
        if along is not None:
            lacking = np.asarray(lacking - along(motion, values))
    return lacking
