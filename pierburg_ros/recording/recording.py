"""A recording: what was measured and what drove it, on one clock."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from pierburg_ros.errors import InputError
from pierburg_ros.recording.file_times import FileTimes
from pierburg_ros.recording.loss import Loss, Span, merged, sentence, within
from pierburg_ros.recording.signal_map.source import Source, TimeSource
from pierburg_ros.recording.signals import DRIVING

Samples = NDArray[np.float64]
UNITS = {"hall_voltage": "V", "position": "rad", "speed": "rad/s"}
"""Unit of each quantity that may be measured, of a rotary actuator."""
INPUTS = {"duty": "1", "current": "A", "torque": "N.m"}
"""Unit of each input that may drive a rotary actuator."""


@dataclass(frozen=True, eq=False)
class Channel:
    """Values that each hold from their time [s] until the next one's; both of shape (changes,)."""

    time: Samples
    values: Samples

    def __post_init__(self) -> None:
        object.__setattr__(self, "time", np.asarray(self.time, dtype=np.float64))
        object.__setattr__(self, "values", np.asarray(self.values, dtype=np.float64))
        check_signal("a channel", self.time, self.values)

    def __repr__(self) -> str:
        return f"Channel({self.time.size} values from {self.time[0]:.4g} to {self.time[-1]:.4g} s)"

    def at(self, time: Samples, before: float | None = None) -> Samples:
        """Values in force at `time` [s]; earlier than the first one: `before`, or else the first value."""
        place = np.searchsorted(self.time, time, side="right") - 1
        first = self.values[0] if before is None else before
        return np.where(place < 0, first, self.values[np.maximum(place, 0)])

    def select(self, start: float, end: float) -> Channel | None:
        """The part that acts in [start, end], its time counted from `start` [s]; None where nothing does."""
        first = max(int(np.searchsorted(self.time, start, side="right")) - 1, 0)
        last = int(np.searchsorted(self.time, end, side="right"))
        return Channel(self.time[first:last] - start, self.values[first:last]) if last > first else None


