"""When a stated limit is reached, if all goes on as before."""

from __future__ import annotations

import math
from dataclasses import dataclass

from pierburg_ros.fleets.ageing.trend import Line


@dataclass(frozen=True)
class Forecast:
    """When a quantity reaches `limit`: `time` and 95 % interval [days since 1970].

    `time` is None where it moves away from the limit; `last` is infinite where it may never be reached. `reached`: it
    is beyond the limit already, seen from where it began.
    """

    limit: float
    time: float | None
    first: float
    last: float
    reached: bool


def forecast(line: Line, limit: float, begin: float, now: float) -> Forecast:
    """When the `line` meets `limit`, for a course from `begin` to `now` [days since 1970].

    The interval holds the days on which the mean may be at the limit (E. C. Fieller, Some problems in interval
    estimation, J. R. Statist. Soc. B 16 (1954) 175-185), from `now` on.
    """
    value, _ = line.at(now)
    start, _ = line.at(begin)
    reached = (value - limit) * (start - limit) <= 0.0 and abs(value - limit) > 0.0
    time = now + (limit - value) / line.slope if line.slope else math.inf
    ends = [end for end in crossings(line, limit, now) if end > now]
    within = abs(value - limit) <= line.found.quantile * line.at(now)[1]
    towards = time >= now or within or reached
    first = now if within or reached else min(ends, default=math.inf)
    last = _last(line, limit, now, ends, within) if not reached else now
    return Forecast(limit, time if towards and math.isfinite(time) else None, first, last, reached)


def crossings(line: Line, limit: float, now: float) -> list[float]:
    """Days on which an end of the interval of the mean is at the limit, the earliest first."""
    value, deviation = line.at(now)
    later, more = line.at(now + 1.0)
    covariance = 0.5 * (more**2 - deviation**2 - float(line.found.covariance[1, 1]))
    square = line.found.quantile**2
    a = line.slope**2 - square * float(line.found.covariance[1, 1])
    b = (later - value) * (value - limit) - square * covariance
    c = (value - limit) ** 2 - square * deviation**2
    inside = b**2 - a * c
    if inside < 0.0 or a == 0.0:
        return []
    root = math.sqrt(inside)
    return sorted(now + (-b + side * root) / a for side in (-1.0, 1.0))


def _last(line: Line, limit: float, now: float, ends: list[float], within: bool) -> float:
    """The latest day on which the limit may be reached; infinite where the slope may be none or away from it."""
    low, high = line.interval
    sure = low > 0.0 if line.at(now)[0] < limit else high < 0.0
    return max(ends) if ends and (sure or within) and low * high > 0.0 else math.inf
