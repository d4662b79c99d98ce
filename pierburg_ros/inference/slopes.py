"""The slopes of a residual at a fit, accurate enough for a covariance."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from pierburg_ros.arrays import Signal

FINE = 1e-5
"""Difference step of a covariance, in the coordinates of the search. Derived: within the interval of any value known to
0.01 %, with a rounding error of about 1e-11 of the residual."""
FINEST_STEP = 1e-7
"""Difference step where a bend lies within the fine one. Chosen: a hundredth of it; simulations of the stiffer effects
are too noisy to begin with it. Not varied."""
SMOOTH = 1e-4
"""Largest relative difference between forward and central slopes where the residual is smooth. Derived: ten times the
step `FINE`, which a curvature of order ten makes."""
WEAK = 0.05
"""Standard deviation of a coordinate by its own slope, beyond which jumps may still determine it. Chosen: 5 % of a
parameter, above what identification calls known; not varied."""
JUMPS = (1e-4, 1e-3, 5e-3)
"""Steps tried, finest first, for a quantity that acts in jumps. Chosen: its interval is then at least as wide as the
first step that shows a jump, 0.01 %; not varied."""

Residual = Callable[[Signal], Signal]
Bounds = tuple[Signal, Signal]


def sharp(residual: Residual, point: Signal, bounds: Bounds) -> Signal:
    """Derivative of `residual`, shape (samples, quantities), each column by the step with the least bend.

    A shaft that only just breaks loose bends the residual, and fits tend to end on such a bend. Columns across the bend
    are inconsistent: an exact tie of parameters would look as if the recording broke it.
    """
    value = residual(point)
    slopes, bend = _bend(residual, point, value, bounds, FINE)
    if np.any(bend > SMOOTH):
        closer, less = _bend(residual, point, value, bounds, FINEST_STEP)
        slopes = np.where(less < bend, closer, slopes)
    noise = float(np.linalg.norm(value)) / np.sqrt(value.size)
    for index in np.flatnonzero(np.linalg.norm(slopes, axis=0) * WEAK < noise).tolist():
        slopes[:, index] = _across_jumps(residual, point, bounds, index, slopes[:, index], noise)
    return slopes


def _across_jumps(
    residual: Residual, point: Signal, bounds: Bounds, index: int, column: Signal, noise: float
) -> Signal:
    """The column of a quantity that acts in jumps, as when the shaft breaks loose a sample later; shape (samples,).

    It is taken with the finest step that shows jumps. Its length is limited so that the standard deviation is no less
    than this step.
    """
    for step in JUMPS:
        offset = step * np.eye(point.size)[index]
        high, low = np.minimum(point + offset, bounds[1]), np.maximum(point - offset, bounds[0])
        jumps = (residual(high) - residual(low)) / max(float((high - low)[index]), 1e-300)
        length = float(np.linalg.norm(jumps))
        if length * step > noise:
            return np.asarray(jumps * noise / (length * step))
    return column


def _bend(residual: Residual, point: Signal, middle: Signal, bounds: Bounds, step: float) -> tuple[Signal, Signal]:
    """The central slopes at `point`, and for each column the relative distance of the forward slopes from them."""
    ahead, behind = (np.clip(point + sign * step * np.eye(point.size), *bounds) for sign in (1.0, -1.0))
    after, before = (np.stack([residual(there) for there in side], axis=1) for side in (ahead, behind))
    width = np.maximum(np.diagonal(ahead - behind), 1e-300)
    forward = np.maximum(np.diagonal(ahead) - point, 1e-300)
    slopes, one_sided = (after - before) / width, (after - middle[:, None]) / forward
    length = np.maximum(np.linalg.norm(slopes, axis=0), 1e-300)
    return slopes, np.linalg.norm(one_sided - slopes, axis=0) / length
