"""Columns of numbers or stamps, one row a sample; an empty cell leaves a signal as it was."""

from __future__ import annotations

from array import array
from dataclasses import dataclass, field

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.errors import InputError

FORM = "expected time, duty, and hall_voltage or position"


@dataclass(frozen=True)
class Columns:
    """A table: the names of all columns, the numbers of those wanted, not a number where a cell is empty.

    A column of stamps has its numbers [s] since its `origins` entry [ns since 1970]. `units` are those that the table
    states, as a signal map writes them. `wrong` has the row and the text of the first cell of a column that is neither
    finite number nor stamp, `unclear` of one that states no known unit, and `empty` the first row without a value.
    """

    name: str
    header: tuple[str, ...]
    cells: dict[str, array[float]]
    units: dict[str, str] = field(default_factory=dict)
    unclear: dict[str, tuple[int, str]] = field(default_factory=dict)
    wrong: dict[str, tuple[int, str]] = field(default_factory=dict)
    empty: dict[str, int] = field(default_factory=dict)
    origins: dict[str, int] = field(default_factory=dict)

    def values(self, column: str) -> Signal:
        """The numbers of one column; InputError where several have its name, or where it holds anything else."""
        if column in self.origins:
            raise InputError(
                f"{self.name} has stamps in the column {column}, expected numbers: only the time has stamps."
                " Name another column."
            )
        return self._read(column, "a finite number")

    def times(self, column: str) -> Signal:
        """The numbers or stamps of one column, all of them there; stamps [s] since its origin."""
        if column in self.empty:
            raise InputError(f"{self.name} has an empty {column} in row {self.empty[column]}. Fill it in.")
        if column not in self.origins:
            return self._read(column, "a finite number, or a stamp as 2026-03-01T12:00:00.5Z in every row")
        return self._read(column, "a stamp as 2026-03-01T12:00:00.5Z, with a zone in every row or in none")

    def unit(self, column: str) -> str:
        """The unit that the table states of a column, empty where none; InputError where that is none, or two."""
        if column in self.unclear:
            row, cell = self.unclear[column]
            stated = f"after {self.units[column]!r} in the header" if column in self.units else "no known unit"
            raise InputError(
                f"{self.name} has {cell!r} as the unit of {column} in row {row}, {stated}, expected one such as V, rad"
                " or ms, or an empty cell. Repair it, or give the unit in a signal map."
            )
        return self.units.get(column, "")

    @property
    def count(self) -> int:
        """How many numbers it holds."""
        return sum(len(values) for values in self.cells.values())

    def listed(self) -> str:
        """Every column, for a message to a person."""
        return ", ".join(self.header)

    def _read(self, column: str, expected: str) -> Signal:
        if self.header.count(column) > 1:
            raise InputError(f"{self.name} has several columns {column}, expected one. Rename the others.")
        if column in self.wrong:
            row, cell = self.wrong[column]
            raise InputError(f"{self.name} has {cell!r} as {column} in row {row}, expected {expected}. Repair it.")
        return np.frombuffer(self.cells[column], np.float64)
