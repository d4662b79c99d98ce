"""The terminal as the commands write to it: what comes from files and paths is shown as it stands, never as markup."""

from __future__ import annotations

from typing import Any

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)
from rich.text import Text

from pierburg_ros.errors import printable


class Terminal(Console):
    """A console that takes `[red]`, `:smile:` and control characters for what they are; styles come from commands."""

    def render_str(self, text: str, **options: Any) -> Text:
        """The text as it stands, line by line."""
        return super().render_str("\n".join(printable(line) for line in text.split("\n")), **options)


def terminal(stderr: bool = False) -> Terminal:
    """The standard output, or the standard error."""
    return Terminal(stderr=stderr, markup=False, emoji=False, highlight=False)


def progress_bar() -> Progress:
    """A bar on stderr that counts pieces of work and says how they stand."""
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        TimeRemainingColumn(),
    )
    return Progress(*columns, console=terminal(stderr=True))
