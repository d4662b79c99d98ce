"""Progress reports: a text for a caller that only prints it, with numbers for a caller that draws a bar."""

from __future__ import annotations

from collections.abc import Callable

Progress = Callable[[str], None]
"""A function that is given what is being tried, as a text or, where more is known, as `Tried`."""


class Tried(str):
    """What is being tried, as a text."""

    stage: str
    """The stage it belongs to, as in: missing physics."""
    done: int | None
    """Pieces of work done so far in this stage; None: not counted."""
    about: int | None
    """How many there will be, as far as is known now; None: not known."""
    best: str
    """The best result so far in words; empty if nothing is known yet."""
    left: float | None
    """Time [s] that is left at least; None: no limit."""

    def __new__(
        cls,
        what: str,
        stage: str,
        done: int | None = None,
        about: int | None = None,
        best: str = "",
        left: float | None = None,
    ) -> Tried:
        """`what` with the numbers named above."""
        tried = super().__new__(cls, what)
        tried.stage, tried.done, tried.about, tried.best, tried.left = stage, done, about, best, left
        return tried


def staged(progress: Progress, stage: str, about: int | None = None) -> Progress:
    """`progress` that marks what is tried with its `stage`, and counts it."""
    done = 0

    def tell(what: str) -> None:
        nonlocal done
        done += 1
        progress(Tried(what, stage, done, about))

    return tell
