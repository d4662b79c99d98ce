"""The measured motion of a shaft: angle, velocity, acceleration and command behind one filter, and where it moves.

One linear filter on every term keeps a balance that is linear in these signals exact. The filter is the local
polynomial of Savitzky and Golay, Smoothing and differentiation of data by simplified least squares procedures (1964).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import correlate1d

from pierburg_ros.actuators import Actuator
from pierburg_ros.arrays import Flags, Signal
from pierburg_ros.effects.effect import Motion as Signals
from pierburg_ros.inference.data import GAP, Run
from pierburg_ros.plant import Model
from pierburg_ros.plant.decode import decoded
from pierburg_ros.recording.noise import noise_of

WIDTH = 0.5
"""Length of the filter in the actuator's own time. Chosen: 50 ms for the valve, in which it goes half its travel at
most; not varied."""
SHORTEST_FILTER = 7
"""Least number of samples in the filter. Derived: a parabola through seven leaves the acceleration four degrees of
freedom."""
SURELY_MOVING = 6.0
"""Standard deviations of the velocity's own noise above which the shaft surely moves. Derived: white noise passes that
once in 5e8 samples."""
KEPT_OF_FILTER = 6
"""Samples in a length of the filter that are kept. Derived: what is nearer shares most of its window."""
NEAR_STOP = 0.02
"""Share of the travel next to a stop in which a contact may bear part of the torque. Chosen: the 30 mrad that a stop of
the least plausible stiffness gives under the nominal preload."""


@dataclass(frozen=True, eq=False)
class Filtered:
    """Evenly sampled signals behind one filter of `window` samples, a `step` [s] apart, each shape (samples,).

    `noise` [rad, or rad/s] is that of the raw angle, or speed.
    """

    actuator: Actuator
    step: float
    window: int
    time: Signal
    raw: Signal
    raw_command: Signal
    supply: Signal | None
    closed: Signal
    noise: float
    angle: Signal = field(init=False)
    velocity: Signal = field(init=False)
    acceleration: Signal = field(init=False)
    command: Signal = field(init=False)

    def __post_init__(self) -> None:
        order = 0 if self.actuator.quantity == "speed" else 1
        if order:
            object.__setattr__(self, "angle", self.smooth(self.raw))
        else:
            object.__setattr__(self, "angle", np.concatenate([[0.0], np.cumsum(self.raw[1:] * self.step)]))
        object.__setattr__(self, "velocity", self.smooth(self.raw, order))
        object.__setattr__(self, "acceleration", self.smooth(self.raw, order + 1))
        object.__setattr__(self, "command", self.smooth(self.raw_command))

    def smooth(self, values: Signal, derivative: int = 0) -> Signal:
        """`values` or a derivative of them behind the filter."""
        half = self.window // 2
        parabola = np.linalg.pinv(np.vander(np.arange(-half, half + 1), 3, increasing=True))
        weights = math.factorial(derivative) / self.step**derivative * parabola[derivative]
        return np.asarray(correlate1d(values, weights, mode="nearest"))

    @cached_property
    def moving(self) -> Flags:
        """Where the shaft surely moves, shape (samples,)."""
        spread = self.noise / math.sqrt(self.window)
        if self.actuator.quantity != "speed":
            spread = self.noise * math.sqrt(12.0 / self.window**3) / self.step
        return np.asarray(np.abs(self.velocity) > SURELY_MOVING * spread)

    def all_of_filter(self, which: Flags) -> Flags:
        """Where some samples fill all of the filter, shape (samples,)."""
        return np.asarray(np.convolve(which, np.ones(self.window), "same") > self.window - 0.5)

    @cached_property
    def apart(self) -> Flags:
        """Where the shaft is away from its stops."""
        near, actuator = NEAR_STOP * self.actuator.scales.angle, self.actuator
        return (self.angle > actuator.lower_stop + near) & (self.angle < actuator.upper_stop - near)

    @cached_property
    def ripples(self) -> dict[float, tuple[Signal, Signal]]:
        """Sine and cosine of the angle by wavenumber, as they are asked for."""
        return {}


@dataclass(frozen=True, eq=False)
class Motion:
    """Some `samples` of filtered signals, as effects read them (`effects.effect.Motion`)."""

    whole: Filtered
    samples: NDArray[np.int64]

    @cached_property
    def time(self) -> Signal:
        """[s], shape (samples,)."""
        return self.whole.time[self.samples]

    @cached_property
    def angle(self) -> Signal:
        """[rad]."""
        return self.whole.angle[self.samples]

    @cached_property
    def velocity(self) -> Signal:
        """[rad/s]."""
        return self.whole.velocity[self.samples]

    @cached_property
    def acceleration(self) -> Signal:
        """[rad/s^2]."""
        return self.whole.acceleration[self.samples]

    @cached_property
    def command(self) -> Signal:
        """Duty [1], current [A] or torque [N.m]."""
        return self.whole.command[self.samples]

    @cached_property
    def direction(self) -> Signal:
        """The sign of the velocity."""
        return np.sign(self.velocity)

    @property
    def step(self) -> float:
        """Time between samples of the whole motion [s]."""
        return self.whole.step

    @property
    def span(self) -> float:
        """Angle that the sensor spans [rad]."""
        return self.whole.actuator.sensor_span

    @cached_property
    def everywhere(self) -> Motion:
        """The same at every sample, at rest too."""
        return Motion(self.whole, np.arange(self.whole.time.size))

    @cached_property
    def rests(self) -> tuple[Motion, ...]:
        """Where the shaft rests away from its stops, one after the other."""
        still = np.flatnonzero(self.whole.all_of_filter(~self.whole.moving) & self.whole.apart)
        parts = np.split(still, np.flatnonzero(np.diff(still) > 1) + 1)
        return tuple(Motion(self.whole, part) for part in parts if part.size)

    def held(self, values: Mapping[str, float]) -> Signal:
        """The torque [N.m] that friction bears where the shaft rests, positive closes."""
        return self.driven(values, self.command) - self.bearing(values)

    def only(self, which: Flags) -> Motion:
        """Those of the samples that are flagged, shape (samples,)."""
        return Motion(self.whole, self.samples[which])

    def commanded(self, delay: float) -> Signal:
        """The command as it was a `delay` [s] before."""
        time, command = self.whole.time, self.whole.raw_command
        return self.whole.smooth(np.interp(time - delay, time, command))[self.samples]

    def of_command(self, function: Callable[[Signal], Signal]) -> Signal:
        """A function of the command, behind the filter."""
        return self.whole.smooth(function(self.whole.raw_command))[self.samples]

    def ripple(self, wavenumber: float) -> tuple[Signal, Signal]:
        """Sine and cosine of the angle times a `wavenumber` [1/rad], behind the filter."""
        known = self.whole.ripples
        if wavenumber not in known:
            turned = wavenumber * (self.whole.angle if self.whole.actuator.quantity == "speed" else self.whole.raw)
            known[wavenumber] = self.whole.smooth(np.sin(turned)), self.whole.smooth(np.cos(turned))
        sine, cosine = known[wavenumber]
        return sine[self.samples], cosine[self.samples]

    def over_time(self, function: Callable[[Signals], Signal]) -> Signal:
        """A function of the whole motion, at these samples."""
        return function(self.everywhere)[self.samples]

    def rate(self, function: Callable[[Signals], Signal]) -> Signal:
        """The derivative with time of a function of the whole motion, at these samples."""
        return np.gradient(function(self.everywhere), self.step)[self.samples]

    def constant(self, values: Mapping[str, float]) -> float:
        """Torque at the shaft per current [N.m/A], and back-EMF per velocity [V.s/rad]."""
        return values["gear_ratio"] * values["torque_constant"]

    def driven(self, values: Mapping[str, float], command: Signal) -> Signal:
        """The torque [N.m] at the shaft that a `command` makes of a motor at rest."""
        drive = self.whole.actuator.drive
        if drive == "torque":
            return values.get("torque_scale", 1.0) * command
        if drive == "current":
            return self.constant(values) * command
        supply = values["supply_voltage"] if self.whole.supply is None else self.whole.supply[self.samples]
        return self.constant(values) / values["armature_resistance"] * supply * command

    def braking(self, values: Mapping[str, float]) -> float:
        """What the back-EMF brakes [N.m.s/rad]."""
        if self.whole.actuator.drive != "voltage":
            return 0.0
        return self.constant(values) ** 2 / values["armature_resistance"]

    def motor_torque(self, values: Mapping[str, float]) -> Signal:
        """The motor's torque at the shaft [N.m]."""
        braked = self.braking(values) * self.whole.closed[self.samples] * self.velocity
        return self.driven(values, self.command) - braked

    def current(self, values: Mapping[str, float]) -> Signal:
        """The motor's current [A]."""
        return self.motor_torque(values) / self.constant(values)

    def load(self, values: Mapping[str, float]) -> Signal:
        """The torque [N.m] that load, inertia and Coulomb friction need, positive closes."""
        rubbing = values["coulomb_friction"] * self.direction
        return self.bearing(values) + rubbing + values.get("total_inertia", 0.0) * self.acceleration

    def bearing(self, values: Mapping[str, float]) -> Signal:
        """The torque [N.m] of spring and weight, positive closes."""
        held = values.get("spring_preload", 0.0) + values.get("spring_stiffness", 0.0) * self.angle
        weight = values.get("gravity_torque", 0.0)
        return np.asarray(held + (weight * np.sin(self.angle) if weight else 0.0))

    def displaced(self, values: Mapping[str, float], shift: Signal, rate: Signal) -> Signal:
        """The load torque [N.m] that a shaft needs which is a `shift` [rad], moving by [rad/s], from the measured."""
        if self.whole.actuator.quantity == "speed":
            return self.braking(values) * rate
        weight = values.get("gravity_torque", 0.0)
        stiffness = values.get("spring_stiffness", 0.0) + (weight * np.cos(self.angle) if weight else 0.0)
        return np.asarray(stiffness * shift + self.braking(values) * rate)


