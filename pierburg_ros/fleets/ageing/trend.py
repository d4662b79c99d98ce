"""How a quantity changes with time, beside steps and beside the temperature of its recordings."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pierburg_ros.arrays import Flags, Signal
from pierburg_ros.fleets.ageing.course import Course
from pierburg_ros.fleets.ageing.regression import Regression, regression

FEWEST_RECORDINGS = 4
"""Recordings from which on a trend is sought. Derived: a line has two numbers, and two more are the least that tell
their scatter."""
COVARIATE = 6
"""Recordings from which on the temperature is a column of the regression. Derived: as above, with one more number, and
one to spare; not varied."""
WARMED = 2.0
"""Standard deviation [K] of the temperatures from which on they are a column. Chosen: copper then changes by 0.8 %; not
varied."""


@dataclass(frozen=True)
class Line:
    """A straight line over time with the steps taken out, of one course.

    Columns of `found`: value at the `middle` of time and temperature, change a day, change a kelvin (if `warm`), then
    one step a column.
    """

    found: Regression
    middle: float
    warm: bool

    @property
    def slope(self) -> float:
        """Change a day."""
        return float(self.found.coefficients[1])

    @property
    def interval(self) -> tuple[float, float]:
        """95 % interval of the change a day."""
        return self.found.interval(1)

    @property
    def chance(self) -> float:
        """How often a quantity that does not change shows as much."""
        return self.found.chance(1)

    def at(self, day: float) -> tuple[float, float]:
        """Value on a `day` after all steps, at the mean temperature, and its standard deviation."""
        steps = self.found.coefficients.size - 2 - self.warm
        return self.found.at(np.array([1.0, day - self.middle, *[0.0] * self.warm, *[1.0] * steps]))


def columns(course: Course, steps: tuple[float, ...] = ()) -> tuple[Signal, bool]:
    """The columns of the regression of a course, shape (recordings, columns), and whether temperature is one."""
    warm = warms(course)
    parts: list[Signal | Flags] = [np.ones(course.size), course.time - course.time.mean()]
    if warm:
        filled = np.where(np.isnan(course.temperature), np.nanmean(course.temperature), course.temperature)
        parts.append(filled - filled.mean())
    return np.column_stack([*parts, *(course.time >= step for step in steps)]).astype(float), warm


def warms(course: Course) -> bool:
    """Whether temperatures are known, vary enough, and there are recordings enough to tell them from time."""
    known = course.temperature[~np.isnan(course.temperature)]
    return bool(course.size >= COVARIATE and known.size >= 0.8 * course.size and np.std(known) >= WARMED)


def line(course: Course, steps: tuple[float, ...] = ()) -> Line | None:
    """The line of a course with `steps` at these times [days]; None where there are too few recordings to tell."""
    if course.size < FEWEST_RECORDINGS + len(steps) or np.ptp(course.time) == 0.0:
        return None
    made, warm = columns(course, steps)
    found = regression(made, course.value, course.deviation)
    return None if found is None else Line(found, float(course.time.mean()), warm)
