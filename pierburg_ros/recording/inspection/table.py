"""The columns of a table, or of several in one folder."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.recording.columns import Columns
from pierburg_ros.recording.formats import format_of
from pierburg_ros.recording.formats.headings import Heading
from pierburg_ros.recording.inspection.content import Guesses, TopicContent, contents_of, rate
from pierburg_ros.recording.inspection.fields import Field
from pierburg_ros.recording.inspection.guesses import Guess, guess
from pierburg_ros.recording.inspection.table_time import TimeGuess, time_guess
from pierburg_ros.recording.loss import pauses
from pierburg_ros.recording.signal_map import SignalMap
from pierburg_ros.recording.signals import TIME
from pierburg_ros.recording.tables import check_cells

COLUMN = "column"
"""Type of what a table has in place of topics."""


def tables_in(folder: Path) -> dict[str, Columns]:
    """The tables in a folder that is no bag, by the names of their files."""
    found: dict[str, Columns] = {}
    for path in sorted(folder.glob("*.csv")):
        table = format_of(path).read(path, lambda _: True)
        assert isinstance(table, Columns)  # by its suffix
        found[path.name] = table
        check_cells(folder.name, found.values())
    return found


def columns(
    tables: Mapping[str, Columns], chosen: SignalMap
) -> tuple[tuple[TopicContent, ...], Guesses, TimeGuess | None]:
    """The columns of tables, by the name of the file (empty for the recording itself), and what each could be."""
    contents: list[TopicContent] = []
    guessed: dict[Field, Guess | None] = {}
    first = None
    for file, table in tables.items():
        cells = {name: np.frombuffer(values, np.float64) for name, values in table.cells.items()}
        clock = time_guess(cells, {name: stated(table, name) for name in cells}, table.origins)
        first = first or clock
        for name, values in cells.items():
            field = Field(name, COLUMN, "", values[np.isfinite(values)], file, stated(table, name))
            is_time = name in table.origins or (clock is not None and name in clock.columns)
            guessed[field] = None if is_time else guess(field)
            contents.append(column_content(field, values, clock, chosen, guessed))
    return tuple(contents), guessed, first


def column_content(
    field: Field, values: Signal, clock: TimeGuess | None, chosen: SignalMap, guessed: Guesses
) -> TopicContent:
    """One column, with empty cells as `values` that are no numbers."""
    filled = np.isfinite(values)
    time = clock.seconds[filled] if clock else np.zeros(0)
    low, high = field.limits or (None, None)
    contents = contents_of([field], guessed)
    if clock and field.name in clock.columns:
        unit = "" if len(clock.columns) > 1 else f" [{clock.unit}]" if clock.unit else ", stamps"
        contents = tuple(replace(each, could_be=f"{low:.6g} to {high:.6g}: time{unit}?") for each in contents)
    return TopicContent(
        f"{field.file} {field.name}".lstrip(),
        COLUMN,
        int(np.count_nonzero(filled)),
        rate(time),
        low,
        high,
        None,
        pauses(time - time[0]) if time.size else (),
        (COLUMN,),
        used_as(field, chosen),
        contents,
    )


def stated(table: Columns, name: str) -> str:
    """The unit that a table states of a column, empty where it is not clear."""
    return "" if name in table.unclear else table.units.get(name, "")


def used_as(field: Field, chosen: SignalMap) -> str | None:
    """The signal that a column is read as: as a person chose, or by its own name."""
    called = {column: signal for signal, column in chosen.columns.items()}
    called |= dict.fromkeys(chosen.time.columns if chosen.time else (TIME,), TIME)
    signal = called.get(field.name) or called.get(Heading.of(field.name).bare)
    source = chosen.sources.get(signal or "")
    elsewhere = field.file not in (source.files or ("",)) if source else bool(field.file) and signal != TIME
    return None if elsewhere else signal