def motion_of(run: Run, model: Model, constant: float) -> Motion:
    """The motion of a run where the shaft surely moves, away from stops, gaps and unknown input.

    The filter is as long as `WIDTH` of a time `constant` [s]. A held command acts, around a sample, with the mean of
    what is in force before and after it: without that half sample every recording would show a delay.
    """
    actuator, step = model.actuator, float(np.median(np.diff(run.time)))
    window = max(round(WIDTH * constant / step) | 1, SHORTEST_FILTER)
    time = np.arange(run.time[0], run.time[-1], step)
    window = min(window, (time.size - 1) | 1)
    inputs = run.inputs.at(time)
    closed = np.ones(time.size) if inputs.enabled is None else inputs.enabled.astype(float)
    command = inputs.command * closed
    shown = np.interp(time, run.time, decoded(model, run.measured))
    whole = Filtered(
        actuator=actuator,
        step=step,
        window=window,
        time=time,
        raw=shown,
        raw_command=np.concatenate([command[:1], 0.5 * (command[1:] + command[:-1])]),
        supply=inputs.supply_voltage,
        closed=closed,
        noise=noise_of(time, shown),
    )
    usable = whole.all_of_filter(whole.moving) & whole.apart
    usable &= np.interp(time, run.time, run.counts.astype(float)) > 0.99
    for gap in np.flatnonzero(np.diff(run.time) > GAP * step):
        usable &= (time < run.time[gap] - window * step) | (time > run.time[gap + 1] + window * step)
    usable[:window] = usable[-window:] = False
    return Motion(whole, np.flatnonzero(usable)[:: max(window // KEPT_OF_FILTER, 1)])
