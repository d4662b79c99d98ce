"""A recording made of tables: one file, its parts one after another, or a file for some signals, all on one clock."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.errors import InputError, near, printable
from pierburg_ros.recording.columns import FORM, Columns
from pierburg_ros.recording.file_times import FileTimes
from pierburg_ros.recording.formats import format_of
from pierburg_ros.recording.formats.csv_table import MOST_CELLS
from pierburg_ros.recording.loss import Loss, pauses, silences
from pierburg_ros.recording.recording import Channel, Recording, check_signal
from pierburg_ros.recording.signal_map import SignalMap, Source, TimeSource
from pierburg_ros.recording.signals import DRIVING, MEASURED, OPTIONAL, SIGNALS, TIME, in_order
from pierburg_ros.recording.topics import nothing
from pierburg_ros.recording.units import COUNTS, unit_of


@dataclass(frozen=True)
class Tables:
    """The table of a recording, if it has one of its own, and those of the files that a signal map names.

    `parts` has the tables of each tuple of files, which follow one another.
    """

    own: Columns | None
    parts: dict[tuple[str, ...], tuple[Columns, ...]] = field(default_factory=dict)

    def of(self, files: tuple[str, ...]) -> tuple[Columns, ...]:
        """The parts in which a signal from these files stands; none of them: the recording's own table."""
        return self.parts[files] if files else (self.own,) if self.own is not None else ()

    @property
    def name(self) -> str:
        """What messages call all of it."""
        return self.own.name if self.own is not None else " and ".join(files[0] for files in self.parts)


def read_tables(path: Path, chosen: SignalMap) -> Tables:
    """The table at `path`, or only the folder of that name, and the files in it that `chosen` names."""
    folder = path if path.is_dir() else path.parent
    own = None if path.is_dir() else columns_of(path, chosen)
    named = dict.fromkeys(source.files for source in chosen.sources.values() if source.files)
    read: dict[str, Columns] = {}
    for name in dict.fromkeys(name for files in named for name in files):
        read[name] = columns_of(folder / name, chosen)
        check_cells(path.name, [own, *read.values()])
    return Tables(own, {files: tuple(read[name] for name in files) for files in named})


def check_cells(name: str, tables: Iterable[Columns | None]) -> None:
    """Refuse tables that together hold more than one may."""
    if sum(table.count for table in tables if table is not None) > MOST_CELLS:
        raise InputError(f"{name} has more than {MOST_CELLS:,} numbers in its files, expected fewer. Give fewer parts.")


def columns_of(path: Path, chosen: SignalMap) -> Columns:
    """The columns of one file that `chosen` may want."""
    standard = {*chosen.columns.values(), TIME}
    found = format_of(path).read(path, lambda name: name in standard or chosen.wants(name))
    if not isinstance(found, Columns):
        raise InputError(f"{path.name} is no table, expected a CSV beside others. Leave file: out of the signal map.")
    return found


def tabulated(tables: Tables, choice: str | None, chosen: SignalMap, preferred: Collection[str] = ()) -> Recording:
    """The recording in `tables`; `choice` is a clock, which a table has not.

    `preferred` are the input and the quantity to take where there are several.
    """
    if choice is not None:
        raise InputError(f"{tables.name} has one clock, its time column; expected no --time. Leave it out.")
    reader = TableReader(tables, chosen)
    driving, measuring = reader.first_of(DRIVING, preferred), reader.first_of(MEASURED, preferred)
    driven, quantity = DRIVING[driving], MEASURED[measuring]
    measured = reader.channel(measuring)
    origin = float(measured.time[0])
    measured, inputs = shifted(measured, origin), shifted(reader.channel(driving), origin)
    acting = {signal: shifted(reader.channel(signal), origin) for signal in OPTIONAL if reader.is_filled(signal)}
    breaks = pauses(measured.time)
    losses = (
        Loss(quantity, None, measured.time.size, breaks),
        Loss(driven, None, inputs.time.size, silences(inputs.time, inputs.values, breaks)),
    )
    return Recording(
        tables.name,
        quantity,
        measured.time,
        measured.values,
        inputs,
        time_source="column",
        losses=tuple(loss for loss in losses if loss.spans),
        input=driven,
        path=None,
        read_with=(),
        file_times=FileTimes.of_column(measured.time, reader.first + origin),
        sources={signal: reader.whence(signal) for signal in (driving, measuring, *acting)},
        clock=reader.clock,
        exact=frozenset(),
        **acting,
    )


