"""Duty against settled angle, opening and closing: the paper's Fig. 3, D_c and D_pre by equation (9)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import stats

from pierburg_ros.actuators import Actuator
from pierburg_ros.identification.paper.holds import Settled, angle_noise, holds, moving, settled
from pierburg_ros.recording import Recording

SMALLEST = 1e-9
"""Smallest standard deviation of a settled angle, as a share of the largest angle. Derived: a simulation without noise
is rounded by no more."""
ANGLES_OF_BRANCH = 3
"""Number of settled angles that each branch needs. Derived: two fix a line, one more says whether it is one."""


@dataclass(frozen=True)
class Estimate:
    """A value with its 95 % interval."""

    value: float
    ci95: tuple[float, float]


@dataclass(frozen=True)
class StaticCharacteristic:
    """angle = gain (duty - D_pre - direction D_c) between the stops; it was fitted to `points`.

    `gain` [rad], `coulomb_duty` D_c [1], `preload_duty` D_pre [1], `scatter` of the points [rad], and the
    `time_constant` [s] with which the shaft approaches them.
    """

    gain: Estimate
    coulomb_duty: Estimate
    preload_duty: Estimate
    points: tuple[Settled, ...]
    scatter: float
    time_constant: float

    def angle(self, duty: float, direction: int) -> float:
        """Settled angle [rad] at `duty` [1] on the branch of `direction`, also beyond the stops."""
        return self.gain.value * (duty - self.preload_duty.value - direction * self.coulomb_duty.value)


def static_characteristic(recordings: Sequence[Recording], actuator: Actuator) -> StaticCharacteristic | None:
    """The static characteristic from all stretches of constant duty; None without a spring or with too few angles."""
    scales = actuator.scales
    found = [
        hold
        for recording in recordings
        for hold in moving(holds(recording, actuator), angle_noise(recording, actuator), scales)
    ]
    if actuator.load != "spring" or not found:
        return None
    points, time_constant = settled(found, scales)
    opening = sum(point.direction > 0 for point in points)
    if min(opening, len(points) - opening) < ANGLES_OF_BRANCH:
        return None
    return _line(points, time_constant)


def _line(points: list[Settled], time_constant: float) -> StaticCharacteristic:
    duty, angle, direction, doubt = np.array([(p.duty, p.angle, p.direction, p.doubt) for p in points]).T
    weight = 1.0 / np.maximum([p.deviation for p in points], SMALLEST * np.max(np.abs(angle)))
    plain = np.column_stack([duty, np.ones(duty.size), direction])
    columns = plain * weight[:, None]
    coefficients, common = np.linalg.lstsq(columns, np.column_stack([angle, doubt]) * weight[:, None])[0].T
    left = angle - plain @ coefficients
    freedom = max(duty.size - 3, 1)
    excess = max(float(np.sum((weight * left) ** 2)) / freedom, 1.0)
    covariance = excess * np.linalg.inv(columns.T @ columns) + np.outer(common, common)
    gain, offset, friction = (float(value) for value in coefficients)
    factor = float(stats.t.ppf(0.975, freedom))

    def estimate(value: float, slope: tuple[float, float, float]) -> Estimate:
        variance = float(np.array(slope) @ covariance @ np.array(slope))
        half = factor * math.sqrt(max(variance, 0.0))  # rounding may take it below 0
        return Estimate(value, (value - half, value + half))

    return StaticCharacteristic(
        estimate(gain, (1.0, 0.0, 0.0)),
        estimate(-friction / gain, (friction / gain**2, 0.0, -1.0 / gain)),
        estimate(-offset / gain, (offset / gain**2, -1.0 / gain, 0.0)),
        tuple(points),
        float(np.sqrt(np.sum(left**2) / freedom)),
        time_constant,
    )
