"""Reads a recording from a CSV table with a header; an empty cell leaves a signal as it was."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.errors import InputError
from pierburg_ros.recording.recording import Channel, Recording, check_signal
from pierburg_ros.recording.roles import check_names

COLUMNS = {
    "time": "time",
    "duty": "duty",
    "applied_duty": "applied_duty",
    "hall_voltage": "hall_voltage",
    "position": "position",
    "supply_voltage": "supply_voltage",
    "setpoints": "setpoint",
    "temperature": "temperature",
    "enabled": "enabled",
}
"""Column of each signal unless a person names another."""
FORM = "expected time, duty, and hall_voltage or position"


def read_csv(path: Path, choice: str | None, named: Mapping[str, str]) -> Recording:
    """The recording in the CSV file at `path`; `named` maps signals to columns."""
    if choice is not None:
        raise InputError(f"{path.name} has one clock, its time column; expected no --time. Leave it out.")
    check_names(named, COLUMNS)
    columns = {**COLUMNS, **named}
    table = read_table(path)
    absent = sorted(column for column in named.values() if column not in table)
    if absent:
        raise InputError(f"{path.name} has no column {absent[0]} (found: {', '.join(table)}). Name one of those.")
    quantity = "hall_voltage" if columns["hall_voltage"] in table else "position"
    duty = "applied_duty" if columns["applied_duty"] in table and "duty" not in named else "duty"
    for signal in ("time", duty, quantity):
        if columns[signal] not in table:
            raise InputError(
                f"{path.name} has no {signal} column (found: {', '.join(table)}), {FORM}."
                f" Name it with --topic {signal}=COLUMN."
            )
    time = numbers(path, columns["time"], table[columns["time"]])
    if np.any(np.isnan(time)):
        raise InputError(f"{path.name} has an empty time in row {np.flatnonzero(np.isnan(time))[0] + 2}. Fill it in.")
    measured = channel(path, time, columns[quantity], table)
    origin = float(measured.time[0])
    acting = {
        signal: shifted(channel(path, time, columns[signal], table), origin)
        for signal in ("supply_voltage", "setpoints", "temperature", "enabled")
        if any(table.get(columns[signal], ()))
    }
    inputs = shifted(channel(path, time, columns[duty], table), origin)
    return Recording(
        path.name, quantity, measured.time - origin, measured.values, inputs, time_source="column", **acting
    )


def read_table(path: Path) -> dict[str, list[str]]:
    """The cells of each column, by the names in the header."""
    with path.open(newline="", encoding="utf-8-sig", errors="replace") as file:
        start = file.readline()
        delimiter = next((mark for mark in "\t;" if mark in start), ",")
        file.seek(0)
        rows = [row for row in csv.reader(file, delimiter=delimiter) if row]
    if not rows:
        raise InputError(f"{path.name} is empty, expected a header and rows. Record again.")
    header = [cell.strip() for cell in rows[0]]
    if any(is_number(cell) for cell in header):
        raise InputError(
            f"{path.name} has no header (its first row is {delimiter.join(rows[0])[:60]}), {FORM}."
            " Add a first row with the names of the columns."
        )
    if len(rows) < 2:
        raise InputError(f"{path.name} holds no samples, only a header. Record again.")
    ragged = next((place for place, row in enumerate(rows, 1) if len(row) != len(header)), None)
    if ragged:
        raise InputError(
            f"{path.name} has {len(rows[ragged - 1])} cells in row {ragged}, expected {len(header)} as in its"
            " header. Repair that row."
        )
    return {name: [row[place].strip() for row in rows[1:]] for place, name in enumerate(header)}


def is_number(cell: str) -> bool:
    """Whether `cell` reads as a number."""
    try:
        float(cell)
    except ValueError:
        return False
    return True


def numbers(path: Path, column: str, cells: list[str]) -> Signal:
    """The cells of one column as numbers, NaN where empty."""
    try:
        return np.array([float(cell) if cell else np.nan for cell in cells])
    except ValueError as error:
        row = next(place for place, cell in enumerate(cells, 2) if cell and not is_number(cell))
        raise InputError(
            f"{path.name} has {cells[row - 2]!r} as {column} in row {row}, expected a number. Repair it."
        ) from error


def channel(path: Path, time: Signal, column: str, table: Mapping[str, list[str]]) -> Channel:
    """The filled cells of one column with their times [s]."""
    values = numbers(path, column, table[column])
    filled = np.array([cell != "" for cell in table[column]])
    check_signal(f"{path.name}: {column}", time[filled], values[filled])
    return Channel(time[filled], values[filled])


def shifted(signal: Channel, origin: float) -> Channel:
    """`signal` with its time counted from `origin` [s]."""
    return Channel(signal.time - origin, signal.values)
