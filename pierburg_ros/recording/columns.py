"""A recording made of columns of numbers, one row a sample; an empty cell leaves a signal as it was."""

from __future__ import annotations

from array import array
from collections.abc import Collection, Mapping
from dataclasses import dataclass

import numpy as np

from pierburg_ros.errors import InputError, printable
from pierburg_ros.recording.loss import Loss, pauses, silences
from pierburg_ros.recording.recording import Channel, Recording, Samples, check_signal
from pierburg_ros.recording.roles import DRIVING, MEASURED, in_order

COLUMNS = {
    "time": "time",
    "duty": "duty",
    "applied_duty": "applied_duty",
    "current": "current",
    "torque": "torque",
    "hall_voltage": "hall_voltage",
    "position": "position",
    "speed": "speed",
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


def tabulated(
    table: Columns, choice: str | None, named: Mapping[str, str], preferred: Collection[str] = ()
) -> Recording:
    """The recording in a table; `named` maps signals to columns, `choice` is a clock, which a table has not.

    `preferred` are the input and the quantity to take where there are several.
    """
    if choice is not None:
        raise InputError(f"{table.name} has one clock, its time column; expected no --time. Leave it out.")
    columns = {**COLUMNS, **named}
    absent = sorted(column for column in named.values() if column not in table.cells)
    if absent:
        raise InputError(f"{table.name} has no column {absent[0]} (found: {table.listed()}). Name one of those.")
    if columns["time"] not in table.cells:
        raise missing(table, "time")
    measuring, driving = (first_of(table, columns, roles, named, preferred) for roles in (MEASURED, DRIVING))
    quantity, driven = MEASURED[measuring], DRIVING[driving]
    time = table.values(columns["time"])
    if np.any(np.isnan(time)):
        raise InputError(f"{table.name} has an empty time in row {np.flatnonzero(np.isnan(time))[0] + 2}. Fill it in.")
    measured = channel(table, time, columns[measuring])
    origin = float(measured.time[0])
    acting = {
        signal: shifted(channel(table, time, columns[signal]), origin)
        for signal in ("supply_voltage", "setpoints", "temperature", "enabled")
        if columns[signal] in table.cells and not np.all(np.isnan(table.values(columns[signal])))
    }
    inputs = shifted(channel(table, time, columns[driving]), origin)
    breaks = pauses(measured.time - origin)
    losses = (
        Loss(quantity, None, measured.time.size, breaks),
        Loss(driven, None, inputs.time.size, silences(inputs.time, inputs.values, breaks)),
    )
    return Recording(
        table.name,
        quantity,
        measured.time - origin,
        measured.values,
        inputs,
        time_source="column",
        losses=tuple(loss for loss in losses if loss.spans),
        input=driven,
        path=None,
        **acting,
    )


def first_of(
    table: Columns,
    columns: Mapping[str, str],
    roles: Mapping[str, str],
    named: Mapping[str, str],
    preferred: Collection[str],
) -> str:
    """The first of `roles` that has a column; only those that a person named where there are such."""
    order = [role for role in in_order(roles, named, preferred) if role in columns]
    for role in order[: len(named.keys() & roles.keys()) or None]:
        if columns[role] in table.cells:
            return role
    raise missing(table, roles[order[0]])


def missing(table: Columns, signal: str) -> InputError:
    """What to say where there is no column of a `signal`."""
    return InputError(
        f"{table.name} has no {signal} column (found: {table.listed()}), {FORM}. Name it with --topic {signal}=COLUMN."
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
