"""What the audit holds against an actuator: the signals of a recording, and what a slip does to them."""

from __future__ import annotations

from dataclasses import dataclass, replace

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
    """Measured samples and the inputs in force, as they are read or as a slip would have them.

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
    def elsewhere(recording: Recording) -> Signals | None:
        """As `of`, from the longer of what lies before and after that part; None where that is shorter than a third."""
        taken, size = _liveliest(recording.measured, SAMPLES), recording.measured.size
        before, after = (0, taken.start), (taken.stop, size)
        start, end = max(before, after, key=lambda part: part[1] - part[0])
        if end - start < (taken.stop - taken.start) // 3:
            return None
        kept = _liveliest(recording.measured[start:end], SAMPLES)
        return Signals._at(recording, slice(start + kept.start, start + kept.stop))

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
    def duration(self) -> float:
        """Time from the first to the last sample [s]."""
        return float(self.time[-1] - self.time[0])

    @property
    def command(self) -> Signal:
        """The input in force at each sample, shape (samples,)."""
        return Channel(self.inputs.time, self.inputs.command).at(self.time, before=0.0)

    def measured_as(self, scale: float = 1.0, offset: float = 0.0) -> Signals:
        """With scale * measured + offset as the measured values."""
        return replace(self, measured=scale * self.measured + offset)

    def driven_by(self, scale: float = 1.0, offset: float = 0.0) -> Signals:
        """With scale * input + offset as the input; a duty ends at its limits."""
        values = scale * self.inputs.command + offset
        limited = np.clip(values, -1.0, 1.0) if self.input == "duty" else values
        return replace(self, inputs=replace(self.inputs, command=limited))

    def exchanged(self) -> Signals | None:
        """With the measured values as the input and the input as measured; None where no duty can be such a value."""
        if self.input == "duty" and float(np.max(np.abs(self.measured))) > 1.0:
            return None
        times = np.unique(np.concatenate([self.inputs.time, self.time]))
        supply, enabled = self.inputs.supply_voltage, self.inputs.enabled
        inputs = Inputs(
            times,
            Channel(self.time, self.measured).at(times),
            None if supply is None else Channel(self.inputs.time, supply).at(times),
            None if enabled is None else Channel(self.inputs.time, enabled.astype(float)).at(times, before=1.0) > 0.5,
        )
        return replace(self, measured=self.command, inputs=inputs)

    def supplied_with(self, scale: float) -> Signals:
        """With scale * supply voltage."""
        supply = self.inputs.supply_voltage
        return self if supply is None else replace(self, inputs=replace(self.inputs, supply_voltage=scale * supply))

    def delayed(self, by: float) -> Signals:
        """With the inputs `by` [s] later."""
        return replace(self, inputs=replace(self.inputs, time=self.inputs.time + by))

    def late_by(self, begin: float, growth: float) -> Signals:
        """With the inputs `begin` [s] later, and by `growth` more with every second."""
        time = self.inputs.time
        return replace(self, inputs=replace(self.inputs, time=time + begin + growth * time))

    def timed_in(self, unit: float) -> Signals:
        """With times counted in `unit` [s]."""
        return replace(self, time=unit * self.time, inputs=replace(self.inputs, time=unit * self.inputs.time))


def _liveliest(measured: Signal, samples: int) -> slice:
    """So many samples over which the measured value goes farthest, to and fro; all where there are no more."""
    if measured.size <= samples:
        return slice(0, measured.size)
    coarse = max(samples // 100, 1)
    way = np.cumsum(np.abs(np.diff(measured[::coarse], prepend=measured[0])))
    across = samples // coarse
    start = coarse * int(np.argmax(way[across:] - way[:-across]))
    return slice(start, start + samples)
