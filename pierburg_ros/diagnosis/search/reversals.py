"""Play of the sensor, read from its signal around reversals: no simulation has to reverse at the right time.

While the shaft moves, the signal of a sensor with play lags behind by half the play. So the error of a model is the sum
of a smooth error and half the play times the direction. At a reversal it steps by the play, and until the play is used
up the sensor says nothing. A rest that friction causes at a reversal leaves no step: the shaft goes on from where it
stood. Half the direction is a column of a linear regression with the discrepancy.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from pierburg_ros.arrays import Flags, Signal
from pierburg_ros.diagnosis.search.candidates import possible
from pierburg_ros.effects import Effect
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.discrepancy import Kalman, evidence, share, way
from pierburg_ros.estimation.estimator import Fit
from pierburg_ros.inference.explanation import Variant

TURNED = 4.0
"""Movement back, in standard deviations of the noise, that counts as a reversal. Derived: white noise goes so far with
a probability of 6e-5."""


@dataclass(frozen=True)
class Play:
    """A play of the sensor as a fixed effect, its `gain` in -2 log likelihood, and the misfit `left` above noise."""

    variant: Variant
    gain: float
    left: float


def play_at_reversals(data: Data, fit: Fit) -> Play | None:
    """The play that the residual of a fit shows; None if it shows none, none can be added, or nothing reverses."""
    effect = _of_the_sensor(data)
    if effect is None or effect.id in fit.explanation.effects or effect.acts(fit.model.values):
        return None
    parts = [directions(run.measured, TURNED * data.noise) for run in data.runs]
    # at rest the shaft may stand anywhere within the play
    moves = np.concatenate([way(run.measured / data.noise) > 0.0 for run in data.runs])
    half = 0.5 * np.concatenate([part for part, _ in parts])
    moving = moves & np.concatenate([told for _, told in parts])
    train = moving & data.train
    if not train.any() or np.ptp(half[train]) == 0.0:
        return None
    kalman, residual = Kalman(data, train), data.residual(fit.model, fit.switch)
    filtered = kalman.filtered(kalman.most_likely(residual, half))
    width = -share(filtered, residual, half)
    if width <= 0.0:
        return None
    left = filtered(residual + width * half)
    # the innovations are not always as small as those of white noise
    rough = max(float(left @ left) / left.size, 1.0)
    gain = (evidence(filtered, residual) - evidence(filtered, residual + width * half)) / rough
    own = abs(data.angle_per_unit) * data.noise * width
    assert effect.play is not None
    return Play(Variant(effect.id, (), ((effect.play, own),)), gain, (rough - 1.0) * left.size)


def directions(measured: Signal, turned: float) -> tuple[Signal, Flags]:
    """Direction of the shaft (-1 or 1; 0 if it never moves), and where it is known to move; both of shape (samples,).

    A reversal is a movement back by more than `turned` [measured unit]. Within `turned` of the turning point, the
    direction is not known.
    """
    direction, told = np.zeros(measured.size), np.ones(measured.size, dtype=bool)
    for start, point, end, before in _turns(measured, turned):
        direction[point:] = -before
        told[start:end] = False
    return direction, told & (direction != 0.0)


def _turns(measured: Signal, turned: float) -> Iterator[tuple[int, int, int, float]]:
    """For each turning point: the samples where it is approached, reached and left, and the direction before it."""
    direction, extreme = 0.0, 0
    for k in range(measured.size):
        ahead = measured[k] - measured[extreme]
        if direction == 0.0:
            if abs(ahead) > turned:
                direction = float(np.sign(ahead))
                yield 0, 0, k, -direction
                extreme = k
        elif ahead * direction >= 0.0:
            extreme = k if ahead != 0.0 else extreme
        elif abs(ahead) > turned:
            start = extreme
            while start > 0 and abs(measured[start - 1] - measured[extreme]) <= turned:
                start -= 1
            yield start, extreme, k, direction
            direction, extreme = -direction, k


def _of_the_sensor(data: Data) -> Effect | None:
    """The effect that is a free play between shaft and sensor; None if there is none."""
    plays = (each for each in possible(data.actuator) if each.play is not None and each.stage == "sensor")
    return next(plays, None)