class TableReader:
    """Reads signals from the columns that a map chose, or that are called like them."""

    def __init__(self, tables: Tables, chosen: SignalMap) -> None:
        self.tables = tables
        self.chosen = chosen
        self.columns = chosen.columns
        self.clock = chosen.time or TimeSource(columns=(TIME,))
        self.base: tuple[float, float, int] | None = None
        """The first time that was read, its unit [s], and from where it counts [ns since 1970]."""
        if self.clock.topic:
            raise topic_of_table(self.clock.origin, tables.name, "time: {column: NAME, unit: s}")
        for signal, source in chosen.sources.items():
            if source.kind == "topic":
                raise topic_of_table(source.origin, tables.name, "column: in place of topic:")
            for part in self.parts(signal):
                self.check_column(part, source.name, source.origin)

    def parts(self, signal: str) -> tuple[Columns, ...]:
        """The tables in which the signal stands, one after another."""
        source = self.chosen.sources.get(signal)
        parts = self.tables.of(source.files if source else ())
        if source and not parts:
            raise InputError(
                f"{source.origin} names no file, and a folder is given, expected file: NAME of a CSV in it."
            )
        return parts

    def has(self, signal: str) -> bool:
        """Whether there is a column for the signal."""
        parts = self.parts(signal)
        return bool(parts) and all(self.columns.get(signal) in part.cells for part in parts)

    def is_filled(self, signal: str) -> bool:
        """Whether the column of the signal has any value; one that a person chose must."""
        filled = self.has(signal) and not all(np.all(np.isnan(self.raw(part, signal))) for part in self.parts(signal))
        source = self.chosen.sources.get(signal)
        if source is not None and not filled:
            raise nothing(source, signal, f"{self.tables.name} has nothing in the column {source.name}")
        return filled

    def raw(self, part: Columns, signal: str) -> Signal:
        """The numbers in the column of the signal."""
        return part.values(self.columns[signal])

    def first_of(self, signals: Mapping[str, str], preferred: Collection[str]) -> str:
        """The first of `signals` that there is a column for; only those that a person chose where there are such."""
        for part in self.tables.of(()):
            self.check_clock(part)
        order = in_order(signals, self.chosen.sources, preferred)
        for signal in order:
            if self.has(signal):
                return signal
        every = (self.tables.own, *(part for parts in self.tables.parts.values() for part in parts))
        found, usual = ", ".join(part.listed() for part in every if part is not None), signals[order[0]]
        raise InputError(
            f"{self.tables.name} has no {usual} column (found: {found}), {FORM}. Name it with --topic {usual}=COLUMN."
        )

    def channel(self, signal: str) -> Channel:
        """The filled cells of a signal with their times [s] since the first time that was read."""
        parts = self.parts(signal)
        time = np.concatenate([self.time(part) for part in parts])
        every = np.concatenate([self.source(part, signal).values(self.raw(part, signal)) for part in parts])
        filled = ~np.isnan(every)
        values = every[filled]
        name = " and ".join(part.name for part in parts)
        check_signal(f"{name}: {printable(self.columns[signal])}", time[filled], values)
        return Channel(time[filled], values)

    def source(self, part: Columns, signal: str) -> Source:
        """What a person says of the signal; its unit is the one that the table states where they give none."""
        column = self.columns[signal]
        source = self.chosen.sources.get(signal) or Source("column", column)
        if source.scaled or not (stated := part.unit(column)):
            return source
        if stated == COUNTS:
            raise InputError(
                f"{part.name} has {column} in counts, expected how much one is. Write it into a signal map, as"
                f" {signal}: {{column: {column}, unit: counts, scale: 0.001}}."
            )
        return replace(source, unit=factor_of(part, column, stated, SIGNALS[signal].units), written=stated)

    def whence(self, signal: str) -> Source:
        """Where the signal was read from, in its first part."""
        return replace(self.source(self.parts(signal)[0], signal), kind="column")

    def time(self, part: Columns) -> Signal:
        """The times [s] of the rows, since the first time that was read."""
        self.check_clock(part)
        column, *nanoseconds = self.clock.columns
        raw, unit = part.times(column), self.unit_of_time(part, column, bool(nanoseconds))
        if self.base is None:
            self.base = float(raw[0]), unit, part.origins.get(column, 0)
        first, unit_of_first, origin = self.base
        whole: Signal = (raw - first) * unit + first * (unit - unit_of_first)
        whole += (part.origins.get(column, 0) - origin) * 1e-9
        return whole + part.times(nanoseconds[0]) * 1e-9 if nanoseconds else whole

    def unit_of_time(self, part: Columns, column: str, is_pair: bool) -> float:
        """Seconds in one of the numbers in the `column`; stamps have seconds, and so has the first of a pair."""
        if column in part.origins and (self.clock.scaled or is_pair):
            found = "a unit" if self.clock.scaled else "a second column"
            raise InputError(f"{self.clock.origin} has {found}, {part.name} has stamps in {column}. Leave it out.")
        if self.clock.scaled or is_pair or column in part.origins or not (stated := part.unit(column)):
            return self.clock.unit
        return factor_of(part, column, stated, ("s",))

    @property
    def first(self) -> float:
        """The first time that was read [s], on the clock of the tables."""
        first, unit, origin = self.base or (0.0, 1.0, 0)
        return first * unit + origin * 1e-9

    def check_clock(self, part: Columns) -> None:
        """Refuse a table without the column of its times."""
        if self.clock.columns == (TIME,) and TIME not in part.cells:
            raise InputError(
                f"{part.name} has no time column (found: {part.listed()}), {FORM}. Name it with --topic time=COLUMN."
            )
        for column in self.clock.columns:
            self.check_column(part, column, self.clock.origin)

    @staticmethod
    def check_column(part: Columns, column: str, origin: str) -> None:
        """Refuse a column that a person chose and that is not there."""
        place = "" if origin == "--topic" else f"{origin}: "
        if column not in part.cells:
            raise InputError(
                f"{place}{part.name} has no column {column} (found: {part.listed()}).{near(column, part.header)}"
                " Name one of those."
            )


def topic_of_table(origin: str, name: str, write: str) -> InputError:
    """What to say of a map for topics."""
    return InputError(f"{origin} names a topic, {name} has columns. Write {write}.")


def factor_of(part: Columns, column: str, stated: str, wanted: tuple[str, ...]) -> float:
    """What one of the unit that a table states is in SI; InputError where it is none of those `wanted`."""
    unit = unit_of(stated)
    if not any(unit.measures(each) for each in wanted) or stated == COUNTS:
        raise InputError(
            f"{part.name} has {column} in {stated}, expected a unit of {' or '.join(wanted)}. Correct its head, or give"
            " the unit in a signal map."
        )
    return unit.factor


def shifted(signal: Channel, origin: float) -> Channel:
    """`signal` with its time counted from `origin` [s]."""
    return Channel(signal.time - origin, signal.values)
