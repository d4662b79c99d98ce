"""A recording held against an actuator: what the torques along its motion leave of the command, all effects allowed.

Base parameters are free within bounds and each known effect may act as strongly as is plausible, friction even more: it
resists in any case. So missing physics takes nothing away from a recording, but a command that is none needs a motor
that pulls the other way, a friction that drives, or an inertia a hundred times too large.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.effects import DECLARED, EFFECTS, OUTSIDE, Effect
from pierburg_ros.effects.effect import Start
from pierburg_ros.errors import InputError
from pierburg_ros.inference.bounded import Bounded, Column
from pierburg_ros.inference.data import run_of
from pierburg_ros.inference.evidence import repetition
from pierburg_ros.inference.explanation import Variant
from pierburg_ros.inference.motion import Motion, motion_of
from pierburg_ros.inference.shortlist import Span, added
from pierburg_ros.plant import Model
from pierburg_ros.plant.decode import decoded
from pierburg_ros.recording import Recording

DESCRIBED_WITHIN = 10.0
"""Factor within which a number of a description may be off. Chosen: guesses are; units are off by 57 and more."""
PAST_STOP = 0.06
"""Share of the travel by which a reading may lie beyond a stop. Chosen: a sensor's zero may be off by 3 %, its curve
and a soft stop add as much."""
STARTS_AS_COLUMNS = 4
"""Starts of each way in which an effect may act that make columns. Work: what lies between is nearly made of them."""
MOST = 3000
"""Samples of a motion that are weighed, evenly spread, and most in the actuator's own time. Work: a fault shows
throughout."""
SAMPLES = 40
"""Samples of a surely moving shaft below which nothing is said. Derived: nearly as many as there are columns."""
LOADS = ("spring_preload", "spring_stiffness", "gravity_torque", "total_inertia", "coulomb_friction")
"""Base parameters in which the torque that the motor has to give is linear."""


@dataclass(frozen=True)
class Weighed:
    """The share of the command's variation that is `left`, all where no motion is seen, and the samples it counts as.

    `described` is the share without effects.
    """

    left: float = 1.0
    effective: float = 1.0
    described: float = 1.0


class Held:
    """A recording and the actuator that it is held against; `motion` is None where it shows too little."""

    def __init__(self, recording: Recording, nominal: Model) -> None:
        self.recording, self.nominal, self.motion = recording, nominal, seen(recording, nominal)
        self.impossible = impossible(recording, nominal)
        if self.motion is not None:
            own = list(base(self.motion, nominal))
            self.described, self.allowed = Bounded(own), Bounded([*own, *possible(self.motion, nominal)])

    def weighed(self, late: float = 0.0, rate: float = 0.0) -> Weighed:
        """What is left where the command acted `late` [s] before its stamp, and earlier by `rate` with each second."""
        if self.motion is None:
            return Weighed()
        whole = self.motion.whole
        moved = np.interp(whole.time * (1.0 + rate) + late, whole.time, whole.raw_command)
        target = self.motion.driven(self.nominal.values, whole.smooth(moved)[self.motion.samples])
        residual, plain = self.allowed.residual(target), self.described.residual(target)
        return Weighed(self.left(residual, target), residual.size / repetition(residual), self.left(plain, target))

    def as_read(self) -> Weighed:
        """What is left of the recording as it is read; a command may act as late as a delay is plausible."""
        return min((self.weighed(-delay) for delay in (0.0, *delays(self.nominal))), key=lambda each: each.left)

    def followed(self, gain: float) -> Weighed:
        """What is left of a command that the shaft follows, `gain` times its angle [rad], behind a lag."""
        if self.motion is None:
            return Weighed()
        lag = Bounded([(rate, 0.0, math.inf) for rate in (self.motion.velocity, self.motion.acceleration)])
        residual = lag.residual(self.motion.command - gain * self.motion.angle)
        left = self.left(residual, self.motion.command)
        return Weighed(left, residual.size / repetition(residual), left)

    def left(self, residual: Signal, target: Signal) -> float:
        """What a `residual` is of the variation of its `target`; samples that cannot be are all left."""
        varies = float(np.sum(np.square(target - np.mean(target))))
        share = min(float(residual @ residual) / varies, 1.0) if varies > 0.0 else 1.0
        return self.impossible + (1.0 - self.impossible) * share


def seen(recording: Recording, nominal: Model) -> Motion | None:
    """The motion, at evenly spread samples; None where the recording is of something else, or shows too little."""
    try:
        run = run_of(recording, nominal, 0, np.zeros(recording.time.size, dtype=np.int64))
    except InputError:
        return None
    own, step = nominal.scales.time, float(np.median(np.diff(recording.time)))
    if recording.duration < own or recording.time.size < SAMPLES or not step / DESCRIBED_WITHIN <= own <= MOST * step:
        return None
    motion = motion_of(run, nominal, own)
    size = motion.samples.size
    return Motion(motion.whole, motion.samples[:: -(-size // MOST)]) if size >= SAMPLES else None


def impossible(recording: Recording, nominal: Model) -> float:
    """The share of the recording in which a reading lies beyond the stops, or a supply beyond what is accepted."""
    actuator, supply = nominal.actuator, recording.supply_voltage
    share, travel = 0.0, actuator.upper_stop - actuator.lower_stop
    if math.isfinite(travel) and recording.quantity != "speed":
        angle = decoded(nominal, recording.measured, recording.quantity)
        low, high = actuator.lower_stop - PAST_STOP * travel, actuator.upper_stop + PAST_STOP * travel
        share = float(np.mean((angle < low) | (angle > high)))
    if supply is not None and actuator.drive == "voltage":
        share = max(share, float(np.mean(supply.values > actuator.parameters["supply_voltage"].maximum)))
    return share


def base(motion: Motion, nominal: Model) -> Iterator[Column]:
    """What each base parameter adds, in multiples of its nominal value; friction is not negative, nor is the motor."""
    values, none = nominal.values, dict.fromkeys(LOADS, 0.0)
    for name in LOADS:
        value = values.get(name, 0.0)
        if name == "coulomb_friction":
            yield motion.load({**none, name: 1.0}), 0.0, math.inf
        elif value != 0.0:
            yield motion.load({**none, name: value}), 1.0 / DESCRIBED_WITHIN, DESCRIBED_WITHIN
    braked = motion.driven(values, motion.command) - motion.motor_torque(values)
    if np.any(braked):
        yield braked, 1.0 / DESCRIBED_WITHIN, math.inf
    low, high = DECLARED[OUTSIDE].expected(nominal.scales)
    yield np.ones(motion.samples.size), low, high


def possible(motion: Motion, nominal: Model) -> Iterator[Column]:
    """What every effect that the actuator may have adds, at a few of its starts."""
    actuator, scales = nominal.actuator, nominal.scales
    # a few starts of a longer or farther recording would lie no closer
    duration = min(float(motion.whole.time[-1]) / scales.time, float(MOST))
    angle = np.clip(motion.whole.angle / scales.angle, -float(SAMPLES), float(SAMPLES))
    span = Span(duration, float(np.min(angle)), float(np.max(angle)))
    for effect in EFFECTS:
        if effect.along is None or effect.dead_time or actuator.obstacle(effect):
            continue
        for variant in effect.variants:
            for start in few(effect, variant.over(span)):
                own = {**effect.in_units(start, scales), **variant.fixed}
                values = added(nominal.values, Variant(effect.id, variant.free), own)
                yield from allowed(effect, start, motion, effect.along(motion, values))


def few(effect: Effect, starts: Sequence[Start]) -> Sequence[Start]:
    """Some of the starts, phases in turn; the strongest alone where the effect takes a share of the command itself."""
    return starts[-1:] if effect.stage in ("input", "drive") else starts[:: len(starts) // STARTS_AS_COLUMNS | 1]


def allowed(effect: Effect, start: Start, motion: Motion, column: Signal) -> Iterator[Column]:
    """A column within its bounds: a friction resists each way, what takes from the command takes no more than there is.

    Others are as strong as is plausible.
    """
    if effect.stage == "friction":
        for way in (1.0, -1.0):
            yield np.where(motion.direction == way, way * np.abs(column), 0.0), 0.0, math.inf
        return
    most = 1.0
    for name in effect.strength if effect.stage not in ("input", "drive") else ():
        strength = effect.parameter(name)
        if start.get(name):
            times = max(map(abs, strength.plausible)) / abs(start[name])
            most = max(most, 1.0 / times if strength.inverse else times)
    yield column, -most if effect.ripple else 0.0, most


def delays(nominal: Model) -> Iterator[float]:
    """Delays [s] of the command from which a search starts."""
    for effect in EFFECTS:
        for variant in effect.variants:
            if effect.dead_time is not None:
                assert not callable(variant.starts)
                yield from (effect.in_units(start, nominal.scales)[effect.dead_time] for start in variant.starts)
