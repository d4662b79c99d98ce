"""Reads CSV tables with a header as columns of numbers or stamps."""

from __future__ import annotations

from array import array
from collections.abc import Iterator
from io import TextIOWrapper
from itertools import chain
from pathlib import Path

from pierburg_ros.errors import InputError, printable
from pierburg_ros.intake import lines, opened, rows
from pierburg_ros.recording.columns import FORM, Columns
from pierburg_ros.recording.formats.format import Format
from pierburg_ros.recording.formats.headings import TRUTH, Heading, is_number, is_units
from pierburg_ros.recording.formats.messages import Wanted
from pierburg_ros.recording.formats.stamps import NANOSECONDS, has_zone, is_stamp, nanoseconds

MOST_CELLS = 1 << 25
"""Cells kept at most, 256 MiB: six hours of three columns at 500 Hz. The recording made of them takes five times it."""
Table = Iterator[tuple[int, list[str]]]
"""Number of the line and cells of each row."""
NOTHING = float("nan")
"""Stands for an empty cell, which leaves a signal as it was."""


def read_table(path: Path, wanted: Wanted) -> Columns:
    """The columns `wanted` of the CSV file at `path`."""
    with opened(path, "a CSV file") as binary:
        file = TextIOWrapper(binary, encoding="utf-8-sig", errors="replace", newline="")
        start = next((line for line in lines(file, path.name) if not is_note(line)), "")
        delimiter = next((mark for mark in "\t;" if mark in start), ",")
        file.seek(0)
        name = printable(path.name)
        return filled(name, *parted(name, rows(file, path.name, delimiter), delimiter), wanted)


def parted(name: str, table: Table, delimiter: str) -> tuple[list[Heading], Table]:
    """The heads of the columns and the rows below: notes in front are passed over, but for a header that is one."""
    note: list[str] = []
    for line, row in table:
        if is_note(row[0]):
            note = row
            continue
        if not any(is_number(cell) or is_stamp(cell.strip()) for cell in row):
            if note and is_units(row):
                return with_units(names_of(note), chain([(line, row)], table))
            return with_units(names_of(row), table)
        if note:  # as NumPy writes it
            return names_of(note), chain([(line, row)], table)
        raise InputError(
            f"{name} has no header (its first row is {delimiter.join(row)[:60]}), {FORM}."
            " Add a first row with the names of the columns."
        )
    raise InputError(f"{name} is empty, expected a header and rows. Record again.")


def names_of(row: list[str]) -> list[Heading]:
    """The heads of the columns in a header, perhaps one behind a mark for people."""
    return [Heading.of(row[0].lstrip().removeprefix("#")), *map(Heading.of, row[1:])]


def with_units(headings: list[Heading], table: Table) -> tuple[list[Heading], Table]:
    """The same with the units of the row below, where that is one of units, and the rows that are left."""
    line, row = next(table, (0, []))
    if len(row) != len(headings) or not is_units(row):
        return headings, chain([(line, row)] if row else [], table)
    return [heading.below(line, cell) for heading, cell in zip(headings, row, strict=True)], table


def is_note(text: str) -> bool:
    """Whether a line, or the first cell of a row, is there for people."""
    return text.lstrip().startswith("#")


def filled(name: str, headings: list[Heading], table: Table, wanted: Wanted) -> Columns:
    """The wanted columns, filled from the rows that are left; by their name as written, or without its unit."""
    called = {place: key for place, each in enumerate(headings) if (key := key_of(each, wanted))}
    header = tuple(called.get(place, each.written) for place, each in enumerate(headings))
    columns = Columns(name, header, {column: array("d") for column in called.values()})
    for place, column in called.items():
        if headings[place].unit:
            columns.units[column] = headings[place].unit
        if (unclear := headings[place].unclear) is not None:
            columns.unclear[column] = unclear
    kept = {column: place for place, column in called.items()}
    reader, cells = CellReader(columns), 0
    for line, row in table:
        if len(row) != len(header):
            raise InputError(
                f"{name} has {len(row)} cells in row {line}, expected {len(header)} as in its header. Repair that row."
            )
        cells += max(len(kept), 1)
        if cells > MOST_CELLS:
            raise InputError(f"{name} has more than {MOST_CELLS:,} numbers, expected fewer. Cut it into parts.")
        for column, place in kept.items():
            columns.cells[column].append(reader.value(column, line, row[place].strip()))
    if not cells:
        raise InputError(f"{name} holds no samples, only a header. Record again.")
    reader.check_marks()
    return columns


def key_of(heading: Heading, wanted: Wanted) -> str:
    """The name by which a column is wanted, empty where it is not."""
    return next((name for name in (heading.written, heading.bare) if wanted(name)), "")


class CellReader:
    """Reads cells as numbers or stamps; the first of a column that is neither is noted in its `columns`."""

    def __init__(self, columns: Columns) -> None:
        self.columns = columns
        self.marks: dict[str, tuple[int, str]] = {}
        """Row and text of the first number with each decimal mark."""
        self.zoned: dict[str, bool] = {}
        """Whether the stamps of a column say in which zone they count."""

    def value(self, column: str, line: int, cell: str) -> float:
        """A cell as a number, or as a stamp [s] since the origin of its column."""
        if not cell:
            self.columns.empty.setdefault(column, line)
            return NOTHING
        if column in self.zoned:
            return self.stamp(column, line, cell)
        value = self.number(line, cell)
        if value != value and is_stamp(cell) and self.has_nothing(column):
            return self.stamp(column, line, cell)
        if value != value or abs(value) == float("inf"):
            self.columns.wrong.setdefault(column, (line, cell[:60]))
        return value

    def has_nothing(self, column: str) -> bool:
        """Whether all cells of the column have been empty so far."""
        return all(value != value for value in self.columns.cells[column])

    def number(self, line: int, cell: str) -> float:
        """A cell as a number, NOTHING where it is none; the first with each decimal mark is noted."""
        try:
            value = float(cell)
            if "." in cell:
                self.marks.setdefault(".", (line, cell[:60]))
        except ValueError:
            value = decimal_comma(cell)
            if "," in cell and value == value:
                self.marks.setdefault(",", (line, cell[:60]))
        return value

    def stamp(self, column: str, line: int, cell: str) -> float:
        """A stamp [s] since the origin of its column, which is the first one; NOTHING where it is none."""
        stamp = nanoseconds(cell)
        if stamp is None or self.zoned.setdefault(column, has_zone(cell)) != has_zone(cell):
            self.columns.wrong.setdefault(column, (line, cell[:60]))
            return NOTHING
        return (stamp - self.columns.origins.setdefault(column, stamp)) / NANOSECONDS

    def check_marks(self) -> None:
        """Refuse numbers of which some have a point before their decimals, and some a comma."""
        if len(self.marks) > 1:
            (first, point), (other, comma) = self.marks["."], self.marks[","]
            raise InputError(
                f"{self.columns.name} has {point!r} in row {first} and {comma!r} in row {other}, expected one mark"
                " before the decimals. Write all numbers with a point, and none with a mark between thousands."
            )


def decimal_comma(cell: str) -> float:
    """A cell with a comma before its decimals, or a truth value; NOTHING where it is neither."""
    if cell.lower() in TRUTH:
        return TRUTH[cell.lower()]
    if cell.count(",") != 1 or "." in cell:
        return NOTHING
    try:
        return float(cell.replace(",", "."))
    except ValueError:
        return NOTHING


FORMAT = Format("a .csv table", lambda path, _: path.suffix.lower() == ".csv", read_table)
