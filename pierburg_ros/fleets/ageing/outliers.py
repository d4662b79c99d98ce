"""Which units differ from the rest of the fleet."""

from __future__ import annotations

import numpy as np
from scipy import stats

from pierburg_ros.arrays import Signal

FEWEST_UNITS = 6
"""Units from which on one can differ from the others. Chosen: of five others the middle half is three; not varied."""
NORMAL = 1.4826
"""Standard deviation of a normal distribution over its median absolute deviation. Derived: 1 over its 75 % quantile."""


def differences(levels: Signal, deviations: Signal) -> tuple[Signal, Signal]:
    """How many deviations each unit lies from the middle of the others, and how often chance puts it as far.

    `levels` and their `deviations` have the shape (units,). Middle and spread of the others are their median and median
    absolute deviation, so that several units that differ do not hide each other; Student's t with as many degrees of
    freedom as a median of so many has (its efficiency, 0.64, times their number). NaN where there are too few.
    """
    nothing = np.full(levels.size, np.nan)
    if levels.size < FEWEST_UNITS:
        return nothing, nothing
    away = np.empty(levels.size)
    for number in range(levels.size):
        others = np.delete(levels, number)
        middle = float(np.median(others))
        spread = NORMAL * float(np.median(np.abs(others - middle)))
        inner = float(np.median(np.delete(deviations, number))) ** 2
        width = np.sqrt(max(spread**2, inner) * (1.0 + np.pi / (2.0 * others.size)) + deviations[number] ** 2)
        away[number] = (levels[number] - middle) / width
    freedom = max(0.64 * (levels.size - 1) - 1.0, 1.0)
    return away, np.asarray(2.0 * stats.t.sf(np.abs(away), freedom))
