"""Linear least squares with bounds: what columns leave of a signal, where each may be so strong and no stronger."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from pierburg_ros.arrays import Signal

Column = tuple[Signal, float, float]
"""A column, shape (samples,), and the least and the most of it; the most may be infinite."""
SLACK_WEIGHT = 1e3
"""How much a slack weighs beside a column of length 1. Derived: a bound then holds to a millionth."""


class Bounded:
    """Linear least squares of some columns, each within its bounds."""

    def __init__(self, columns: Sequence[Column]) -> None:
        matrix, low, high = (np.array([column[place] for column in columns]) for place in range(3))
        length = np.linalg.norm(matrix, axis=1)
        kept = length > 1e-9 * max(float(np.max(length)), 1e-300)
        self.basis, self.triangle = np.linalg.qr((matrix[kept] / length[kept, np.newaxis]).T)
        self.low, self.high = low[kept] * length[kept], high[kept] * length[kept]

    def residual(self, target: Signal) -> Signal:
        """What the columns leave of a `target`, shape (samples,)."""
        found = bounded(self.triangle, self.basis.T @ target, self.low, self.high)
        return np.asarray(target - self.basis @ (self.triangle @ found))


def bounded(triangle: Signal, target: Signal, low: Signal, high: Signal) -> Signal:
    """The coefficients between `low` and `high` with the least squares of triangle x - target.

    An upper bound is a slack that is not negative (Lawson and Hanson, Solving Least Squares Problems, 1974, chapter
    23).
    """
    from scipy.optimize import lsq_linear, nnls  # takes long to load, and only an audit or a balance needs it

    size, ends = low.size, np.flatnonzero(np.isfinite(high))
    slack = np.zeros((ends.size, size + ends.size))
    slack[np.arange(ends.size), ends] = slack[np.arange(ends.size), size + np.arange(ends.size)] = SLACK_WEIGHT
    known = np.vstack([np.hstack([triangle, np.zeros((triangle.shape[0], ends.size))]), slack])
    wanted = np.concatenate([target - triangle @ low, SLACK_WEIGHT * (high - low)[ends]])
    try:
        above, _ = nnls(known, wanted, maxiter=30 * known.shape[1])
    except RuntimeError:  # it turns in a circle
        return np.asarray(lsq_linear(triangle, target, (low, high)).x)
    return np.asarray(np.clip(low + above[:size], low, high))
