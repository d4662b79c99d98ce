"""Stamps as ISO 8601 writes them: a date, a time of day, and perhaps a zone."""

from __future__ import annotations

import re
from datetime import datetime, timedelta

STAMP = re.compile(
    r"(?P<moment>\d{4}-\d\d-\d\d[T ]\d\d:\d\d(?::\d\d)?)(?:[.,](?P<part>\d{1,12}))?"
    r" ?(?P<zone>Z|(?P<hours>[+-]\d\d)(?::?(?P<minutes>\d\d))?)?",
    re.I,
)
EPOCH = datetime(1970, 1, 1)
NANOSECONDS = 1_000_000_000


def is_stamp(cell: str) -> bool:
    """Whether `cell` is written like a stamp; the day and the hour need not exist."""
    return STAMP.fullmatch(cell) is not None


def has_zone(cell: str) -> bool:
    """Whether a stamp says in which zone it counts."""
    found = STAMP.fullmatch(cell)
    return found is not None and found["zone"] is not None


def nanoseconds(cell: str) -> int | None:
    """Time [ns] since 1970 of a stamp, in UTC if it has no zone; None where `cell` is none, or there is no such day."""
    found = STAMP.fullmatch(cell)
    if found is None:
        return None
    try:
        since = datetime.fromisoformat(found["moment"]) - EPOCH - east(found["hours"], found["minutes"])
    except ValueError:
        return None
    whole, part = since.days * 86_400 + since.seconds, found["part"] or ""
    return whole * NANOSECONDS + int(part.ljust(9, "0")[:9])


def east(hours: str | None, minutes: str | None) -> timedelta:
    """By how much the clocks of a zone are ahead of UTC; ValueError where no zone is so far."""
    ahead = timedelta(hours=int(hours or "0"), minutes=int(minutes or "0") * (-1 if (hours or "")[:1] == "-" else 1))
    if abs(ahead) >= timedelta(days=1) or int(minutes or "0") >= 60:
        raise ValueError("no such zone")
    return ahead
