"""The page of a fleet: units to sort and to filter, their courses, and the way to the report of each recording."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from importlib import resources
from typing import Any

from pierburg_ros.actuators import Actuator
from pierburg_ros.fleets.ageing.ageing import Ageing
from pierburg_ros.fleets.ageing.attention import KINDS, Attention, day, named
from pierburg_ros.fleets.ageing.course import DAY, in_time, latest, moment
from pierburg_ros.fleets.run import Examined
from pierburg_ros.fleets.store import RECORDINGS
from pierburg_ros.pages.numbers import words
from pierburg_ros.pages.page import inert, written
from pierburg_ros.pages.provenance import provenance

DIGITS = 6
"""Significant digits of the numbers behind the plots. Chosen: a pixel is a thousandth of a plot; not varied."""


def fleet_page(
    recordings: Sequence[Examined],
    known: Sequence[Ageing],
    attention: Sequence[Attention],
    sentence: str,
    actuator: Actuator,
) -> str:
    """The page as HTML."""
    by_unit: dict[str, list[Examined]] = defaultdict(list)
    for each in recordings:
        by_unit[each.source.unit].append(each)
    courses: dict[str, list[Ageing]] = defaultdict(list)
    for known_of_one in known:
        courses[known_of_one.course.unit_name].append(known_of_one)
    rows = [unit_row(rank, each, by_unit[each.unit]) for rank, each in enumerate(attention, start=1)]
    details = "\n".join(inert(detail(by_unit[each.unit], courses[each.unit])) for each in attention)
    context = {
        "title": f"{len(by_unit)} units of {actuator.name}",
        "sentence": sentence,
        "rows": rows,
        "count": len(recordings),
        "unusable": sum(each.problem is not None for each in recordings),
        "undated": sum(each.problem is None and moment(each) is None for each in recordings),
        "kinds": KINDS,
        "details": details,
        "script": (resources.files("pierburg_ros.fleets") / "fleet.js").read_text(encoding="utf-8"),
    }
    return written(
        "pierburg_ros.fleets", "fleet.html", {}, context, provenance=provenance(actuator, {}), library_later=True
    )


def unit_row(rank: int, each: Attention, own: Sequence[Examined]) -> dict[str, Any]:
    """A unit as a row of the table."""
    dated = sorted(when for recording in own if (when := moment(recording)) is not None)
    last = latest(own)
    return {
        "rank": rank,
        "unit": each.unit,
        "kind": each.kind,
        "why": each.why,
        "recordings": len(own),
        "unusable": sum(recording.problem is not None for recording in own),
        "verdict": words(last.result["verdict"]) if last else "none",
        "last": f"{dated[-1]:%Y-%m-%d}" if dated else "",
    }


def detail(own: Sequence[Examined], courses: Sequence[Ageing]) -> dict[str, Any]:
    """What the page's script shows of a unit when it is opened: its recordings and its courses."""
    return {
        "recordings": [
            [
                f"{when:%Y-%m-%d %H:%M}" if (when := moment(each)) else "",
                each.source.path.rpartition("/")[2],
                each.problem or words(each.result["verdict"]),
                "" if each.problem else named(each).removeprefix(": "),
                "" if each.problem else f"{RECORDINGS}/{each.key}/report.html",
            ]
            for each in in_time(own)
        ],
        "courses": [course(each) for each in courses],
    }


def course(each: Ageing) -> dict[str, Any]:
    """The points of a course, its line with the step, and what is believed of it."""
    own = each.course
    reach = 1.96 * own.deviation
    line = []
    if each.line is not None:
        step = each.step.before if each.stepped and each.step is not None else None
        size = 0.0 if step is None else float(each.line.found.coefficients[-1])
        for time in own.time:
            line.append(_short(each.line.at(float(time))[0] - (size if step is not None and time < step else 0.0)))
    return {
        "name": words(own.quantity),
        "unit": own.unit,
        "time": [_stamp(float(time)) for time in own.time],
        "value": [_short(value) for value in own.value],
        "reach": [_short(value) for value in reach],
        "limited": [int(flag) for flag in own.limited],
        "line": line,
        "said": _said(each),
        "limit": None if each.forecast is None else each.forecast.limit,
    }


def _said(each: Ageing) -> str:
    parts = []
    if each.changes:
        parts.append(f"trend ({100.0 * each.change:+.0f} % over the course)")
    if each.stepped and each.step is not None:
        parts.append(f"step between {day(each.step.first)} and {day(each.step.last)}")
    if each.differs:
        parts.append("unlike the rest")
    if each.forecast is not None and each.forecast.time is not None:
        parts.append(f"limit about {day(each.forecast.time)}")
    return "; ".join(parts) or "nothing stands out"


def _stamp(time: float) -> int:
    """A time [days since 1970] in milliseconds, as a browser counts."""
    return round(time * DAY * 1e3)


def _short(value: float) -> float:
    return float(f"{value:.{DIGITS}g}")
