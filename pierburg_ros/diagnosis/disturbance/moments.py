"""Refinement of two times in a recording: when a bridge opened and closed, or by how much an input comes late."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.optimize import minimize

from pierburg_ros.arrays import Signal
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.estimator import forgiven
from pierburg_ros.estimation.run import Run
from pierburg_ros.plant import Model

EXACT = 1e-3
"""Tolerance of the two times, in the actuator's own time. Derived: 0.1 ms for the valve, whose shaft moves by a
thousandth of its travel in that time, less than usual noise."""
TRIALS = 200
"""Largest number of simulations in which they are refined. Work: six open bridges took 43 to 128, five clocks 34 to 37;
not varied."""


def squared_error(data: Data, model: Model, applied: Callable[[Run], Run]) -> Signal:
    """Squared error [noise^2] of each sample with a disturbance `applied`, shape (samples,); large ones by their
    logarithm."""
    disturbed = data.changed(applied)
    return np.asarray(np.square(forgiven(disturbed.residual(model))))


def exact(cost: Callable[[Signal], float], about: Signal, step: float, own_time: float) -> tuple[Signal, float]:
    """The two times [s] of lowest `cost` near those `about`, searched with a first `step` [s], and that cost."""
    around = about + step * np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    options = {"initial_simplex": around, "xatol": EXACT * own_time, "fatol": 1.0, "maxfev": TRIALS}
    found = minimize(cost, about, method="Nelder-Mead", options=options)
    return found.x, float(found.fun)
