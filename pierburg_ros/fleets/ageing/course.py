"""The course of one quantity of one unit: what each of its recordings says of it, over time."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime, timezone

import numpy as np

from pierburg_ros.arrays import Flags, Signal
from pierburg_ros.effects import EFFECT
from pierburg_ros.fleets.run import Examined

DAY = 86_400.0
"""Seconds of a day, the unit of time of a course. Given: by the definition of the day."""
EARLIEST = datetime(2000, 1, 1, tzinfo=timezone.utc).timestamp()
"""Time [s since 1970] before which a clock counts from its own start and tells no date. Chosen: no recording in one of
the formats read here is older."""


@dataclass(frozen=True)
class Course:
    """What the recordings of a unit say of a quantity; all signals of shape (recordings,), by time.

    `time` [days since 1970], `value` and its standard `deviation` in `unit`, `temperature` [degC] (NaN where it is not
    known). Where a strength is only `limited`, between 0 and what the diagnosis rules out, its value is the middle and
    its deviation that of an even distribution over that range. `nominal` is the described value, 0 of an effect.
    """

    unit_name: str
    quantity: str
    unit: str
    time: Signal
    value: Signal
    deviation: Signal
    limited: Flags
    temperature: Signal
    nominal: float

    @property
    def size(self) -> int:
        """Number of recordings that say something."""
        return int(self.time.size)


def moment(each: Examined) -> datetime | None:
    """When a recording was made: as told, else by its own clock; None where neither says so."""
    if each.source.time is not None:
        return each.source.time
    begun = each.result.get("begun")
    return datetime.fromtimestamp(begun, timezone.utc) if begun is not None and begun > EARLIEST else None


def in_time(recordings: Sequence[Examined]) -> list[Examined]:
    """The recordings by time, those without one first, in the order given."""
    return sorted(recordings, key=lambda each: 0.0 if (when := moment(each)) is None else when.timestamp())


def latest(own: Sequence[Examined]) -> Examined | None:
    """The last of a unit's recordings that could be used; None where none could."""
    return next((each for each in reversed(in_time(own)) if not each.problem), None)


def courses(recordings: Sequence[Examined], nominal: Mapping[str, float], units: Mapping[str, str]) -> list[Course]:
    """The courses of all units; `nominal` values and `units` by dotted name."""
    points: dict[tuple[str, str], list[tuple[float, ...]]] = defaultdict(list)
    named = _named_effects(recordings)
    for each in recordings:
        when = moment(each)
        if each.problem or when is None:
            continue
        day, warm = when.timestamp() / DAY, each.result.get("temperature")
        for quantity, value, deviation, limited in said(each, named[each.source.unit]):
            point = (day, value, deviation, float(limited), math.nan if warm is None else warm)
            points[each.source.unit, quantity].append(point)
    return [
        _course(name, quantity, units[quantity], found, nominal.get(quantity, 0.0))
        for (name, quantity), found in sorted(points.items())
    ]


def _course(name: str, quantity: str, unit: str, points: list[tuple[float, ...]], nominal: float) -> Course:
    time, value, deviation, limited, temperature = np.array(sorted(points), dtype=float).T
    return Course(name, quantity, unit, time, value, deviation, limited > 0.0, temperature, nominal)


def _named_effects(recordings: Sequence[Examined]) -> dict[str, set[str]]:
    """By unit, the effects that one of its diagnoses names."""
    named: dict[str, set[str]] = defaultdict(set)
    for each in recordings:
        for finding in each.result.get("findings", ()):
            if finding["kind"] == "effect":
                named[each.source.unit].add(finding["name"].partition(".")[0])
    return named


def said(each: Examined, effects: set[str]) -> Iterator[tuple[str, float, float, bool]]:
    """Quantity, value, standard deviation and whether it is only limited, as far as a recording tells.

    `effects` are those that some diagnosis of its unit names: of the others there is no course.
    """
    for name, found in each.measured.items():
        if found["determined"] and found["deviation"] > 0.0 and (is_strength(name) or "." not in name):
            yield name, found["value"], found["deviation"], False
    for finding in each.result["findings"]:
        effect, low, high = finding["name"].partition(".")[0], finding["low"], finding["high"]
        if finding["kind"] == "ruled_out" and effect in effects and high is not None and low is None:
            yield finding["name"], high / 2.0, high / math.sqrt(12.0), True


def is_strength(name: str) -> bool:
    """Whether a dotted name is that of an effect's strength."""
    effect, _, own = name.partition(".")
    return own != "" and own in EFFECT[effect].strength
