"""What a recording measured beside what a model would have measured under the same input."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.inference.replay import resimulated
from pierburg_ros.plant import Model
from pierburg_ros.recording import Recording
from pierburg_ros.recording.noise import noise_of

STRETCH = 1.0
"""Length [s] of the stretch that is named as the worst; a quarter of a recording shorter than 4 s."""


@dataclass(frozen=True)
class Stretch:
    """A part of a recording: start and end [s], RMSE in the measured unit, share of the residual's energy."""

    start: float
    end: float
    rmse: float
    share: float


@dataclass(frozen=True)
class Comparison:
    """A recording, the model it was simulated with, and the simulated samples in the recording's unit."""

    recording: Recording
    model: Model
    simulated: Signal

    @property
    def unit(self) -> str:
        """Unit of the measured quantity."""
        return self.model.actuator.shown(self.recording.unit)

    @property
    def residual(self) -> Signal:
        """Measured minus simulated, shape (samples,)."""
        return self.recording.measured - self.simulated

    @property
    def rmse(self) -> float:
        """Root of the mean squared residual, in the measured unit."""
        return float(np.sqrt(np.mean(self.residual**2)))

    @property
    def noise(self) -> float:
        """Standard deviation of the measured signal's white part, in its unit: what no model can explain."""
        return noise_of(self.recording.time, self.recording.measured)

    @property
    def variance_explained(self) -> float | None:
        """Share of the measured variance that the model explains, 1 at best; None where nothing moves."""
        measured = self.recording.measured
        return 1.0 - self.rmse**2 / float(np.var(measured)) if np.ptp(measured) > 0.0 else None

    @property
    def worst(self) -> Stretch:
        """The stretch with the largest RMSE."""
        time, energy = self.recording.time, np.concatenate([[0.0], np.cumsum(self.residual**2)])
        length = min(STRETCH, time[-1] / 4.0)
        first = np.arange(int(np.searchsorted(time, time[-1] - length, side="right")))
        last = np.searchsorted(time, time[first] + length, side="left")
        within = energy[last] - energy[first]
        at = int(np.argmax(within / (last - first)))
        rmse = float(np.sqrt(within[at] / (last[at] - first[at])))
        share = float(within[at] / energy[-1]) if energy[-1] > 0.0 else 0.0
        return Stretch(float(time[first[at]]), float(time[last[at] - 1]), rmse, share)

    def as_mapping(self) -> dict[str, Any]:
        """The content of replay.json."""
        recording, worst = self.recording, self.worst
        largest = int(np.argmax(np.abs(self.residual)))
        return {
            "schema": 1,
            "recording": recording.name,
            "model": self.model.as_mapping(),
            "quantity": recording.quantity,
            "unit": self.unit,
            "time_source": recording.time_source,
            "samples": int(recording.time.size),
            "duration": recording.duration,
            "rmse": self.rmse,
            "noise": self.noise,
            "variance_explained": self.variance_explained,
            "largest_residual": {
                "time": float(recording.time[largest]),
                "value": float(self.residual[largest]),
            },
            "worst_stretch": {
                "start": worst.start,
                "end": worst.end,
                "rmse": worst.rmse,
                "share_of_residual_energy": worst.share,
            },
        }


def compare(model: Model, recording: Recording) -> Comparison:
    """`recording` beside the answer of `model` to its inputs, after each stretch of unknown input begun anew."""
    recording, simulated = resimulated(model, recording)
    return Comparison(recording, model, simulated)
