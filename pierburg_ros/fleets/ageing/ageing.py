"""The ageing of a fleet: trend, step, forecast of every quantity of every unit, and how unlike the rest it is."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from pierburg_ros.fleets.ageing.course import Course
from pierburg_ros.fleets.ageing.discovery import FALSE, discovery_rates
from pierburg_ros.fleets.ageing.forecast import Forecast, forecast
from pierburg_ros.fleets.ageing.outliers import differences
from pierburg_ros.fleets.ageing.step import Step, step
from pierburg_ros.fleets.ageing.trend import Line, line


@dataclass(frozen=True)
class Ageing:
    """What is known of one quantity of one unit.

    Rates are the least false discovery rates, over all units and quantities, at which a finding is believed; None where
    it could not be sought. `away` is how many deviations the unit lies from the middle of the others.
    """

    course: Course
    line: Line | None
    trend_rate: float | None
    step: Step | None
    step_rate: float | None
    forecast: Forecast | None
    away: float | None
    away_rate: float | None

    @property
    def changes(self) -> bool:
        """Whether its trend is believed."""
        return self.trend_rate is not None and self.trend_rate <= FALSE

    @property
    def stepped(self) -> bool:
        """Whether its step is believed."""
        return self.step_rate is not None and self.step_rate <= FALSE

    @property
    def differs(self) -> bool:
        """Whether it is believed to differ from the rest of the fleet."""
        return self.away_rate is not None and self.away_rate <= FALSE

    @property
    def level(self) -> tuple[float, float]:
        """Its value at the end of its course and its standard deviation; without a line the last value."""
        if self.line is None:
            return float(self.course.value[-1]), float(self.course.deviation[-1])
        return self.line.at(float(self.course.time[-1]))

    @property
    def change(self) -> float:
        """Change by its trend over the time of its course, as a share of its size there; 0 without a line."""
        return 0.0 if self.line is None else self.share(self.line.slope * float(np.ptp(self.course.time)))

    def share(self, change: float) -> float:
        """A change in its unit as a share of its nominal value, or of its largest where that is more."""
        return change / max(abs(self.course.nominal), float(np.max(np.abs(self.course.value))), 1e-300)


def ageing(courses: Sequence[Course], limits: Mapping[str, float], now: float) -> list[Ageing]:
    """What is known of all `courses`; `limits` by quantity, `now` [days since 1970] is when forecasts begin."""
    steps = [step(course) for course in courses]
    step_rates = _rates([None if each is None else each.chance for each in steps])
    believed = [rate is not None and rate <= FALSE for rate in step_rates]
    lines = [
        line(course, (found.before,) if found and believes else ())
        for course, found, believes in zip(courses, steps, believed, strict=True)
    ]
    rates = _rates([None if each is None else each.chance for each in lines])
    known = [
        Ageing(course, own, rate, found, step_rate, _forecast(course, own, limits, now), None, None)
        for course, own, rate, found, step_rate in zip(courses, lines, rates, steps, step_rates, strict=True)
    ]
    return list(_beside_the_rest(known))


def _forecast(course: Course, own: Line | None, limits: Mapping[str, float], now: float) -> Forecast | None:
    if own is None or course.quantity not in limits:
        return None
    return forecast(own, limits[course.quantity], float(course.time[0]), now)


def _rates(chances: Sequence[float | None]) -> list[float | None]:
    """False discovery rates of the tests that were made, None for the others."""
    made = [place for place, chance in enumerate(chances) if chance is not None]
    rates: list[float | None] = [None] * len(chances)
    found = discovery_rates(np.array([chances[place] for place in made], dtype=float))
    for place, rate in zip(made, found, strict=True):
        rates[place] = float(rate)
    return rates


def _beside_the_rest(known: Sequence[Ageing]) -> Iterator[Ageing]:
    """The same with how unlike the rest each unit is, quantity by quantity."""
    away: dict[int, float] = {}
    chances: list[float | None] = [None] * len(known)
    for quantity in {each.course.quantity for each in known}:
        places = [place for place, each in enumerate(known) if each.course.quantity == quantity]
        levels, deviations = np.array([known[place].level for place in places]).T
        far, chance = differences(levels, deviations)
        for place, own, probability in zip(places, far, chance, strict=True):
            if np.isfinite(probability):
                away[place], chances[place] = float(own), float(probability)
    for place, (each, rate) in enumerate(zip(known, _rates(chances), strict=True)):
        yield Ageing(
            each.course,
            each.line,
            each.trend_rate,
            each.step,
            each.step_rate,
            each.forecast,
            away.get(place),
            rate,
        )
