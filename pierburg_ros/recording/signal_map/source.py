"""Where a signal comes from, and how the numbers there become its values in SI."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from pierburg_ros.recording.signal_map.field_path import FieldPath
from pierburg_ros.recording.signals import SIGNALS

PLAIN = re.compile(r"[\w/.-]+")


@dataclass(frozen=True)
class Source:
    """A topic or a column: value = sign * unit * scale * raw + offset, in SI.

    `kind` is topic, column, or either where only a name was given. `measures` is the unit of SI of what the written
    unit measures, rad or m; empty for counts and where none is written. `files` are the parts of a table, in order, in
    which the column stands; none for the recording itself. `origin` says where all of it was written. Where it is not
    `scaled`, neither unit nor scale is written, and the unit that a table states counts; `written` is either unit.
    What is `exact` is what it is read as: nobody looks for a fault of it.
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
    written: str = ""
    exact: bool = False

    def values(self, raw: NDArray[np.float64]) -> NDArray[np.float64]:
        """The values [SI] of `raw` numbers."""
        gain = self.sign * self.unit * self.scale
        return raw if gain == 1.0 and self.offset == 0.0 else gain * raw + self.offset

    def mended(self, scale: float, offset: float, unit: str = "") -> Source:
        """The source of scale * value + offset; where nothing else is written, `unit` says that scale."""
        named, size = bool(unit) and self.unit * self.scale == 1.0, abs(scale)
        return replace(
            self,
            unit=size if named else self.unit,
            scale=self.scale if named else self.scale * size,
            offset=scale * self.offset + offset,
            sign=self.sign if scale > 0.0 else -self.sign,
            scaled=self.scaled or size != 1.0,
            written=unit if named else self.written,
        )

    def line(self, signal: str) -> str:
        """The line of a signal map that says all of this."""
        return f"{signal}: {{{', '.join(self._entries())}}}"

    def _entries(self) -> Iterator[str]:
        if self.name:
            yield f"{self.kind}: {quoted(self.name)}"
        if self.path is not None:
            yield f"field: {quoted(self.path.written)}"
        if self.files:
            yield f"file: [{', '.join(map(quoted, self.files))}]"
        if self.scaled and self.written:
            yield f"unit: {self.written}"
        for key, value, usual in (("scale", self.scale, 1.0), ("sign", self.sign, 1), ("offset", self.offset, 0.0)):
            if value != usual:
                yield f"{key}: {value:.6g}"
        if self.exact:
            yield "exact: true"


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

    def line(self, unit: str) -> str:
        """The line of a signal map that says this, in another `unit`."""
        place = [f"topic: {quoted(self.topic)}"] if self.topic else []
        place += [f"field: {quoted(self.path.written)}"] if self.path else []
        place += [f"column: {quoted(each)}" for each in self.columns[:1]]
        return f"time: {{{', '.join([*place, f'unit: {unit}'])}}}"


def quoted(name: str) -> str:
    """A name as YAML takes it between braces."""
    return name if PLAIN.fullmatch(name) else f'"{name}"'


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
