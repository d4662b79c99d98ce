"""An explanation and a quantity that wanders, fitted together."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np

from pierburg_ros.arrays import Flags, Signal
from pierburg_ros.diagnosis.disturbance.course import Course
from pierburg_ros.diagnosis.disturbance.slow import Slow
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.estimator import Estimator, Fit, forgiven
from pierburg_ros.inference.least_squares import BRIEF, FULL, minimise

BEGUN = 12
"""Iterations after which the search gives up a fit with too large a residual. Work: half of a whole fit. With six
iterations a true wander was given up once; not varied otherwise."""
HOPE = 4.0
"""Largest mean square of the residuals, large ones by their logarithm, with which such a fit goes on. Work: it is 0.9
at the end of a fit; fits that came there were below the limit after `BEGUN` iterations."""
FARTHEST = 4.0
"""Bound of a wander, in usual sizes. Chosen: no fit should reach this bound; not varied."""
ROUGHLY = 1e-3
"""Smallest share of its cost that an iteration must gain for the fit to go on. Work: later gains decide nothing."""
STEP = 0.02
"""Step of the finite differences, in usual sizes. Derived: 0.2 % of the supply, which moves the valve by its noise."""


@dataclass(frozen=True)
class Wandered:
    """The result of a joint fit: the values at the knots, and the error over the noise on training and validation
    samples."""

    course: Course
    values: Signal
    trained: float
    validated: float

    def kept_apart(self, data: Data) -> Data:
        """`data` in which the error that the course leaves counts as noise, and a residual of its size is no evidence.

        No course through a few knots is exact. Otherwise a small error of the course would be reported as a drift.
        """
        left = max(self.trained, self.validated, 1.0)
        return data.kept_apart(data.noise * float(np.sqrt(left**2 - 1.0)))


def wandered(data: Data, fit: Fit, slow: Slow, estimator: Estimator) -> Wandered:
    """The quantity's course beside the explanation of `fit`, both fitted to the training samples.

    At first large errors count by their logarithm, since a slip at the wrong moment displaces all that follows.
    """
    times = [each.time for each in data.runs]
    course = Course.over(float(times[0][0]), float(times[-1][-1]), data.scales.time)
    acting = [slow.simulated(run, course) for run in data.runs]
    coordinates, size = estimator.coordinates(fit.explanation), len(fit.explanation.names)
    train = data.train

    def left(point: Signal) -> Signal:
        model, _ = estimator.models(fit.explanation, coordinates.values(point[:size]))
        parts = [run.measured - each(model, point[size:]) for run, each in zip(data.runs, acting, strict=True)]
        return np.nan_to_num(np.concatenate(parts) / data.noise, nan=1e3, posinf=1e3, neginf=-1e3)

    def cost(point: Signal, forgiving: bool) -> Signal:
        residual = left(point)[train]
        own = course.cost(point[size:], slow.usual)
        return np.concatenate([forgiven(residual) if forgiving else residual, own])

    count = course.knots.size
    ends, far = coordinates.bounds, np.full(count, FARTHEST * slow.usual)
    lower, upper = np.concatenate([ends[0], -far]), np.concatenate([ends[1], far])
    steps = np.concatenate([coordinates.steps, np.full(count, STEP * slow.usual)])
    point = np.concatenate([coordinates.point(fit.values), np.zeros(count)])
    for forgiving, iterations in ((True, BEGUN), (True, FULL), (False, BRIEF)):
        point = minimise(partial(cost, forgiving=forgiving), point, lower, upper, steps, iterations, ROUGHLY).point
        if np.mean(np.square(forgiven(left(point)[train]))) > HOPE:
            break
    residual = left(point)
    return Wandered(course, point[size:], _rms(residual, train), _rms(residual, data.validation))


def _rms(residual: Signal, samples: Flags) -> float:
    return float(np.sqrt(np.mean(np.square(residual[samples])))) if np.any(samples) else 0.0
