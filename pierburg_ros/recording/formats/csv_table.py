"""Reads CSV tables with a header as columns of numbers."""

from __future__ import annotations

from array import array
from collections.abc import Iterator
from io import TextIOWrapper
from pathlib import Path

from pierburg_ros.errors import InputError, printable
from pierburg_ros.intake import lines, opened, rows
from pierburg_ros.recording.columns import FORM, Columns
from pierburg_ros.recording.formats.format import Format
from pierburg_ros.recording.formats.messages import Wanted

MOST_CELLS = 1 << 25
"""Cells kept at most, 256 MiB: six hours of three columns at 500 Hz. The recording made of them takes five times it."""
TRUTH = {"true": 1.0, "false": 0.0}
NOTHING = float("nan")
"""Stands for an empty cell, which leaves a signal as it was."""


def read_table(path: Path, wanted: Wanted) -> Columns:
    """The columns `wanted` of the CSV file at `path`."""
    with opened(path, "a CSV file") as binary:
        file = TextIOWrapper(binary, encoding="utf-8-sig", errors="replace", newline="")
        start = next(lines(file, path.name), "")
        delimiter = next((mark for mark in "\t;" if mark in start), ",")
        file.seek(0)
        table = rows(file, path.name, delimiter)
        name = printable(path.name)
        return filled(name, header_of(name, table, delimiter), table, wanted)


def header_of(name: str, table: Iterator[tuple[int, list[str]]], delimiter: str) -> list[str]:
    """The names of the columns."""
    _, first = next(table, (0, []))
    if not first:
        raise InputError(f"{name} is empty, expected a header and rows. Record again.")
    header = [cell.strip() for cell in first]
    header[0] = header[0].removeprefix("#").lstrip()  # as NumPy writes it
    if any(is_number(cell) for cell in header):
        raise InputError(
            f"{name} has no header (its first row is {delimiter.join(first)[:60]}), {FORM}."
            " Add a first row with the names of the columns."
        )
    return header


def filled(name: str, header: list[str], table: Iterator[tuple[int, list[str]]], wanted: Wanted) -> Columns:
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
    """Whether `cell` reads as a number."""
    try:
        float(cell)
    except ValueError:
        return False
    return True


FORMAT = Format("a .csv table", lambda path, _: path.suffix.lower() == ".csv", read_table)
