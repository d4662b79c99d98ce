"""Rows for a terminal: a table where every word fits, else a short paragraph a row. Nothing is ever cut."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from rich.console import Console, ConsoleOptions, RenderResult
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

FRAME = 3
"""Columns that a cell takes beside its text. Derived: a space at each side, and a line."""


@dataclass(frozen=True)
class Listing:
    """Rows of cells, the first of which names the row; all are shown as they stand, never as markup."""

    headings: Sequence[str]
    rows: Sequence[Sequence[str]]
    title: str = ""

    @property
    def columns(self) -> Iterable[tuple[str, ...]]:
        """Heading and cells of each column."""
        return zip(self.headings, *self.rows, strict=True)

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        """The table, or the paragraphs, in the width that there is."""
        least = [max(len(word) for cell in column for word in cell.split() or [""]) for column in self.columns]
        most = [max(len(line) for cell in column for line in cell.splitlines() or [""]) for column in self.columns]
        spare = options.max_width - sum(least) - FRAME * len(least) - 1
        yield self._table(widths(least, most, spare)) if spare >= 0 else self._paragraphs()

    def _table(self, widths: Sequence[int]) -> Table:
        table = Table(title=Text(self.title) if self.title else None, show_header=any(self.headings))
        for heading, width in zip(self.headings, widths, strict=True):
            table.add_column(Text(heading), width=width, overflow="fold")
        for row in self.rows:
            table.add_row(*map(Text, row))
        return table

    def _paragraphs(self) -> Table:
        """A grid of one column: a title, then a line for each row with its other cells below it."""
        grid = Table.grid()
        grid.add_column(overflow="fold")
        if self.title:
            grid.add_row(Text(self.title, style="italic"))
        for name, *cells in self.rows:
            grid.add_row(Text(flat(name), style="bold"))
            for heading, cell in zip(self.headings[1:], cells, strict=True):
                if cell:
                    text = Text(f"{heading}: {flat(cell)}" if heading else flat(cell), overflow="fold")
                    grid.add_row(Padding(text, (0, 0, 0, 2)))
        return grid


def flat(cell: str) -> str:
    """The lines of a cell as one."""
    return ", ".join(cell.splitlines())


def widths(least: Sequence[int], most: Sequence[int], spare: int) -> list[int]:
    """Widths of columns between their `least` and `most`, where `spare` is left for all together beyond the least.

    Those that want little get it first, so that only long texts are broken.
    """
    found = list(least)
    order = sorted(range(len(least)), key=lambda column: most[column] - least[column])
    for place, column in enumerate(order):
        given = min(most[column] - least[column], spare // (len(order) - place))
        found[column] += given
        spare -= given
    return found
