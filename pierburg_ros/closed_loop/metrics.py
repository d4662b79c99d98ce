"""How good a step response was, judged on the true shaft angle."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pierburg_ros.arrays import Signal

BAND_SHARE = 0.02  # settled: within this share of the step,
BAND_LEAST = math.radians(0.3)  # but no closer than this [rad]
LATE_SHARE = 0.6  # standstill is judged over this last part of the response: 3 of 5 s


@dataclass(frozen=True)
class Metrics:
    """One step response in numbers."""

    rise: float  # from 10 % to 90 % of the step [s]
    settling: float  # until it stays in the band [s]; the length of the response if it never does
    overshoot: float  # beyond the target, as a share of the step [1]
    steady_state_error: float  # mean distance from the target while late [rad]
    absolute_error: float  # integral of the absolute error [rad.s]
    effort: float  # integral of the squared duty [s]
    hunting: float  # peak to peak while late [rad]


def settled_band(step: float) -> float:
    """Half width [rad] of the band in which a step [rad] counts as settled."""
    return max(BAND_SHARE * abs(step), BAND_LEAST)


def step_metrics(start: float, target: float, angle: Signal, duty: Signal, period: float) -> Metrics:
    """The response to a step from `start` to `target` [rad].

    `angle` [rad] and `duty` [1] are sampled every `period` [s], the first sample at the step.
    """
    step = target - start
    error = target - angle
    progress = 1.0 - error / step
    late = angle[-round(LATE_SHARE * angle.size) :]
    outside = np.flatnonzero(np.abs(error) > settled_band(step))
    return Metrics(
        rise=(first(progress >= 0.9) - first(progress >= 0.1)) * period,
        settling=(outside[-1] + 1) * period if outside.size else 0.0,
        overshoot=max(float(progress.max()) - 1.0, 0.0),
        steady_state_error=float(np.abs(target - late).mean()),
        absolute_error=float(np.abs(error).sum()) * period,
        effort=float(duty @ duty) * period,
        hunting=float(late.max() - late.min()),
    )


def first(passed: NDArray[np.bool_]) -> int:
    """Index of the first true entry, or the length if there is none."""
    return int(passed.argmax()) if passed.any() else passed.size
