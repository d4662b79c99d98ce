"""A step in a course, as a repair or a refit makes it: where it is dated, and on what evidence."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pierburg_ros.fleets.ageing.course import Course
from pierburg_ros.fleets.ageing.regression import Regression, regression
from pierburg_ros.fleets.ageing.trend import columns

EITHER_SIDE = 2
"""Recordings that a step must have before and after it. Derived: one alone may be an outlier."""
RISE = 3.841
"""Rise of the weighted squares up to which another moment is possible. Derived: the 95 % quantile of chi2 with one
degree of freedom."""
BEYOND_CURVE = 4.0
"""What a step must gain in weighted squares over a parabola. Derived: two standard deviations, since both have one
number beside a line."""


@dataclass(frozen=True)
class Step:
    """A jump by `size` between two recordings, `after` and `before` these times [days since 1970].

    `first` and `last` hold the moment with 95 %. `chance`: how often a course without a step shows as much anywhere.
    """

    after: float
    before: float
    first: float
    last: float
    size: float
    interval: tuple[float, float]
    chance: float

    @property
    def time(self) -> float:
        """Middle of the gap in which it lies [days since 1970]."""
        return 0.5 * (self.after + self.before)


def step(course: Course) -> Step | None:
    """The clearest step beside a line; None where no moment has recordings enough on either side.

    Every gap between two recordings is tried: with the scatter about a line, then with that about the best step. The
    chance is that of the best gap times the number of gaps (Bonferroni): cautious, since neighbouring gaps are alike.
    """
    moments, straight = gaps(course), regression(columns(course)[0], course.value, course.deviation)
    tried = steps_at(course, moments, 0.0 if straight is None else straight.scatter)
    if not tried:
        return None
    own = fitted(course, min(tried, key=lambda each: each[0].squares)[1])
    again = [] if own is None else steps_at(course, moments, own.scatter)
    if not again:
        return None
    best, moment = min(again, key=lambda each: each[0].squares)
    own = fitted(course, moment)
    if own is None or curve_squares(course, best.scatter) < best.squares + BEYOND_CURVE:
        return None
    allowed = [when for found, when in again if found.squares <= best.squares + RISE]
    place = int(np.searchsorted(course.time, moment))
    first = int(np.searchsorted(course.time, min(allowed)))
    return Step(
        after=float(course.time[place - 1]),
        before=float(course.time[place]),
        first=float(course.time[first - 1]),
        last=float(max(allowed)),
        size=float(own.coefficients[-1]),
        interval=own.interval(own.coefficients.size - 1),
        chance=min(own.chance(own.coefficients.size - 1) * len(moments), 1.0),
    )


def gaps(course: Course) -> list[float]:
    """Times [days] of the recordings before which a step may lie."""
    inside = course.time[EITHER_SIDE : course.size - EITHER_SIDE + 1]
    before = course.time[EITHER_SIDE - 1 : course.size - EITHER_SIDE]
    return [float(time) for time, last in zip(inside, before, strict=True) if time > last]


def steps_at(course: Course, moments: list[float], scatter: float) -> list[tuple[Regression, float]]:
    """The regressions with a step at each of some moments [days] that can be told, with this `scatter`."""
    found = [(fitted(course, moment, scatter), moment) for moment in moments]
    return [(each, moment) for each, moment in found if each is not None]


def fitted(course: Course, moment: float, scatter: float | None = None) -> Regression | None:
    """The regression with a step before the recording at a `moment` [days], its last column."""
    made, _ = columns(course, (moment,))
    return regression(made, course.value, course.deviation, scatter)


def curve_squares(course: Course, scatter: float) -> float:
    """Weighted squares that a parabola leaves; infinite where there is none."""
    made, _ = columns(course)
    found = regression(np.column_stack([made, made[:, 1] ** 2]), course.value, course.deviation, scatter)
    return np.inf if found is None else found.squares
