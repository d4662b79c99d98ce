"""Reads CSV tables with a header as columns of numbers."""

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
from pierburg_ros.recording.formats.messages import Wanted

MOST_CELLS = 1 << 25
"""Cells kept at most, 256 MiB: six hours of three columns at 500 Hz. The recording made of them takes five times it."""
Table = Iterator[tuple[int, list[str]]]
"""Number of the line and cells of each row."""
TRUTH = {"true": 1.0, "false": 0.0}
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


def parted(name: str, table: Table, delimiter: str) -> tuple[list[str], Table]:
    """The names of the columns and the rows below: notes in front are passed over, but for a header that is one."""
    note: list[str] = []
    for line, row in table:
        if is_note(row[0]):
            note = row
            continue
        if not any(is_number(cell) for cell in row):
            return names_of(row), table
        if note:  # as NumPy writes it
            return names_of([note[0].lstrip().removeprefix("#"), *note[1:]]), chain([(line, row)], table)
        raise InputError(
            f"{name} has no header (its first row is {delimiter.join(row)[:60]}), {FORM}."
            " Add a first row with the names of the columns."
        )
    raise InputError(f"{name} is empty, expected a header and rows. Record again.")


def names_of(row: list[str]) -> list[str]:
    """The names of the columns in a header."""
    return [cell.strip() for cell in row]


def is_note(text: str) -> bool:
    """Whether a line, or the first cell of a row, is there for people."""
    return text.lstrip().startswith("#")


def filled(name: str, header: list[str], table: Table, wanted: Wanted) -> Columns:
    """The wanted columns, filled from the rows that are left."""
    kept = {column: place for place, column in enumerate(header) if wanted(column)}
    columns = Columns(name, tuple(header), {column: array("d") for column in kept}, {})
    marks: dict[str, tuple[int, str]] = {}
    cells = 0
    for line, row in table:
        if len(row) != len(header):
            raise InputError(
                f"{name} has {len(row)} cells in row {line}, expected {len(header)} as in its header. Repair that row."
            )
        cells += max(len(kept), 1)
        if cells > MOST_CELLS:
            raise InputError(f"{name} has more than {MOST_CELLS:,} numbers, expected fewer. Cut it into parts.")
        for column, place in kept.items():
            columns.cells[column].append(number(columns, marks, column, line, row[place].strip()))
    if not cells:
        raise InputError(f"{name} holds no samples, only a header. Record again.")
    if len(marks) > 1:
        (first, point), (other, comma) = marks["."], marks[","]
        raise InputError(
            f"{name} has {point!r} in row {first} and {comma!r} in row {other}, expected one mark before the decimals."
            " Write all numbers with a point, and none with a mark between thousands."
        )
    return columns


def number(columns: Columns, marks: dict[str, tuple[int, str]], column: str, line: int, cell: str) -> float:
    """A cell as a number; the first of a column that is none is noted, and the first with each decimal mark."""
    if not cell:
        return NOTHING
    try:
        value = float(cell)
        if "." in cell:
            marks.setdefault(".", (line, cell[:60]))
    except ValueError:
        value = decimal_comma(cell)
        if "," in cell and value == value:
            marks.setdefault(",", (line, cell[:60]))
    if value != value or abs(value) == float("inf"):
        columns.wrong.setdefault(column, (line, cell[:60]))
    return value


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


def is_number(cell: str) -> bool:
    """Whether `cell` reads as a number, with a point or a comma before its decimals."""
    try:
        float(cell.replace(",", "."))
    except ValueError:
        return False
    return True


FORMAT = Format("a .csv table", lambda path, _: path.suffix.lower() == ".csv", read_table)
