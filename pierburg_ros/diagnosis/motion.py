"""The motion of the shaft in a recording: angle, velocity, rest, reversals and stops, sample by sample."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from pierburg_ros.actuators import Actuator, Scales
from pierburg_ros.arrays import Flags, Signal
from pierburg_ros.inference.data import Run
from pierburg_ros.plant import Model
from pierburg_ros.plant.decode import angle_per_unit, decoded, turned

INSTANT = 0.21
"""Shortest time over which a motion is evaluated, in the actuator's own time: half the window of a velocity, and the
grid of missing torque, of energy and of contact. Derived: 20 ms for the valve, ten samples at 500 Hz; with 3 mV of
noise a velocity is then known to 0.025 rad/s."""
STANDSTILL = 0.003
"""Share of the no-load speed below which the shaft counts as standing still; more where the noise requires it. Derived:
twice the error that 3 mV of noise cause in a velocity of the valve."""
AT_STOP = 0.01
"""Distance from a stop within which the shaft counts as on it, as a share of the travel; three times the noise is
added. Chosen: a hundredth; not varied."""
AFTERMATH = 3.1
"""Time after a standstill in which a movement counts as the first one, in the actuator's own time. Chosen: 0.3 s for
the valve; it names windows and regimes and decides no verdict."""


@dataclass(frozen=True)
class Motion:
    """A motion, all of shape (samples,). The nominal sensor gives the angle [rad]; the command is the one in force."""

    time: Signal
    angle: Signal
    velocity: Signal
    acceleration: Signal
    command: Signal
    moving: Flags
    closed: Flags
    open: Flags
    actuator: Actuator
    angle_per_unit: float
    """Angle [rad] of one unit of the measured quantity."""

    @property
    def scales(self) -> Scales:
        """The scales of the actuator."""
        return self.actuator.scales

    @property
    def effort(self) -> Signal:
        """The command as a share of a large one; a duty stays as it is."""
        large = {"duty": 1.0, "current": self.scales.current, "torque": self.scales.torque}
        return np.asarray(self.command / large[self.actuator.input])

    @property
    def direction(self) -> Signal:
        """1 opening, -1 closing: the direction of the present movement or the last one; 0 before the first."""
        sign = np.where(self.moving, np.sign(self.velocity), 0.0)
        last = np.maximum.accumulate(np.where(sign != 0.0, np.arange(sign.size), 0))
        return np.asarray(sign[last])

    @property
    def reversals(self) -> np.ndarray:
        """Samples at which the shaft starts to move against its last direction."""
        direction = self.direction
        return np.flatnonzero((np.diff(direction) != 0.0) & (direction[:-1] != 0.0)) + 1

    @property
    def departures(self) -> np.ndarray:
        """Samples at which a movement begins."""
        return np.flatnonzero(self.moving[1:] & ~self.moving[:-1]) + 1

    @property
    def time_at_rest(self) -> Signal:
        """How long [s] the shaft has stood still; 0 where it moves.

        A movement that began a moment ago still has the time before it.
        """
        began = np.zeros(self.time.size)
        arrivals = np.flatnonzero(~self.moving[1:] & self.moving[:-1]) + 1
        began[arrivals] = self.time[arrivals]
        stood = self.time - np.maximum.accumulate(np.where(self.moving, 0.0, began))
        resting = np.where(self.moving, 0.0, stood)
        departures = self.departures
        place = np.searchsorted(departures, np.arange(self.time.size), side="right") - 1
        if departures.size == 0:
            return np.asarray(resting)
        latest = departures[np.maximum(place, 0)]
        fresh = self.moving & (place >= 0) & (self.time - self.time[latest] < AFTERMATH * self.scales.time)
        return np.asarray(np.where(fresh, resting[latest - 1], resting))

    @property
    def time_since_reversal(self) -> Signal:
        """Time since the last reversal, or since the start [s]."""
        turned = np.concatenate([[0], self.reversals])
        place = np.searchsorted(turned, np.arange(self.time.size), side="right") - 1
        return np.asarray(self.time - self.time[turned[place]])

    @property
    def stop_distance(self) -> Signal | None:
        """Distance to the nearer stop [rad], not below 0; None where there is no stop."""
        below, above = self.angle - self.actuator.lower_stop, self.actuator.upper_stop - self.angle
        nearest = np.minimum(below, above)
        return np.maximum(nearest, 0.0) if np.all(np.isfinite(nearest)) else None


def motion_of(run: Run, actuator: Actuator, noise: float) -> Motion:
    """The motion of the shaft in `run`, measured with `noise` (standard deviation, measured unit)."""
    nominal, scales = Model.nominal(actuator), actuator.scales
    angle, per_unit = turned(nominal, run.time, run.measured, run.quantity), angle_per_unit(nominal)
    interval = float(np.median(np.diff(run.time)))
    half = max(INSTANT * scales.time, 2.0 * interval)
    spread = noise * abs(per_unit)
    if run.quantity == "speed":
        velocity, off, spread = decoded(nominal, run.measured, run.quantity), spread, 0.0
    else:
        # each end of the difference is a mean over the half window
        velocity, off = slope(run.time, angle, half), spread * math.sqrt(2.0 * interval / half) / half
    slowest = max(STANDSTILL * scales.angle / scales.time, 5.0 * off)
    near = AT_STOP * scales.angle + 3.0 * spread
    place = np.searchsorted(run.inputs.time, run.time, side="right") - 1
    command = np.where(place < 0, 0.0, run.inputs.command[np.maximum(place, 0)])
    return Motion(
        time=run.time - run.time[0],
        angle=angle,
        velocity=velocity,
        acceleration=slope(run.time, velocity, half),
        command=command,
        moving=np.abs(velocity) > slowest,
        closed=angle <= actuator.lower_stop + near,
        open=angle >= actuator.upper_stop - near,
        actuator=actuator,
        angle_per_unit=per_unit,
    )


def slope(time: Signal, values: Signal, half: float) -> Signal:
    """Slope of `values`: the mean over `half` [s] after each sample minus that before it, over their distance in time.

    Within `half` of either end too few samples are left: there it is the slope of the nearest sample farther inside.
    """
    total = np.concatenate([[0.0], np.cumsum(values)])
    moments = np.concatenate([[0.0], np.cumsum(time)])
    here = np.arange(time.size)
    first = np.searchsorted(time, time - half, side="left")
    last = np.searchsorted(time, time + half, side="right")
    before, after = here + 1 - first, last - here
    rise = (total[last] - total[here]) / after - (total[here + 1] - total[first]) / before
    run = (moments[last] - moments[here]) / after - (moments[here + 1] - moments[first]) / before
    velocity = np.divide(rise, run, out=np.zeros(time.size), where=run > 0.0)
    inner = np.flatnonzero((time >= time[0] + half) & (time <= time[-1] - half))
    return np.asarray(velocity[np.clip(here, inner[0], inner[-1])] if inner.size else velocity)
