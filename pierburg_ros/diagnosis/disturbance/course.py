"""How a quantity wanders slowly: a cubic spline through knots, smooth unless the recording says otherwise."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from pierburg_ros.arrays import Signal

SPACING = 21.0
"""Time between knots, in the actuator's own time. Derived: 2 s for the valve; a sine of a period of 12 s is then met to
0.4 % of its amplitude, and the blocks that validate, 1.5 s, are seen from either side."""
BEND = 0.03
"""Change of the slope from knot to knot that costs as much as one noise, in sizes that are usual. Chosen: so slow a
wander is not held back by it where thousands of samples speak for it; not varied."""


@dataclass(frozen=True)
class Course:
    """Knots over the time of a recording [s], shape (knots,); the values there are what a fit moves."""

    knots: Signal

    @staticmethod
    def over(start: float, end: float, own_time: float) -> Course:
        """Knots from `start` to `end` [s] for an actuator of an `own_time` [s]."""
        count = max(math.ceil((end - start) / (SPACING * own_time)), 3) + 1
        return Course(np.linspace(start, end, count))

    def basis(self, time: Signal) -> Signal:
        """What each knot adds at `time` [s], shape (times, knots); constant beyond the ends."""
        spline = CubicSpline(self.knots, np.eye(self.knots.size), bc_type="natural")
        return np.asarray(spline(np.clip(time, self.knots[0], self.knots[-1])))

    def cost(self, values: Signal, usual: float) -> Signal:
        """What `values` at the knots cost as residuals [noise], by their size and their bends."""
        return np.concatenate([values / usual, np.diff(values, 2) / (BEND * usual)])
