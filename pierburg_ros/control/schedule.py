"""Setpoint and duty files: a CSV of two columns, each value in force from its time on."""

from __future__ import annotations

from array import array
from collections.abc import Callable
from dataclasses import dataclass
from io import TextIOWrapper
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from pierburg_ros.control.setpoints import Setpoints
from pierburg_ros.errors import InputError
from pierburg_ros.intake import check_magnitude, opened, reading, rows

Accept = Callable[[float], float]
MOST_ENTRIES = 4_000_000
"""Rows at most, one a sample of the longest run that is simulated."""


@dataclass(frozen=True)
class Schedule:
    """Values by time: `time` [s] rising, and `values`, both of shape (entries,)."""

    time: NDArray[np.float64]
    values: NDArray[np.float64]

    def at(self, time: float) -> float:
        """The value in force at `time` [s]; before the first entry, the first."""
        return float(self.sampled(np.array([time]))[0])

    def sampled(self, time: NDArray[np.float64]) -> NDArray[np.float64]:
        """The values in force at the times [s], shape (samples,)."""
        entries = np.searchsorted(self.time, time, side="right") - 1
        return self.values[np.maximum(entries, 0)]


def read_setpoint_file(path: str | Path) -> Schedule:
    """Setpoints [rad] from a CSV with the header `time,setpoint`, each checked against the stops."""
    return read_schedule(path, "setpoint", Setpoints().accepted)


def read_duty_file(path: str | Path) -> Schedule:
    """Duties [1] from a CSV with the header `time,duty`, each from -1 to 1."""
    return read_schedule(path, "duty", accepted_duty)


def accepted_duty(duty: float) -> float:
    """The duty itself; InputError if it is not a number from -1 to 1."""
    if not -1.0 <= duty <= 1.0:
        raise InputError(f"Duty {duty:g} is not within -1 to 1; give a fraction of the supply voltage.")
    return duty


def read_schedule(path: str | Path, quantity: str, accept: Accept) -> Schedule:
    """The schedule in a CSV with the header `time,<quantity>`; `accept` checks or corrects each value."""
    form = f"a {quantity} file (CSV)"
    with reading(path, form), opened(path, form) as binary:
        file = TextIOWrapper(binary, encoding="utf-8-sig", newline="")
        table = rows(file, str(path))
        _, header = next(table, (0, []))
        if [name.strip() for name in header] != ["time", quantity]:
            raise InputError(f"{path} does not begin with the header time,{quantity}; add it above the first row.")
        entries = array("d")
        for line, row in table:
            entries.extend(entry(row, quantity, accept, f"{path} line {line}"))
            if len(entries) > 2 * MOST_ENTRIES:
                raise InputError(f"{path} has more than {MOST_ENTRIES:,} rows; cut it into parts.")
    if not entries:
        raise InputError(f"{path} holds no {quantity}; add rows of time [s] and {quantity}.")
    time, values = np.array(entries).reshape(-1, 2).T
    check_magnitude(f"{path}: time [s]", time)
    if np.any(np.diff(time) <= 0.0):
        raise InputError(f"{path}: the times do not rise from row to row; sort them and remove repeats.")
    return Schedule(time, values)


def entry(row: list[str], quantity: str, accept: Accept, place: str) -> tuple[float, float]:
    """Time [s] and value of one row."""
    try:
        time, value = (float(cell) for cell in row)
    except ValueError as error:
        found = ",".join(row)
        raise InputError(f"{place}: {found!r} is not two numbers; give time [s] and {quantity}.") from error
    if not np.isfinite(time):
        raise InputError(f"{place}: time {time} is not finite; give seconds.")
    try:
        return time, accept(value)
    except InputError as error:
        raise InputError(f"{place}: {error}") from error
