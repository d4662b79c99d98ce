"""The exceptions a caller handles differently, and the one line that a person reads of them."""

from __future__ import annotations

from collections.abc import Collection
from difflib import get_close_matches

LONGEST = 285
"""Characters of a message at most: with the command's name before it, 300, which four lines of a terminal hold."""
TAIL = 110
"""Characters of its end that a shortened message keeps: what to do stands there."""

MOST_COMPARED = 1000
"""Names that are compared with one that is wrong: more would take long and help nobody."""


class InputError(ValueError):
    """Something a person gave is not usable; a message is one line: what was found, what was expected, what to do."""

    def __init__(self, *messages: str) -> None:
        """Of several messages each is a line of its own."""
        super().__init__("\n".join(one_line(message) for message in messages))


def one_line(text: str) -> str:
    """`text` as one line that a terminal shows literally; shortened in its middle where it is too long."""
    line = printable(" ".join(text.split()))
    return line if len(line) <= LONGEST else f"{line[: LONGEST - TAIL - 5]} ... {line[-TAIL:]}"


def printable(text: str) -> str:
    """`text` with what a terminal obeys or does not show, as control characters, written as escapes."""
    return "".join(mark if mark.isprintable() else mark.encode("unicode_escape").decode() for mark in text)


def near(name: str, known: Collection[str]) -> str:
    """` Did you mean duty?` where one of the `known` names is close to `name`; else nothing."""
    found = get_close_matches(name, list(known)[:MOST_COMPARED], 1)
    return f" Did you mean {found[0]}?" if found else ""
