"""The torque that a model lacks according to the data, sample by sample while the shaft moves."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.diagnosis.evidence.motion import INSTANT
from pierburg_ros.diagnosis.evidence.rhythms import rhythms
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.run import Run
from pierburg_ros.plant import Model
from pierburg_ros.plant.braking import braking
from pierburg_ros.plant.decode import decoded, turned, way
from pierburg_ros.plant.simulate import motor_torque
from pierburg_ros.plant.torques.missing import missing

SPOT = 0.032
"""Width of the bins in which tight spots are searched, as a share of the travel. Derived: the narrowest that a blind
trial conceals; only starts of a search come from it."""
MOVING = 0.006
"""Share of the no-load speed from which friction has a known sign. Derived: twice the limit of standing still."""
CERTAIN = 4.0
"""Standard deviations of its noise from which a velocity is certain. Derived: white noise reaches them with probability
6e-5."""
SPAN = 2.6
"""Shortest span of time in which a load is searched, in the actuator's own time; longer in a recording of more than 120
such spans. Chosen: a quarter of a second for the valve; only starts of a search come from it."""


@dataclass(frozen=True)
class MissingTorque:
    """The load torque that a model lacks where the shaft moves, with time, angle and velocity, shape (moving,).

    All are in multiples of the actuator's own scales, like the starts of a search.
    """

    time: Signal
    angle: Signal
    velocity: Signal
    torque: Signal
    gear_ratio: float
    """Angle of the motor [rad] for each unit of `angle`."""
    end: float
    """Last moment of the recording."""

    def turns(self, between: tuple[float, float], most: int) -> list[float]:
        """The clearest frequencies over the angle [periods per motor revolution], clearest first."""
        return rhythms(self.angle * self.gear_ratio / (2 * math.pi), self.torque, between, most)

    def pulses(self, between: tuple[float, float], most: int) -> list[float]:
        """The clearest frequencies over time, clearest first."""
        return rhythms(self.time, self.torque, between, most)

    def spans(self, most: int) -> list[tuple[float, float, float]]:
        """Spans of time in which the torque stands out: start, end or 0 for never, torque."""
        return spans(self.time, self.torque, self.end, most)

    def tight_spots(self, most: int) -> list[float]:
        """Angles at which more friction is missing than elsewhere, clearest first."""
        return tight_spots(self, most)


def missing_torque(data: Data, run: Run, model: Model) -> MissingTorque:
    """The load torque that `model` lacks."""
    return _of_error(data, run, model) if data.actuator.load == "spring" else _of_motion(data, run, model)


def _of_motion(data: Data, run: Run, model: Model) -> MissingTorque:
    """The missing torque from the measured motion alone, inertia included, where no spring makes an error decay."""
    own = data.scales
    instant = INSTANT * own.time
    grid = np.arange(run.time[0], run.time[-1], instant)
    shown = _averaged(run.time, turned(model, run.time, run.measured, run.quantity), grid)
    velocity = np.gradient(shown, instant)
    acceleration = np.gradient(velocity, instant)
    speed = np.interp(run.time, grid, velocity)
    motor = _averaged(run.time, motor_torque(model, run.inputs, run.time, speed), grid)
    torque = missing(model.record()[0], motor, grid, shown, velocity, acceleration)
    moving = np.abs(velocity) > _slowest(data, run, instant)
    return MissingTorque(
        time=grid[moving] / own.time,
        angle=shown[moving] / own.angle,
        velocity=velocity[moving] * own.time / own.angle,
        torque=torque[moving] / own.torque,
        gear_ratio=model.values.get("gear_ratio", 1.0) * own.angle,
        end=float(run.time[-1]) / own.time,
    )


def _slowest(data: Data, run: Run, instant: float) -> float:
    """Velocity [rad/s] from which friction has a known sign, given the noise of the means over two instants."""
    samples = max(instant / float(np.median(np.diff(run.time))), 1.0)
    return CERTAIN * data.noise * abs(data.angle_per_unit) / (math.sqrt(2.0 * samples) * instant)


def _of_error(data: Data, run: Run, model: Model) -> MissingTorque:
    """The missing torque from the error of a simulation.

    While model and shaft slide the same way, damping d(error)/dt + stiffness error = -(missing torque). This is
    equation (6) of the paper without the inertia, which is too fast to observe (time constant 15 us).
    """
    value = model.values
    own = data.scales
    per_unit, instant = data.angle_per_unit / own.angle, INSTANT * own.time
    grid = np.arange(run.time[0], run.time[-1], instant)
    simulated, measured = (
        _averaged(run.time, way(values, run.time, run.quantity), grid)
        for values in (run.simulated(model), run.measured)
    )
    damping = braking(model) / own.of_unit("N.m.s/rad")
    stiffness = value.get("spring_stiffness", 0.0) / own.of_unit("N.m/rad")
    error = per_unit * (measured - simulated)
    torque = -(damping * np.gradient(error, INSTANT) + stiffness * error)
    speeds = per_unit * np.gradient(measured, INSTANT), per_unit * np.gradient(simulated, INSTANT)
    moving = (np.abs(speeds[0]) > MOVING) & (np.abs(speeds[1]) > MOVING) & (speeds[0] * speeds[1] > 0.0)
    quantity = "position" if run.quantity == "speed" else run.quantity
    angle = decoded(model, measured[moving], quantity) / own.angle
    return MissingTorque(
        time=grid[moving] / own.time,
        angle=angle,
        velocity=speeds[0][moving],
        torque=torque[moving],
        gear_ratio=value["gear_ratio"] * own.angle,
        end=float(run.time[-1]) / own.time,
    )


def _averaged(time: Signal, values: Signal, grid: Signal) -> Signal:
    """Means of `values` over one grid step around each grid point."""
    half = 0.5 * float(grid[1] - grid[0]) if grid.size > 1 else 0.0
    edges = np.searchsorted(time, np.append(grid - half, grid[-1] + half))
    total = np.concatenate([[0.0], np.cumsum(values)])
    count = np.maximum(np.diff(edges), 1)
    means = (total[edges[1:]] - total[edges[:-1]]) / count
    return np.where(np.diff(edges) > 0, means, np.interp(grid, time, values))


def spans(time: Signal, torque: Signal, end: float, most: int) -> list[tuple[float, float, float]]:
    """Spans of time (start, end or 0 for never, torque) in which the mean of `torque` stands out, at most `most`."""
    width = max(end / 120.0, SPAN)
    bins = np.floor(time / width).astype(int)
    count = np.bincount(bins, minlength=int(end / width) + 1).astype(float)
    limit = 6.0 * np.median(np.abs(torque - np.median(torque))) if torque.size else 0.0
    clipped = np.clip(torque - np.median(torque), -limit, limit) if torque.size else torque
    total = np.bincount(bins, weights=clipped, minlength=count.size)
    sums, counts = np.concatenate([[0.0], np.cumsum(total)]), np.concatenate([[0.0], np.cumsum(count)])
    first, last = np.triu_indices(sums.size, 1)
    inside, weight = sums[last] - sums[first], counts[last] - counts[first]
    outside, rest = sums[-1] - inside, counts[-1] - weight
    usable = (weight > 5) & (rest > 5)
    contrast = np.zeros(first.size)
    difference = np.divide(inside, weight, where=usable, out=np.zeros(first.size)) - np.divide(
        outside, rest, where=usable, out=np.zeros(first.size)
    )
    contrast[usable] = np.abs(difference[usable]) * np.sqrt(weight[usable] * rest[usable])
    found: list[tuple[float, float, float]] = []
    for index in np.argsort(contrast)[::-1][:2000]:
        start, stop = first[index] * width, last[index] * width
        if all(abs(start - a) + abs(stop - (b or end)) > 6 * width for a, b, _ in found):
            found.append((start, 0.0 if stop >= end - width else stop, float(difference[index])))
        if len(found) == most:
            break
    return found


def tight_spots(missing: MissingTorque, most: int) -> list[float]:
    """Angles at which more friction is missing than elsewhere, clearest first, at most `most`."""
    if missing.angle.size < 20:
        return []
    against = missing.torque * np.sign(missing.velocity)
    limit = 6.0 * np.median(np.abs(against - np.median(against)))
    against = np.clip(against - np.median(against), -limit, limit)
    first = missing.angle.min()
    bins = np.floor((missing.angle - first) / SPOT).astype(int)
    count = np.bincount(bins)
    clearness = np.bincount(bins, weights=against) / np.sqrt(np.maximum(count, 1))
    found: list[float] = []
    for index in np.argsort(clearness)[::-1]:
        angle = float(first + (index + 0.5) * SPOT)
        if all(abs(angle - other) > 2.5 * SPOT for other in found):
            found.append(angle)
        if len(found) == most:
            break
    return found
