"""The steps a controller is judged by.

Steps of 5, 20, 50 and 80 degrees about mid-travel, opening and closing, each from a start that the shaft has
reached by opening, and again by closing: friction holds it with the duty that the last movement left, and a step
that turns round has to cross the friction band first. Steps of 5 and 20 degrees away from the closed stop, the first
one after a start and again one after a movement, and back onto it. Every step is a run of its own, which begins with
the valve closed and a controller without a past.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pierburg_ros.closed_loop.loop import Run
from pierburg_ros.closed_loop.metrics import Metrics, step_metrics

SIZES = (5.0, 20.0, 50.0, 80.0)  # about mid-travel [degrees]
STOP_SIZES = (5.0, 20.0)  # from the closed stop and back [degrees]
CENTRE = 45.0  # of the steps about mid-travel [degrees]
APPROACH = 10.0  # where the shaft arrives from, this far away from the start [degrees]
LOWEST, HIGHEST = 0.0, 90.0  # the stops [degrees]
WAYS = 2  # of making each step; they are neighbours in STEPS


@dataclass(frozen=True)
class Step:
    """A step from `start` to `target`, the start reached from `before`; all [rad]."""

    before: float
    start: float
    target: float

    @property
    def opens(self) -> bool:
        """Whether the step opens the valve."""
        return self.target > self.start

    @property
    def at_stop(self) -> bool:
        """Whether it begins or ends at the closed stop."""
        return LOWEST in (self.start, self.target)

    @property
    def label(self) -> str:
        """Size and direction for people."""
        way = "opening" if self.opens else "closing"
        place = (" from the stop" if self.opens else " onto the stop") if self.at_stop else ""
        return f"{abs(math.degrees(self.target - self.start)):.0f}° {way}{place}"


def ways(size: float, opening: bool, centre: float = CENTRE) -> Iterator[Step]:
    """The two ways of making a step of `size` about `centre` [degrees]."""
    low, high = centre - size / 2.0, centre + size / 2.0
    start, target = (low, high) if opening else (high, low)
    yield between(max(start - APPROACH, LOWEST), start, target)
    yield between(min(start + APPROACH, HIGHEST), start, target)


def between(*degrees: float) -> Step:
    """A step given in degrees."""
    return Step(*map(math.radians, degrees))


STEPS = (
    *(step for size in SIZES for opening in (True, False) for step in ways(size, opening)),
    *(step for size in STOP_SIZES for opening in (True, False) for step in ways(size, opening, size / 2.0)),
)


@dataclass(frozen=True)
class Course:
    """How long a step's run takes: to arrive before the start, to rest at it, to watch the response [s]."""

    approach: float = 1.0
    hold: float = 1.5
    watch: float = 5.0

    def setpoints(self, rate: float) -> NDArray[np.float64]:
        """Setpoints [rad] of all runs at `rate` [Hz], shape (steps, samples)."""
        samples = [round(duration * rate) for duration in (self.approach, self.hold, self.watch)]
        return np.array([np.repeat([step.before, step.start, step.target], samples) for step in STEPS])

    def metrics(self, run: Run) -> list[Metrics]:
        """The response to each step, from a run over each row of these setpoints."""
        period = float(run.time[1])
        first = round(self.approach / period) + round(self.hold / period)
        return [
            step_metrics(step.start, step.target, angle[first:], duty[first:], period)
            for step, angle, duty in zip(STEPS, run.angle, run.duty, strict=True)
        ]
