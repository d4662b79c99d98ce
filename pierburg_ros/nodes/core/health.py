"""What a node says about itself: tasks, the conditions they are in, and when to say it. Knows no ROS."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

REPORT_PERIOD = 1.0
"""Time between two reports when nothing changes [s]."""
SHORTEST_REPORT = 0.1
"""Shortest time between two reports [s]: a change is told at once, a flicker ten times a second."""
SHOWN = 10.0
"""Time for which a refusal stays in the reports [s]."""

OK, WARN, ERROR = b"\x00", b"\x01", b"\x02"
"""Levels, as `diagnostic_msgs` has them."""


@dataclass(frozen=True)
class Condition:
    """Something that lasts: its task, level and text; over, but not yet told, where not `in_force`."""

    task: str
    level: bytes
    text: str
    in_force: bool = True


@dataclass(frozen=True)
class Status:
    """One task's line in a report."""

    task: str
    level: bytes
    message: str


class Health:
    """Conditions by name, and which of them the next report has to tell."""

    def __init__(self) -> None:
        self._conditions: dict[str, Condition] = {}
        self._refusal: tuple[str, float] | None = None
        self._reported: float | None = None
        self._is_news = False

    @property
    def refusal(self) -> str:
        """The last thing refused, empty before the first."""
        return self._refusal[0] if self._refusal else ""

    def begin(self, name: str, condition: Condition) -> bool:
        """Enter a condition, or tell its newest text; whether it is new."""
        before = self._conditions.get(name)
        self._conditions[name] = condition
        is_new = before is None or not before.in_force or before.level != condition.level
        self._is_news = self._is_news or is_new
        return is_new

    def end(self, name: str) -> bool:
        """Leave a condition; whether the node was in it. One that no report has told yet stays for the next."""
        before = self._conditions.get(name)
        if before is None or not before.in_force:
            return False
        self._conditions[name] = replace(before, in_force=False)
        self._is_news = True
        return True

    def refuse(self, reason: str, now: float) -> None:
        """Something was asked for and not done, at `now` [s]."""
        self._refusal = (reason, now)
        self._is_news = True

    def is_due(self, now: float) -> bool:
        """Whether to report at `now` [s]."""
        if self._reported is None:
            return True
        passed = now - self._reported
        return passed >= REPORT_PERIOD - 0.5 * SHORTEST_REPORT or (self._is_news and passed >= SHORTEST_REPORT)

    def report(self, tasks: Mapping[str, str], now: float) -> list[Status]:
        """One status for each task, `tasks` giving the message of one that is well; conditions over are forgotten."""
        self._reported, self._is_news = now, False
        conditions = list(self._conditions.values())
        if self._refusal and now - self._refusal[1] < SHOWN:
            conditions.append(Condition(next(iter(tasks)), WARN, self._refusal[0]))
        told = [self._status(task, well, conditions) for task, well in tasks.items()]
        self._conditions = {name: each for name, each in self._conditions.items() if each.in_force}
        return told

    @staticmethod
    def _status(task: str, well: str, conditions: list[Condition]) -> Status:
        own = [each for each in conditions if each.task == task]
        texts = [each.text if each.in_force else f"{each.text} (over)" for each in own]
        return Status(task, max((each.level for each in own), default=OK), "; ".join(texts) or well)
