"""The course of a quantity that wanders slowly: a cubic spline through knots, smooth unless the recording
contradicts."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from pierburg_ros.arrays import Signal

SPACING = 21.0
"""Time between knots, in the actuator's own time. Derived: 2 s for the valve. A sine with a period of 12 s is then
fitted to 0.4 % of its amplitude, and a validation block, 1.5 s, is constrained from both sides."""
BEND = 0.03
"""Change of slope from knot to knot that costs as much as one standard deviation of the noise, in usual sizes. Chosen:
it does not hold back so slow a wander where thousands of samples support it; not varied."""


@dataclass(frozen=True)
class Course:
    """Knots over the time of a recording [s], shape (knots,); a fit moves the values at them."""

    knots: Signal

    @staticmethod
    def over(start: float, end: float, own_time: float) -> Course:
        """Knots from `start` to `end` [s] for an actuator of an `own_time` [s]."""
        count = max(math.ceil((end - start) / (SPACING * own_time)), 3) + 1
        return Course(np.linspace(start, end, count))

    def basis(self, time: Signal) -> Signal:
        """The contribution of each knot at `time` [s], shape (times, knots); constant beyond the ends."""
        spline = CubicSpline(self.knots, np.eye(self.knots.size), bc_type="natural")
        return np.asarray(spline(np.clip(time, self.knots[0], self.knots[-1])))

    def cost(self, values: Signal, usual: float) -> Signal:
        """The cost of `values` at the knots as residuals [noise]: by their size and by their change of slope."""
        return np.concatenate([values / usual, np.diff(values, 2) / (BEND * usual)])
