"""Whether a residual torque holds for data to which it was not fitted."""

from __future__ import annotations

import math
from concurrent.futures import Executor
from dataclasses import replace

import numpy as np

from pierburg_ros.diagnosis.remainder.left_out import BETTER, folds_of
from pierburg_ros.diagnosis.remainder.shape import Shape, fit_shape
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.run import Run


def confirmed(shape: Shape, data: Data, pool: Executor) -> bool:
    """Whether unseen data improve by a tenth with a `shape`: the validation samples, or recordings left out.

    Neighbouring blocks share what is peculiar to a recording. With several recordings, each part is left out once, and
    a shape is fitted to the others. The geometric mean of the gains on the parts left out counts.
    """
    if not data.several:
        return shape.after < BETTER * shape.before
    shapes = (fit_shape(_apart(*fold), [lambda _: shape.base], pool) for fold in folds_of(data))
    return float(np.mean([math.log(each.after / each.before) for each in shapes])) < math.log(BETTER)


def _apart(fitted: Data, left: Data) -> Data:
    """All samples of `fitted` for training, and all those of `left` for validation."""
    return replace(fitted, runs=(*(_only(run, True) for run in fitted.runs), *(_only(run, False) for run in left.runs)))


def _only(run: Run, trains: bool) -> Run:
    """`run` with samples that all train, or all validate."""
    train = np.full_like(run.train, trains)
    return replace(run.trained_on(train), validation=~train)
