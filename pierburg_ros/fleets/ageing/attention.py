"""Which unit to look at first, and why, in a sentence."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta, timezone
from typing import TypeAlias

from pierburg_ros.fleets.ageing.ageing import Ageing
from pierburg_ros.fleets.ageing.course import latest
from pierburg_ros.fleets.run import Examined
from pierburg_ros.pages.numbers import interval, value, words

KINDS = ("a limit", "a trend", "a step", "unlike the rest", "its verdict", "nothing stands out")
"""The kinds of reason to look at a unit."""
Reason: TypeAlias = tuple[tuple[int, float], str, str]
"""Urgency, kind and words."""
NOTHING: Reason = (
    (0, 0.0),
    KINDS[-1],
    "its last recording is as described, nothing changes and nothing is unlike the rest, as far as can be told",
)
MONTH = 365.25 / 12.0
"""Days of a month, in which changes are told. Given: a twelfth of the mean Julian year."""


@dataclass(frozen=True)
class Attention:
    """A unit with the reason to look at it, and how urgent that is: the larger the earlier.

    The first number of `urgency` is 4 for a limit reached or to be reached, 3 for a change, 2 for a unit unlike the
    rest, 1 for a last verdict other than consistent, 0 for none; `kind` says it in words.
    """

    unit: str
    urgency: tuple[int, float]
    kind: str
    why: str


def ranked(recordings: Sequence[Examined], known: Sequence[Ageing]) -> list[Attention]:
    """All units, the most urgent first."""
    units = defaultdict(list)
    for each in recordings:
        units[each.source.unit].append(each)
    found = [
        attention(unit, own, [each for each in known if each.course.unit_name == unit]) for unit, own in units.items()
    ]
    return sorted(found, key=lambda each: each.urgency, reverse=True)


def attention(unit: str, own: Sequence[Examined], known: Iterable[Ageing]) -> Attention:
    """The most urgent that is known of one unit, from its `own` recordings and its courses."""
    reasons = [*_verdict(own), *(reason for each in known for reason in _reasons(each))]
    return Attention(unit, *max(reasons, default=NOTHING))


def _verdict(own: Sequence[Examined]) -> Iterator[Reason]:
    """What the last diagnosis of a unit says unless all is as described: the more urgent the larger the error."""
    last = latest(own)
    if last is None:
        yield (1, math.inf), KINDS[4], "none of its recordings could be used"
    elif last.result["faults"]:
        yield (1, math.inf), KINDS[4], f"its last recording has signals at fault ({'; '.join(last.result['faults'])})"
    elif last.result["verdict"] != "consistent":
        error, noise = last.result["nominal_rmse"], last.result["noise_floor"]
        times = error / noise if error is not None and noise else math.inf
        said = f"its last diagnosis says {words(last.result['verdict'])}{named(last)}"
        yield (1, times), KINDS[4], f"{said}; as described the error is {times:.3g} times the noise"


def named(each: Examined) -> str:
    """`: static friction, spring preload` where a diagnosis names effects or drifts; else nothing."""
    found = [finding for finding in each.result["findings"] if finding["kind"] != "ruled_out"]
    names = [f["name"].partition(".")[0] if f["kind"] == "effect" else f["name"] for f in found]
    return f": {', '.join(words(name) for name in dict.fromkeys(names))}" if names else ""


def _reasons(each: Ageing) -> Iterator[Reason]:
    quantity = words(each.course.quantity)
    if each.forecast is not None and each.forecast.reached:
        yield (
            (4, math.inf),
            KINDS[0],
            f"its {quantity} is beyond the limit of {each.forecast.limit:g} {each.course.unit}",
        )
    elif each.forecast is not None and each.changes and math.isfinite(each.forecast.last):
        yield (4, -each.forecast.first), KINDS[0], f"its {quantity} {_changing(each)} and {_reaching(each)}"
    if each.changes:
        yield (3, abs(each.change)), KINDS[1], f"its {quantity} {_changing(each)}"
    if each.stepped and each.step is not None:
        yield (3, abs(each.share(each.step.size))), KINDS[2], f"its {quantity} {_stepping(each)}"
    if each.differs and each.away is not None:
        side = "above" if each.away > 0.0 else "below"
        said = f"its {quantity} lies {abs(each.away):.1f} deviations {side} the middle of the other units"
        yield (2, abs(each.away)), KINDS[3], said


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
