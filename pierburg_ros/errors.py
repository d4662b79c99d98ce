"""The exceptions a caller handles differently, and the one line that a person reads of them."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection
from difflib import get_close_matches
from functools import wraps
from typing import ParamSpec, TypeVar

Given = ParamSpec("Given")
Found = TypeVar("Found")

LONGEST = 285
"""Characters of a message at most: with the command's name before it, 300, which four lines of a terminal hold."""
TAIL = 110
"""Characters of its end that a shortened message keeps: what to do stands there."""

ARGUMENTS = {"topic": "topics", "fix": "fixed", "limit": "limits"}
"""Arguments of the Python interface that are not called as the option of a command is."""

MOST_COMPARED = 1000
"""Names that are compared with one that is wrong: more would take long and help nobody."""


class InputError(ValueError):
    """Something a person gave is not usable; a message is one line: what was found, what was expected, what to do."""

    def __init__(self, *messages: str) -> None:
        """Of several messages each is a line of its own."""
        super().__init__("\n".join(one_line(message) for message in messages))


def naming_arguments(function: Callable[Given, Found]) -> Callable[Given, Found]:
    """`function`, whose InputErrors name arguments where those of a command name options."""

    @wraps(function)
    def called(*arguments: Given.args, **named: Given.kwargs) -> Found:
        try:
            return function(*arguments, **named)
        except InputError as error:
            raise InputError(by_argument(str(error))) from None

    return called


def by_argument(message: str) -> str:
    """A message that names arguments where it names options; a command in quotes, 'pierburg ...', stays as it is."""
    parts = re.split(r"('pierburg [^']*')", message)
    return "".join(part if number % 2 else of_argument(part) for number, part in enumerate(parts))


def of_argument(text: str) -> str:
    """`--topic duty=/pwm` as `topics={'duty': '/pwm'}`, any other `--option` as the argument in backquotes."""
    text = re.sub(r"--topic (\w+)=([^\s.;,]+)", r"topics={'\1': '\2'}", text)
    return re.sub(r"--([a-z][a-z-]*)", lambda found: f"`{ARGUMENTS.get(found[1], found[1].replace('-', '_'))}`", text)


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
