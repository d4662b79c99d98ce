"""Which unit to look at first, and why, in a sentence."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta, timezone

from pierburg_ros.fleets.ageing.ageing import Ageing
from pierburg_ros.fleets.run import Examined
from pierburg_ros.pages.numbers import interval, value, words

KINDS = ("a limit", "a trend", "a step", "unlike the rest", "nothing stands out")
"""The kinds of reason to look at a unit."""
MONTH = 365.25 / 12.0
"""Days of a month, in which changes are told. Given: a twelfth of the mean Julian year."""


@dataclass(frozen=True)
class Attention:
    """A unit with the reason to look at it, and how urgent that is: the larger the earlier.

    The first number of `urgency` is 3 for a limit reached or to be reached, 2 for a change, 1 for a unit unlike the
    rest, 0 for none; `kind` says it in words.
    """

    unit: str
    urgency: tuple[int, float]
    kind: str
    why: str


def ranked(recordings: Sequence[Examined], known: Sequence[Ageing]) -> list[Attention]:
    """All units, the most urgent first."""
    units = dict.fromkeys(each.source.unit for each in recordings)
    found = [attention(unit, [each for each in known if each.course.unit_name == unit]) for unit in units]
    return sorted(found, key=lambda each: each.urgency, reverse=True)


def attention(unit: str, known: Iterable[Ageing]) -> Attention:
    """The most urgent that is known of one unit."""
    reasons = [reason for each in known for reason in _reasons(each)]
    if not reasons:
        return Attention(
            unit, (0, 0.0), KINDS[-1], "nothing changes and nothing is unlike the rest, as far as can be told"
        )
    return Attention(unit, *max(reasons))


def _reasons(each: Ageing) -> Iterator[tuple[tuple[int, float], str, str]]:
    quantity = words(each.course.quantity)
    if each.forecast is not None and each.forecast.reached:
        yield (
            (3, math.inf),
            KINDS[0],
            f"its {quantity} is beyond the limit of {each.forecast.limit:g} {each.course.unit}",
        )
    elif each.forecast is not None and each.changes and math.isfinite(each.forecast.last):
        yield (3, -each.forecast.first), KINDS[0], f"its {quantity} {_changing(each)} and {_reaching(each)}"
    if each.changes:
        yield (2, abs(each.change)), KINDS[1], f"its {quantity} {_changing(each)}"
    if each.stepped and each.step is not None:
        yield (2, abs(each.share(each.step.size))), KINDS[2], f"its {quantity} {_stepping(each)}"
    if each.differs and each.away is not None:
        side = "above" if each.away > 0.0 else "below"
        said = f"its {quantity} lies {abs(each.away):.1f} deviations {side} the middle of the other units"
        yield (1, abs(each.away)), KINDS[3], said


def _changing(each: Ageing) -> str:
    assert each.line is not None and each.trend_rate is not None
    slope, ends = each.line.slope * MONTH, [MONTH * end for end in each.line.interval]
    way = "rises" if slope > 0.0 else "falls"
    sizes = sorted(abs(end) for end in ends)
    return (
        f"{way} by {value(abs(slope), sizes)} {each.course.unit} a month (95 %: {interval(sizes)},"
        f" {100.0 * abs(each.change):.0f} % over its course, false discovery rate {each.trend_rate:.1g})"
    )


def _reaching(each: Ageing) -> str:
    assert each.forecast is not None and each.forecast.time is not None
    first, last = day(each.forecast.first), day(each.forecast.last)
    limit = f"{each.forecast.limit:g} {each.course.unit}"
    return f"reaches {limit} about {day(each.forecast.time)} (95 %: {first} to {last}) if all goes on as before"


def _stepping(each: Ageing) -> str:
    assert each.step is not None
    when = f"between {day(each.step.first)} and {day(each.step.last)}"
    return f"stepped by {value(each.step.size, each.step.interval)} {each.course.unit} {when}"


def day(time: float) -> str:
    """A time [days since 1970] as a date."""
    if not math.isfinite(time) or abs(time) > 1e6:
        return "never"
    return f"{datetime(1970, 1, 1, tzinfo=timezone.utc) + timedelta(days=time):%Y-%m-%d}"
