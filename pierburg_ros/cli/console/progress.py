"""How far a command is, on the standard error: a bar on a terminal, a line now and then elsewhere."""

from __future__ import annotations

import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from threading import Lock

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskID, TextColumn, TimeElapsedColumn

from pierburg_ros.cli.console.terminal import terminal

SELDOM = 10.0
"""Time [s] between two lines of progress in a log. Chosen: a diagnosis of two minutes leaves a dozen."""


@dataclass(frozen=True)
class Step:
    """How far a command is: its stage, how many were tried of about how many, the best so far, the time left [s]."""

    stage: str
    done: int | None = None
    about: int | None = None
    best: str = ""
    left: float | None = None
    what: str = ""

    @property
    def counted(self) -> str:
        """How many were tried of about how many, in words."""
        if self.done is None:
            return ""
        more = self.about is not None and self.about > self.done
        return f"{self.done} of about {self.about}" if more else f"{self.done} tried"

    @property
    def words(self) -> str:
        """All of it, but for what is being tried."""
        left = "" if self.left is None else f"about {duration(self.left)} left"
        return ", ".join(part for part in (self.counted, self.best, left) if part)

    def timed(self, gone: float) -> Step:
        """The step with the time that is left, if each piece takes as long as in the time [s] since the stage began.

        The first step of a stage shows no pace.
        """
        if self.left is not None or not self.done or self.about is None or gone <= 0.0:
            return self
        return replace(self, left=gone / self.done * max(self.about - self.done, 0))


Tell = Callable[[Step], None]


def duration(seconds: float) -> str:
    """A time for people: 40 s, 3 min, 2.5 h."""
    if seconds < 100.0:
        return f"{seconds:.0f} s"
    return f"{seconds / 60.0:.0f} min" if seconds < 6000.0 else f"{seconds / 3600.0:.1f} h"


@contextmanager
def progress() -> Iterator[Tell]:
    """What a command tells its steps to, from whatever thread: gone from a terminal at the end of the block."""
    console = terminal(stderr=True)
    if not console.is_terminal or console.quiet:
        yield Log(console)
        return
    columns = (TextColumn("{task.description}"), BarColumn(20), TimeElapsedColumn(), TextColumn("{task.fields[words]}"))
    with Progress(*columns, console=console, transient=True) as bar:
        yield Bar(bar, bar.add_task("", total=None, words=""))


class Stages(ABC):
    """The step in words, with the time since its stage began."""

    def __init__(self) -> None:
        self._stage, self._since = "", 0.0
        self._lock = Lock()

    def __call__(self, step: Step) -> None:
        """Show the step, or keep silent."""
        with self._lock:
            now = time.monotonic()
            is_new = step.stage != self._stage
            if is_new:
                self._stage, self._since = step.stage, now
            self.show(step.timed(now - self._since), is_new, now)

    @abstractmethod
    def show(self, step: Step, is_new: bool, now: float) -> None:
        """Show the step, the first of its stage if it `is_new`, at a time [s]."""


class Bar(Stages):
    """A bar that moves."""

    def __init__(self, bar: Progress, task: TaskID) -> None:
        super().__init__()
        self._bar, self._task = bar, task

    def show(self, step: Step, is_new: bool, now: float) -> None:
        """Move the bar."""
        words = "; ".join(part for part in (step.words, step.what) if part)
        self._bar.update(self._task, completed=step.done or 0, total=step.about, description=step.stage, words=words)


class Log(Stages):
    """A line for each stage, and now and then one between."""

    def __init__(self, console: Console) -> None:
        super().__init__()
        self._console, self._last = console, 0.0

    def show(self, step: Step, is_new: bool, now: float) -> None:
        """Print a line if it is time for one."""
        if is_new or now - self._last >= SELDOM:
            self._last = now
            self._console.print(f"{step.stage}: {step.words}" if step.words else step.stage, soft_wrap=True)
