"""The rows of a CSV file, one at a time."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from typing import TextIO

from pierburg_ros.errors import InputError

LONGEST_LINE = 65_536
"""Characters of a line at most: a thousand columns of 60 digits. A file without line ends is no table."""


def lines(file: TextIO, name: str) -> Iterator[str]:
    """The lines of `file`, none of them longer than a table's."""
    while line := file.readline(LONGEST_LINE + 1):
        if len(line) > LONGEST_LINE:
            raise InputError(f"{name} has a line of more than {LONGEST_LINE} characters, expected rows of a table.")
        yield line


def rows(file: TextIO, name: str, delimiter: str = ",") -> Iterator[tuple[int, list[str]]]:
    """Line number and cells of every row that is not empty."""
    reader = csv.reader(lines(file, name), delimiter=delimiter)
    try:
        for row in reader:
            if row:
                yield reader.line_num, row
    except csv.Error as error:
        raise InputError(f"{name} is not a table in line {reader.line_num + 1} ({error}). Repair it there.") from error
