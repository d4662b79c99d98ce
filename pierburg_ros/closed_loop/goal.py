"""What a tuned controller has to reach, and by how much a response falls short of it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pierburg_ros.arrays import Signal
from pierburg_ros.closed_loop.course import STEPS
from pierburg_ros.closed_loop.metrics import Metrics, settled_band
from pierburg_ros.closed_loop.time_optimal import settling_bound
from pierburg_ros.plant import Model

Table = NDArray[np.float64]
QUANTITIES = ("settling", "overshoot", "steady_state_error", "hunting")


@dataclass(frozen=True)
class Goal:
    """Limits for the nominal plant, and by how much the other plants of the set may exceed them."""

    settling: float = 2.0  # times the time-optimal bound of the step
    overshoot: float = 0.02  # share of the step
    steady_state_error: float = math.radians(0.3)  # [rad]
    hunting: float = math.radians(0.15)  # [rad], peak to peak
    longer: float = 1.25  # other plants may settle this many times slower than the nominal one does
    wider: float = 2.0  # and miss the target by this many times more

    def nominal_limits(self, bounds: Signal) -> Table:
        """Limit of each quantity for each step on the nominal plant, shape (steps, 4).

        `bounds` [s] are the shortest possible settling times, shape (steps,).
        """
        return self.table(self.settling * bounds, self.steady_state_error)

    def other_limits(self, nominal_settling: Signal) -> Table:
        """The same for another plant, given how fast [s] the nominal one settled."""
        return self.table(self.longer * nominal_settling, self.wider * self.steady_state_error)

    def table(self, settling: Signal, steady_state_error: float) -> Table:
        """Limits in the order of QUANTITIES, shape (steps, 4)."""
        shared = np.array([self.overshoot, steady_state_error, self.hunting])
        return np.column_stack([settling, np.broadcast_to(shared, (settling.size, 3))])


def settling_bounds(nominal: Model, rate: float) -> Signal:
    """Shortest settling time [s] of each step, shape (steps,)."""
    return np.array(
        [
            settling_bound(nominal, step.start, step.target, settled_band(step.target - step.start), rate)
            for step in STEPS
        ]
    )


def values(metrics: Sequence[Metrics]) -> Table:
    """The quantities that the goal limits, shape (steps, 4)."""
    return np.array([[getattr(each, name) for name in QUANTITIES] for each in metrics])
