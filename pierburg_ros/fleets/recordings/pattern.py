"""Whose recording it is and of when, from its path: `{unit}/{date}_*.mcap`."""

from __future__ import annotations

import re
from collections.abc import Callable
from datetime import datetime, timezone

from pierburg_ros.errors import InputError

FIELDS = ("unit", "date")
FORMS = (
    "%Y-%m-%dT%H:%M:%S",
    "%Y-%m-%dT%H-%M-%S",
    "%Y-%m-%d %H:%M:%S",
    "%Y-%m-%d_%H-%M-%S",
    "%Y_%m_%d-%H_%M_%S",
    "%Y%m%dT%H%M%S",
    "%Y%m%d_%H%M%S",
    "%Y%m%d-%H%M%S",
    "%Y-%m-%dT%H:%M",
    "%Y-%m-%d %H:%M",
    "%Y-%m-%d",
    "%Y_%m_%d",
    "%Y%m%d",
)
"""How a date may be written, beside what Python reads as ISO 8601; `%Y_%m_%d-%H_%M_%S` is what rosbag2 writes."""


def matcher(pattern: str) -> re.Pattern[str]:
    """What recognises the path of a recording below its folder; InputError where the pattern cannot be used."""
    found = re.findall(r"\{(.*?)\}", pattern)
    if unknown := [field for field in found if field not in FIELDS]:
        raise InputError(
            f"--pattern found {{{unknown[0]}}}, expected {{unit}} and {{date}}. Write {{unit}}/{{date}}_*.mcap."
        )
    if len(set(found)) < len(found) or not found:
        raise InputError(
            f"--pattern {pattern} names {len(found)} fields, expected {{unit}}, {{date}} or both, once each."
        )
    parts = re.split(r"(\{\w+\}|\*\*/|\*|\?)", pattern)
    return re.compile("".join(_expression(part) for part in parts))


def _expression(part: str) -> str:
    """The regular expression of one part of a pattern; a field is as short as what follows it allows."""
    if part.startswith("{"):
        return rf"(?P<{part[1:-1]}>[^/]+?)"
    return {"**/": "(?:.*/)?", "*": "[^/]*", "?": "[^/]"}.get(part, re.escape(part))


def instant(text: str) -> datetime:
    """The moment that a date says, in UTC where it names no zone; InputError where it is none."""
    for read in (datetime.fromisoformat, *(_reader(form) for form in FORMS)):
        try:
            found = read(text.strip())
        except ValueError:
            continue
        return (found if found.tzinfo else found.replace(tzinfo=timezone.utc)).astimezone(timezone.utc)
    raise InputError(f"found the date {text!r:.40}, expected one as in 2026-01-31 or 2026-01-31T12:30:00.")


def _reader(form: str) -> Callable[[str], datetime]:
    return lambda text: datetime.strptime(text, form)
