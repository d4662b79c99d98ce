"""How a command ends other than well: one line on the standard error, and the status that shells know."""

from __future__ import annotations

import re
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import NoReturn

from pierburg_ros.errors import near, one_line

REFUSED = 2
INTERRUPTED, TERMINATED = 128 + signal.SIGINT, 128 + signal.SIGTERM
SIGNALS = {INTERRUPTED: "interrupted", TERMINATED: "terminated"}
"""Exit statuses of a run that a signal has ended, as shells count them, and the line that says so."""


AGAIN = 0.5
"""Time [s] after which a signal that was not heard is raised again, within the 2 s in which a command has to end."""


class Terminated(BaseException):
    """SIGTERM has come: everything that is open is closed and cleared on the way out, as after Ctrl-C."""


@contextmanager
def terminable() -> Iterator[None]:
    """Let SIGINT and SIGTERM end the block as an exception does, so that nothing is left half done.

    What a signal raises is raised again every `AGAIN` until it is heard: the compiler's callbacks swallow what is
    raised within them, or end in an error of their own.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    told: BaseException | None = None

    def end(number: int, _: object) -> None:
        nonlocal told
        told = told or (KeyboardInterrupt() if number == signal.SIGINT else Terminated())
        signal.setitimer(signal.ITIMER_REAL, AGAIN)
        if sys.exc_info()[1] is not told:  # it is not on its way out
            raise told

    before = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM, signal.SIGALRM)}
    for number, handler in before.items():
        if handler is not signal.SIG_IGN:
            signal.signal(number, end)
    try:
        yield
    except Exception:
        if told is None:
            raise
        raise told from None
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        for number, handler in before.items():
            signal.signal(number, handler)


def refuse(reason: str) -> NoReturn:
    """Print `reason` as one line on stderr and end with exit status 2."""
    print("pierburg:", one_line(reason), file=sys.stderr)
    raise SystemExit(REFUSED)


def usage(error: Exception, command: str) -> str:
    """One line about a command line that cannot be understood, with what was meant where that is clear.

    Typer keeps its usage errors private; they are the ones that can format themselves. Anything else is raised again.
    """
    if not hasattr(error, "format_message"):
        raise error
    meant = getattr(error, "possibilities", None)
    message = error.message if meant else error.format_message()  # type: ignore[attr-defined]
    message = message.rstrip().replace("Value error, ", "")
    question = f" Did you mean {' or '.join(sorted(meant))}?" if meant else nearest_choice(message)
    stop = "" if message.endswith((".", "?")) else "."
    return f"{message}{stop}{question} See '{command} --help'."


def nearest_choice(message: str) -> str:
    """The question after `'chck' is not one of 'new', 'check'`; nothing after other messages."""
    found, _, choices = message.partition(" is not one of ")
    return near(found.rpartition(" ")[2].strip("'"), re.findall("'([^']+)'", choices)) if choices else ""
