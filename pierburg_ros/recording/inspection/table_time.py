"""Which column of a table is its time, and in which unit."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from dataclasses import dataclass

import numpy as np

from pierburg_ros.arrays import Signal

NAMES = re.compile(r"(?:^|[^a-z])(time|t|stamp|timestamp|secs?|seconds|zeit|ms|us|ns|millis|micros)(?:[^a-z]|$)", re.I)
UNIT = re.compile(r"(?:^|[^a-z])(s|sec|secs|ms|millis|us|micros|ns|nsecs)(?:[^a-z]|$)", re.I)
UNITS = {
    "s": "s",
    "sec": "s",
    "secs": "s",
    "ms": "ms",
    "millis": "ms",
    "us": "us",
    "micros": "us",
    "ns": "ns",
    "nsecs": "ns",
}
FACTORS = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}
SINCE_1970 = ((1e17, "ns"), (1e14, "us"), (1e11, "ms"), (1e8, "s"))
"""Times from here on count from 1970, in this unit."""
STEPS = ((0.5, "s"), (50.0, "ms"), (50_000.0, "us"))
"""Largest usual step of a time that counts from a start, in this unit: 20 to 2000 samples a second; beyond them, ns."""
NANOSECONDS = re.compile(r"(?:^|[^a-z])(nanosecs?|nsecs?|nanoseconds)$", re.I)
SECONDS = re.compile(r"(?:^|[^a-z])(secs?|seconds)$", re.I)


@dataclass(frozen=True)
class TimeGuess:
    """The columns of the time, their unit and why; `seconds` are the times, since the first. Stamps have no unit."""

    columns: tuple[str, ...]
    unit: str
    reason: str
    seconds: Signal


def time_guess(
    columns: Mapping[str, Signal], units: Mapping[str, str] | None = None, stamped: Collection[str] = ()
) -> TimeGuess | None:
    """The time among `columns` of numbers, None where none rises from row to row.

    `units` are those that the table states, and `stamped` the columns of stamps, which are times [s].
    """
    units = units or {}
    rising = {name: values for name, values in columns.items() if rises(values)}
    whole = [name for name, values in columns.items() if SECONDS.search(name) and never_falls(values)]
    parts = [name for name in columns if NANOSECONDS.search(name)]
    if whole and parts:
        values = columns[whole[0]] - columns[whole[0]][0] + 1e-9 * columns[parts[0]]
        if rises(values):
            return TimeGuess((whole[0], parts[0]), "s", "stamps of ROS in two columns", values - values[0])
    if stamps := next((name for name in rising if name in stamped), ""):
        return TimeGuess((stamps,), "", "stamps of ISO 8601", rising[stamps] - rising[stamps][0])
    usual = [name for name in rising if units.get(name, "") in FACTORS or not units.get(name)]
    named = [name for name in usual if NAMES.search(name) or units.get(name)] or usual
    if not named:
        return None
    name = named[0]
    stated = units.get(name, "")
    unit, reason = (stated, "as the table says") if stated else unit_guess(name, rising[name])
    return TimeGuess((name,), unit, reason, (rising[name] - rising[name][0]) * FACTORS[unit])


def never_falls(values: Signal) -> bool:
    """Whether every row has a number that is none less than the one before."""
    return values.size > 1 and bool(np.all(np.isfinite(values))) and bool(np.all(np.diff(values) >= 0.0))


def rises(values: Signal) -> bool:
    """Whether the numbers never fall and rise nearly always."""
    return never_falls(values) and float(np.mean(np.diff(values) > 0.0)) > 0.5


def unit_guess(name: str, values: Signal) -> tuple[str, str]:
    """The unit of a time, and why."""
    found = UNIT.search(name)
    if found and found[1].lower() in UNITS:
        return UNITS[found[1].lower()], "by its name"
    for least, unit in SINCE_1970:
        if values[0] >= least:
            return unit, f"counts {unit} since 1970"
    step = float(np.median(np.diff(values)))
    unit = next((unit for most, unit in STEPS if step <= most), "ns")
    return unit, f"steps of {step:.3g}"
