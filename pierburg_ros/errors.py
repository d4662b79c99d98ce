"""The exceptions a caller handles differently, and the one line that a person reads of them."""

from __future__ import annotations

LONGEST = 285
"""Characters of a message at most: with the command's name before it, 300, which four lines of a terminal hold."""
TAIL = 110
"""Characters of its end that a shortened message keeps: what to do stands there."""


class InputError(ValueError):
    """Something a person gave is not usable; the message is one line: what was found, what was expected, what to do."""

    def __init__(self, message: str) -> None:
        super().__init__(one_line(message))


def one_line(text: str) -> str:
    """`text` as one line that a terminal shows literally; shortened in its middle where it is too long."""
    line = printable(" ".join(text.split()))
    return line if len(line) <= LONGEST else f"{line[: LONGEST - TAIL - 5]} ... {line[-TAIL:]}"


def printable(text: str) -> str:
    """`text` with what a terminal obeys or does not show, as control characters, written as escapes."""
    return "".join(mark if mark.isprintable() else mark.encode("unicode_escape").decode() for mark in text)
