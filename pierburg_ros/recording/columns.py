"""A recording made of columns of numbers, one row a sample; an empty cell leaves a signal as it was."""

from __future__ import annotations

from array import array
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from pierburg_ros.errors import InputError, printable
from pierburg_ros.recording.loss import Loss, pauses, silences
from pierburg_ros.recording.recording import Channel, Recording, Samples, check_signal

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


@dataclass(frozen=True)
class Columns:
    """A table: the names of all columns, the numbers of those wanted, not a number where a cell is empty.

    `wrong` has the row and the text of the first cell of a column that is no finite number.
    """

    name: str
    header: tuple[str, ...]
    cells: dict[str, array[float]]
    wrong: dict[str, tuple[int, str]]

    def values(self, column: str) -> Samples:
        """The numbers of one column."""
        if column in self.wrong:
            row, cell = self.wrong[column]
            raise InputError(f"{self.name} has {cell!r} as {column} in row {row}, expected a finite number. Repair it.")
        return np.frombuffer(self.cells[column], np.float64)

    def listed(self) -> str:
        """Every column, for a message to a person."""
        return ", ".join(self.header)


def tabulated(table: Columns, choice: str | None, named: Mapping[str, str]) -> Recording:
    """The recording in a table; `named` maps signals to columns, `choice` is a clock, which a table has not."""
    if choice is not None:
        raise InputError(f"{table.name} has one clock, its time column; expected no --time. Leave it out.")
    columns = {**COLUMNS, **named}
    absent = sorted(column for column in named.values() if column not in table.cells)
    if absent:
        raise InputError(f"{table.name} has no column {absent[0]} (found: {table.listed()}). Name one of those.")
    quantity = "hall_voltage" if columns["hall_voltage"] in table.cells else "position"
    duty = "applied_duty" if columns["applied_duty"] in table.cells and "duty" not in named else "duty"
    for signal in ("time", duty, quantity):
        if columns[signal] not in table.cells:
            raise InputError(
                f"{table.name} has no {signal} column (found: {table.listed()}), {FORM}."
                f" Name it with --topic {signal}=COLUMN."
            )
    time = table.values(columns["time"])
    if np.any(np.isnan(time)):
        raise InputError(f"{table.name} has an empty time in row {np.flatnonzero(np.isnan(time))[0] + 2}. Fill it in.")
    measured = channel(table, time, columns[quantity])
    origin = float(measured.time[0])
    acting = {
        signal: shifted(channel(table, time, columns[signal]), origin)
        for signal in ("supply_voltage", "setpoints", "temperature", "enabled")
        if columns[signal] in table.cells and not np.all(np.isnan(table.values(columns[signal])))
    }
    inputs = shifted(channel(table, time, columns[duty]), origin)
    breaks = pauses(measured.time - origin)
    losses = (
        Loss(quantity, None, measured.time.size, breaks),
        Loss("duty", None, inputs.time.size, silences(inputs.time, inputs.values, breaks)),
    )
    return Recording(
        table.name,
        quantity,
        measured.time - origin,
        measured.values,
        inputs,
        time_source="column",
        losses=tuple(loss for loss in losses if loss.spans),
        **acting,
    )


def channel(table: Columns, time: Samples, column: str) -> Channel:
    """The filled cells of one column with their times [s]."""
    values = table.values(column)
    filled = ~np.isnan(values)
    check_signal(f"{table.name}: {printable(column)}", time[filled], values[filled])
    return Channel(time[filled], values[filled])


def shifted(signal: Channel, origin: float) -> Channel:
    """`signal` with its time counted from `origin` [s]."""
    return Channel(signal.time - origin, signal.values)
