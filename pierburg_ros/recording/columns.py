"""Columns of numbers, one row a sample; an empty cell leaves a signal as it was."""

from __future__ import annotations

from array import array
from dataclasses import dataclass

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.errors import InputError

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

    def values(self, column: str) -> Signal:
        """The numbers of one column; InputError where several have its name, or where it holds anything else."""
        if self.header.count(column) > 1:
            raise InputError(f"{self.name} has several columns {column}, expected one. Rename the others.")
        if column in self.wrong:
            row, cell = self.wrong[column]
            raise InputError(f"{self.name} has {cell!r} as {column} in row {row}, expected a finite number. Repair it.")
        return np.frombuffer(self.cells[column], np.float64)

    @property
    def count(self) -> int:
        """How many numbers it holds."""
        return sum(len(values) for values in self.cells.values())

    def listed(self) -> str:
        """Every column, for a message to a person."""
        return ", ".join(self.header)
