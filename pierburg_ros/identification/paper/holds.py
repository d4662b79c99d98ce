"""Stretches of constant duty in a recording, and the angle at which the shaft would settle in each."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import optimize

from pierburg_ros.actuators import Actuator, Scales
from pierburg_ros.arrays import Signal
from pierburg_ros.plant import Model
from pierburg_ros.plant.decode import decoded
from pierburg_ros.recording import Recording
from pierburg_ros.recording.noise import noise_of

SHORTEST_HOLD = 4.2
"""Shortest hold clear of the stops that says where the shaft settles, in the actuator's own time. Chosen: 0.4 s for the
valve, a third of its time constant, 1.15 s; not varied."""
STOP_MARGIN = 0.0127
"""Distance from a stop, as a share of the travel, within which it may hold the shaft. Derived: 17 times a noise of 3 mV
for the valve, so that a soft stop counts too."""
TRAVEL = 0.0013
"""Smallest movement of the shaft, as a share of the travel, in a hold that says where it settles. Derived: 2 mrad of
the valve, less than two standard deviations of a noise of 3 mV."""
SETTLES = (0.21, 210.0)
"""Range of the time constant with which the shaft settles, in the actuator's own time. Chosen: 20 ms to 20 s for the
valve, whose own is 1.15 s; not varied."""


@dataclass(frozen=True)
class Hold:
    """A stretch of constant `duty` [1]: times since the recording's start [s] and angles [rad]."""

    duty: float
    time: Signal
    angle: Signal

    @property
    def before_motion(self) -> Signal:
        """Time since the hold began [s]."""
        return np.asarray(self.time - self.time[0])


@dataclass(frozen=True)
class Settled:
    """Angle [rad] at which the shaft settles at a `duty` [1] when opening (`direction` +1) or closing (-1).

    `deviation` [rad] is its standard deviation at the time constant found. `doubt` [rad] is its change when the time
    constant moves by its own standard deviation.
    """

    duty: float
    angle: float
    direction: int
    deviation: float
    doubt: float


def angle_of(recording: Recording, actuator: Actuator) -> Signal:
    """Measured shaft angle [rad], decoded by the nominal sensor, shape (samples,)."""
    return decoded(Model.nominal(actuator), recording.measured, recording.quantity)


def holds(recording: Recording, actuator: Actuator) -> list[Hold]:
    """The stretches of constant duty clear of the stops, in order, without those that are too short."""
    duty = recording.command.at(recording.time, before=0.0)
    angle = angle_of(recording, actuator)
    own = actuator.scales
    margin = STOP_MARGIN * own.angle
    clear = (angle > actuator.lower_stop + margin) & (angle < actuator.upper_stop - margin)
    edges = np.flatnonzero((np.diff(duty) != 0.0) | (np.diff(clear.astype(int)) != 0)) + 1
    parts = [
        slice(first + 1, last)
        for first, last in zip([0, *edges], [*edges, duty.size], strict=True)
        if clear[first] and last - first > 8
    ]
    return [
        Hold(float(duty[part.start]), recording.time[part], angle[part])
        for part in parts
        if recording.time[part.stop - 1] - recording.time[part.start] >= SHORTEST_HOLD * own.time
    ]


def moving(found: list[Hold], noise: float, scales: Scales) -> list[Hold]:
    """The holds of `found` in which the shaft moves from the first fifth to the last; `noise` [rad]."""
    kept = []
    for hold in found:
        fifth = max(hold.angle.size // 5, 2)
        means = [float(np.mean(hold.angle[part])) for part in (slice(fifth), slice(-2 * fifth, -fifth))]
        travel = abs(np.mean(hold.angle[-fifth:]) - means[0])
        late = abs(np.mean(hold.angle[-fifth:]) - means[1])
        if travel > max(8.0 * noise / np.sqrt(fifth), TRAVEL * scales.angle) and late > 2.0 * noise / np.sqrt(fifth):
            kept.append(hold)
    return kept


def settled(found: list[Hold], scales: Scales) -> tuple[list[Settled], float]:
    """Where the shaft settles in each of the `moving` holds, and the time constant [s] common to all of them.

    While sliding, the angle approaches its end exponentially and never quite reaches it (equations (5) and (6) without
    inductance and inertia). The fitted exponential gives the end without waiting for it.
    """

    def misfit(logarithm: float) -> float:
        return sum(_approach(hold, float(np.exp(logarithm)))[2] for hold in found)

    bounds = tuple(np.log(np.multiply(SETTLES, scales.time)))
    search = optimize.minimize_scalar(misfit, bounds=bounds, method="bounded", options={"xatol": 1e-7})
    least, step = float(search.fun), 1e-3
    curvature = max((misfit(search.x + step) + misfit(search.x - step) - 2.0 * least) / step**2, 1e-300)
    samples = sum(hold.time.size - 2 for hold in found)
    variance = least / samples
    deviation = float(np.sqrt(2.0 * variance / curvature))
    constant = float(np.exp(search.x))
    points = []
    for hold in found:
        end, distance, _ = _approach(hold, constant)
        further, _, _ = _approach(hold, constant * np.exp(step))
        own = float(np.sqrt(variance * np.linalg.inv(_gram(hold, constant))[0, 0]))
        doubt = (further - end) / step * deviation
        points.append(Settled(hold.duty, end, 1 if distance < 0.0 else -1, own, doubt))
    return points, constant


def angle_noise(recording: Recording, actuator: Actuator) -> float:
    """Sensor noise [rad]."""
    return noise_of(recording.time, angle_of(recording, actuator))


def _gram(hold: Hold, constant: float) -> Signal:
    columns = np.column_stack([np.ones(hold.time.size), np.exp(-hold.before_motion / constant)])
    return np.asarray(columns.T @ columns)


def _approach(hold: Hold, constant: float) -> tuple[float, float, float]:
    """Final angle [rad], distance from it at the start [rad] and squared misfit [rad^2] of an exponential approach."""
    columns = np.column_stack([np.ones(hold.time.size), np.exp(-hold.before_motion / constant)])
    (end, distance), *_ = np.linalg.lstsq(columns, hold.angle, rcond=None)
    left = hold.angle - columns @ np.array([end, distance])
    return float(end), float(distance), float(left @ left)
