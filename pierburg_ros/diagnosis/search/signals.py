"""The signals of the part of a recording in which the most moves."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.inference.data import inputs_of
from pierburg_ros.plant import Inputs
from pierburg_ros.recording import Channel, Recording

SAMPLES = 10_000
"""Samples of a recording that are looked at, those with the most motion. Work: a slip shows throughout, and 20 s at 500
Hz are simulated in a millisecond."""


@dataclass(frozen=True)
class Signals:
    """Measured samples and the inputs in force.

    `time` [s] and `measured`, shape (samples,), in the unit of the `quantity`; `input` names what drives the actuator.
    """

    name: str
    quantity: str
    input: str
    time: Signal
    measured: Signal
    inputs: Inputs
    setpoints: Channel | None = None

    @staticmethod
    def of(recording: Recording, samples: int = SAMPLES) -> Signals:
        """The part of `recording` in which the most moves, so many `samples`."""
        return Signals._at(recording, _liveliest(recording.measured, samples))

    @staticmethod
    def _at(recording: Recording, kept: slice) -> Signals:
        return Signals(
            recording.name,
            recording.quantity,
            recording.input,
            recording.time[kept],
            recording.measured[kept],
            inputs_of(recording),
            recording.setpoints,
        )

    @property
    def interval(self) -> float:
        """Median time between samples [s]."""
        return float(np.median(np.diff(self.time)))

    @property
    def command(self) -> Signal:
        """The input in force at each sample, shape (samples,)."""
        return Channel(self.inputs.time, self.inputs.command).at(self.time, before=0.0)


def _liveliest(measured: Signal, samples: int) -> slice:
    """So many samples over which the measured value goes farthest, to and fro; all where there are no more."""
    if measured.size <= samples:
        return slice(0, measured.size)
    coarse = max(samples // 100, 1)
    way = np.cumsum(np.abs(np.diff(measured[::coarse], prepend=measured[0])))
    across = samples // coarse
    start = coarse * int(np.argmax(way[across:] - way[:-across]))
    return slice(start, start + samples)
