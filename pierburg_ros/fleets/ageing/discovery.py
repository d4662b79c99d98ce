"""Which of many tests to believe: those among which no more than a stated share is false."""

from __future__ import annotations

import numpy as np

from pierburg_ros.arrays import Signal

FALSE = 0.05
"""Share of the findings of one kind, over all units and quantities, that may be false. Given: the usual twentieth."""


def discovery_rates(chances: Signal) -> Signal:
    """For each test the least false discovery rate at which it is believed, shape (tests,).

    Y. Benjamini and Y. Hochberg, Controlling the false discovery rate, J. R. Statist. Soc. B 57 (1995) 289-300.
    """
    chances = np.asarray(chances, dtype=float)
    order = np.argsort(chances)
    rates = chances[order] * chances.size / np.arange(1, chances.size + 1)
    least = np.minimum.accumulate(rates[::-1])[::-1]
    found = np.empty_like(chances)
    found[order] = np.minimum(least, 1.0)
    return found
