"""The head of a table: the names of its columns, and the units that stand behind them or in a row below."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace

from pierburg_ros.recording.formats.stamps import is_stamp
from pierburg_ros.recording.units import unit_of

TRUTH = {"true": 1.0, "false": 0.0}
SPELLINGS = {
    "sec": "s", "secs": "s", "second": "s", "seconds": "s", "msec": "ms", "usec": "us", "µs": "us", "nsec": "ns",
    "volt": "V", "volts": "V", "amp": "A", "amps": "A", "pct": "percent", "radian": "rad", "radians": "rad",
    "count": "counts", "ticks": "counts", "lsb": "counts", "1/min": "rpm", "u/min": "rpm", "r/min": "rpm",
    "rev/min": "rpm", "%": "percent", "°": "deg",
}  # fmt: skip
"""Other spellings of units in tables, in small letters, and what a signal map writes. A speed in 1/min is one of
turns."""
NONE = ("-", "1", "")
"""Cells of a row of units that state none."""
BEHIND = re.compile(r"(?P<name>.*\S)\s*(?:\[(?P<square>[^][]*)\]|\((?P<round>[^()]*)\))")
"""A name with a unit behind it, in brackets."""


@dataclass(frozen=True)
class Heading:
    """The head of one column: its name as `written`, its `bare` name without a unit, and the `unit` that it states.

    The unit is empty where none is stated. `unclear` has the row and the text of one that cannot be one.
    """

    written: str
    bare: str
    unit: str = ""
    unclear: tuple[int, str] | None = None

    @staticmethod
    def of(cell: str) -> Heading:
        """The heading in a cell: `hall [mV]` and `t (ms)` state a unit, `position[elbow]` and `data[1]` do not."""
        written = cell.strip()
        found = BEHIND.fullmatch(written)
        unit = unit_in(found["square"] or found["round"] or "") if found else ""
        return Heading(written, found["name"], unit) if found and unit else Heading(written, written)

    def below(self, line: int, cell: str) -> Heading:
        """The same with what a row of units in this `line` states of it."""
        text, unit = bracketless(cell), unit_in(cell)
        if text in NONE or (unit and unit == self.unit):
            return self
        clear = unit and not self.unit
        return replace(self, unit=unit) if clear else replace(self, unclear=(line, text[:60]))


def is_units(row: list[str]) -> bool:
    """Whether a row below the names states units: one at least, and no values."""
    return any(unit_in(cell) for cell in row) and not any(is_value(cell.strip()) for cell in row)


def unit_in(cell: str) -> str:
    """The unit that a cell states, as a signal map writes it; empty where it states none or is none."""
    text = bracketless(cell)
    spelled = SPELLINGS.get(text.lower(), text)
    try:
        return "" if text in NONE else unit_of(spelled).written
    except ValueError:
        return ""


def bracketless(cell: str) -> str:
    """A cell without the brackets around all of it."""
    text = cell.strip()
    return text[1:-1].strip() if text[:1] + text[-1:] in ("[]", "()") else text


def is_value(cell: str) -> bool:
    """Whether a cell is a value of a sample: a number, a truth value or a stamp; a 1 may stand for no unit."""
    return cell not in NONE and (is_number(cell) or cell.lower() in TRUTH or is_stamp(cell))


def is_number(cell: str) -> bool:
    """Whether `cell` reads as a number, with a point or a comma before its decimals."""
    try:
        float(cell.replace(",", "."))
    except ValueError:
        return False
    return True
