"""The terminal as the commands write to it: what comes from files and paths is shown as it stands, never as markup."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from typing import Any

from rich.console import Console
from rich.text import Text

from pierburg_ros.errors import printable

PIPED = 100
"""Columns of a standard output that is no terminal and says nothing of its width. Chosen: what most tables need."""


@dataclass(frozen=True)
class Loudness:
    """What a command may print beside errors: results on the standard output, progress on the standard error."""

    results: bool = True
    progress: bool = True


LOUDNESS: ContextVar[Loudness] = ContextVar("LOUDNESS", default=Loudness())  # noqa: B039 (it is frozen)


class Terminal(Console):
    """A console that takes `[red]`, `:smile:` and control characters for what they are; styles come from commands."""

    def render_str(self, text: str, **options: Any) -> Text:
        """The text as it stands, line by line."""
        return super().render_str("\n".join(printable(line) for line in text.split("\n")), **options)


def terminal(stderr: bool = False) -> Terminal:
    """The standard output for results, or the standard error for progress; silent where --quiet or --json say so."""
    loud = LOUDNESS.get()
    silent = not (loud.progress if stderr else loud.results)
    shown = Terminal(stderr=stderr, markup=False, emoji=False, highlight=False, quiet=silent)
    if not shown.is_terminal and "COLUMNS" not in shown._environ:
        shown.width = PIPED
    return shown


@contextmanager
def loudness(results: bool, progress: bool) -> Iterator[None]:
    """Let the block print only so much."""
    log = logging.getLogger("pierburg_ros")
    token, level = LOUDNESS.set(Loudness(results, progress)), log.level
    if not progress:
        log.setLevel(logging.ERROR)
    try:
        yield
    finally:
        LOUDNESS.reset(token)
        log.setLevel(level)