@dataclass(frozen=True, eq=False)
class Recording:
    """Measured samples of the shaft and the signals that acted on it.

    `time` [s] counts from the first sample that was measured, shape (samples,); `measured` is the `quantity`: Hall
    voltage [V], position [rad] or speed [rad/s]. The channels are the `command`, which is what `input` says, signed
    duty [1], current [A] or torque [N.m]; supply voltage [V], temperature [degC], bridge enabled [0 or 1] and
    setpoints [rad]. What was recorded before the first sample has a negative time. Of a linear actuator all of them
    are in m and N. `time_source` says which clock the times come from. A sample that was sent again, with the same
    time and value as in lockstep without a reply, counts once. `losses` tells of messages that are known to be missing,
    `path` where it was read from and `read_with` with which options of a command, `file_times` when its samples lie
    there. `sources` says where each signal was read from, and `clock` the times, where a map or a table says it. What
    is `exact` (an input or a quantity) is what it is read as.
    """

    name: str
    quantity: str
    time: Samples
    measured: Samples
    command: Channel
    supply_voltage: Channel | None = None
    temperature: Channel | None = None
    enabled: Channel | None = None
    setpoints: Channel | None = None
    time_source: str = "stamp"
    losses: tuple[Loss, ...] = ()
    input: str = "duty"
    path: Path | None = None
    file_times: FileTimes | None = None
    read_with: tuple[str, ...] = ()
    sources: Mapping[str, Source] = field(default_factory=dict)
    clock: TimeSource | None = None
    exact: frozenset[str] = frozenset()

    def __post_init__(self) -> None:
        object.__setattr__(self, "time", np.asarray(self.time, dtype=np.float64))
        object.__setattr__(self, "measured", np.asarray(self.measured, dtype=np.float64))
        if self.quantity not in UNITS:
            raise InputError(f"{self.name}: found quantity {self.quantity!r}, expected one of {', '.join(UNITS)}.")
        if self.input not in INPUTS:
            raise InputError(f"{self.name}: found input {self.input!r}, expected one of {', '.join(INPUTS)}.")
        check_signal(f"{self.name}: {self.quantity}", self.time, self.measured)
        self._drop_repeats()
        if self.time.size < 2 or self.time[-1] <= 0:
            raise InputError(
                f"{self.name} spans no time ({self.time.size} samples of {self.quantity}), expected two"
                " samples or more at different times. Record longer."
            )
        largest = float(np.max(np.abs(self.command.values)))
        if self.input == "duty" and largest > 1.0 + 1e-9:
            raise InputError(
                f"{self.name}: found a duty of magnitude {largest:g}, expected a fraction within [-1, 1]."
                " Divide percentages by 100 (`duty: {unit: percent}` in a signal map) and counts by those of full duty"
                " (`duty: {scale: ...}`), and record the duty that was applied, no setpoint."
            )

    def __repr__(self) -> str:
        return (
            f"Recording({self.name}: {self.quantity} [{self.unit}] under {self.input}, {self.time.size} samples over"
            f" {self.duration:.4g} s)"
        )

    def _drop_repeats(self) -> None:
        again = np.flatnonzero(np.diff(self.time) == 0.0) + 1
        other = again[self.measured[again] != self.measured[again - 1]]
        if other.size:
            raise InputError(
                f"{self.name} has {other.size} samples of {self.quantity} with the time of the sample before and"
                f" another value, first at {self.time[other[0]]:.3f} s ({self.time_source} time), expected a time for"
                " each. Choose a finer clock with --time {stamp,clock,publish,log}."
            )
        object.__setattr__(self, "time", np.delete(self.time, again))
        object.__setattr__(self, "measured", np.delete(self.measured, again))

    @property
    def unit(self) -> str:
        """Unit of the measured quantity of a rotary actuator."""
        return UNITS[self.quantity]

    def source(self, signal: str) -> tuple[str, Source]:
        """What a signal map calls a signal, an input or a quantity, and where it was read from."""
        for name, source in self.sources.items():
            if signal in (name, DRIVING.get(name)):
                return name, source
        return signal, Source("topic", "")

    @property
    def duration(self) -> float:
        """Time from the first to the last measured sample [s]."""
        return float(self.time[-1] - self.time[0])

    @property
    def unknown_input(self) -> tuple[Span, ...]:
        """Spans [s] in which the input is not known, because messages are missing; in order, without overlap."""
        return merged(tuple(span for loss in self.losses if loss.signal == self.input for span in loss.spans))

    @property
    def missing_samples(self) -> tuple[Span, ...]:
        """Spans [s] between two measured samples in which others are missing."""
        return merged(tuple(span for loss in self.losses if loss.signal == self.quantity for span in loss.spans))

    @property
    def warning(self) -> str:
        """What to say first of this recording if messages are missing, or nothing."""
        return sentence(self.losses, self.input, self.unknown_input)

    def select(self, start: float, end: float) -> Recording:
        """The samples within [start, end] [s] and what acts on them; times count from the first of them."""
        inside = (self.time >= start) & (self.time <= end)
        if np.count_nonzero(inside) < 2:
            raise InputError(f"{self.name} has no two samples from {start:g} to {end:g} s. Choose a longer window.")
        origin, last = self.time[inside][0], self.time[inside][-1]
        command = self.command.select(origin, last) or Channel(np.zeros(1), np.zeros(1))
        others = {
            role: channel.select(origin, last)
            for role in ("supply_voltage", "temperature", "enabled", "setpoints")
            if (channel := getattr(self, role)) is not None
        }
        time, measured = self.time[inside] - origin, self.measured[inside]
        losses = within(self.losses, float(origin), float(last))
        file_times = self.file_times and self.file_times.since(float(origin))
        return replace(
            self, time=time, measured=measured, command=command, losses=losses, file_times=file_times, **others
        )


def check_signal(what: str, time: Samples, values: Samples) -> None:
    """Refuse a signal that is empty, not finite, of unequal lengths, or whose time runs backwards."""
    if time.ndim != 1 or time.shape != values.shape or time.size == 0:
        raise InputError(f"{what} has {time.size} times and {values.size} values, expected equally many, one or more.")
    bad = np.flatnonzero(~(np.isfinite(time) & np.isfinite(values)))
    if bad.size:
        raise InputError(
            f"{what} has samples that are NaN or infinite ({bad.size} of {time.size}, first the sample at"
            f" {time[bad[0]]:.3f} s), expected finite numbers. Cut or repair the recording there."
        )
    backwards = np.flatnonzero(np.diff(time) < 0)
    if backwards.size:
        place = backwards[0]
        raise InputError(
            f"{what} has a clock running backwards at {time[place]:.3f} s (by"
            f" {time[place] - time[place + 1]:.3g} s), expected times that never decrease."
            " Cut the recording there."
        )
