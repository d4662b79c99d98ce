"""Where a signal comes from, and how the numbers there become its values in SI."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from pierburg_ros.recording.signal_map.field_path import FieldPath
from pierburg_ros.recording.signals import SIGNALS


@dataclass(frozen=True)
class Source:
    """A topic or a column: value = sign * unit * scale * raw + offset, in SI.

    `kind` is topic, column, or either where only a name was given. `measures` is the unit of SI of what the written
    unit measures, rad or m; empty for counts and where none is written. `files` are the parts of a table, in order, in
    which the column stands; none for the recording itself. `origin` says where all of it was written. Where it is not
    `scaled`, neither unit nor scale is written, and the unit that a table states counts.
    """

    kind: str
    name: str
    path: FieldPath | None = None
    unit: float = 1.0
    scale: float = 1.0
    offset: float = 0.0
    sign: int = 1
    files: tuple[str, ...] = ()
    origin: str = "--topic"
    measures: str = ""
    scaled: bool = False

    def values(self, raw: NDArray[np.float64]) -> NDArray[np.float64]:
        """The values [SI] of `raw` numbers."""
        gain = self.sign * self.unit * self.scale
        return raw if gain == 1.0 and self.offset == 0.0 else gain * raw + self.offset


@dataclass(frozen=True)
class TimeSource:
    """What the times of the samples are: a field of messages, or a column, or two of them as [s] and [ns].

    `unit` [s] is that of a number, where it is not `scaled` the one that a table states; a stamp has its own.
    """

    topic: str = ""
    path: FieldPath | None = None
    columns: tuple[str, ...] = ()
    unit: float = 1.0
    origin: str = "--topic"
    scaled: bool = False


@dataclass(frozen=True)
class SignalMap:
    """The sources that a person chose; signals without one are found by their own names.

    `left_out` are signals that are not to be read, whatever stands under their names.
    """

    sources: Mapping[str, Source] = field(default_factory=dict)
    time: TimeSource | None = None
    left_out: frozenset[str] = frozenset()

    def wants(self, name: str) -> bool:
        """Whether a topic or a column of this whole name was chosen."""
        times = (self.time.topic, *self.time.columns) if self.time else ()
        return name in times or any(source.name == name for source in self.sources.values())

    @property
    def files(self) -> bool:
        """Whether any signal stands in a file of its own."""
        return any(source.files for source in self.sources.values())

    @property
    def columns(self) -> dict[str, str]:
        """The column of each signal."""
        standard = {signal: each.column for signal, each in SIGNALS.items() if signal not in self.left_out}
        return {**standard, **{signal: source.name for signal, source in self.sources.items()}}
