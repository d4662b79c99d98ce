"""A proportional controller as a second witness of the angle: it says what the sensor and the log have done to it.

Its duty follows from setpoint and angle by one rule that is nearly exact, whatever physics the actuator lacks. So the
duty shows the angle on which the controller acted. Where the recorded angle trails behind that, its sensor has a lag or
a play that the controller does not see; where the duty came before the setpoint and the angle that it follows from, it
takes effect later than it was logged; where it steps over a band around 0, its controller makes up for a dead band. No
simulation has to be right for this. It tells nothing of a sensor whose faults the controller shares.

A controller with an integral is none of these: beside a lag its rule seems to explain most of what it leaves, but not
all. One with a derivative looks like a proportional one behind a lag, exactly; there the motion decides.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from pierburg_ros.arrays import Flags, Signal
from pierburg_ros.audit.loop import EXACT, free_of_limits
from pierburg_ros.audit.signals import Signals
from pierburg_ros.diagnosis.search.candidates import possible
from pierburg_ros.effects import Effect
from pierburg_ros.estimation.explanation import Variant
from pierburg_ros.estimation.intervals import HALF_KNOWN, Estimate
from pierburg_ros.estimation.likelihood import TIED, repetition
from pierburg_ros.kernel import kernel
from pierburg_ros.plant import Model
from pierburg_ros.plant.decode import decoded
from pierburg_ros.recording import Channel

TOLD = 0.75
"""Share of the mean square of what the rule leaves that has to go with an effect: the error of the rule halves.
Measured: 0.89 to 0.9999 goes with effects put into a servo's recordings (n = 15), and 0.54 at most with what is found
in the untouched ones beyond two of their intervals (n = 8)."""
INTERVALS = 2
"""Intervals of the samples by which controller and log may be apart, and beyond which a time is told. Derived: the
controller acts up to one before or after the sample, and the sample is read up to one after."""
FAR = 10.0
"""How far beyond what is plausible a strength is looked for. Work: a wider range takes longer; not varied."""
TRIED = 120
"""Strengths that are tried over that range, some percent apart. Work: each takes some tenths of a millisecond."""
FEWEST = 100
"""Samples at which the duty is free, at least. Chosen: half a second of a servo's, which tell three numbers; not
varied."""
SETTLED = 8
"""Steps in which play and rule are fitted in turn. Work: each halves what is left to do or better; not varied."""


@dataclass(frozen=True)
class Witness:
    """An effect at the strength that the rule tells, and the mean squares [rad^2] that the rule leaves.

    The strength lies `between` two values, and their geometric mean stands for it. `without` it and `beside` it.
    `as_well` are effects that the rule tells no worse.
    """

    variant: Variant
    between: tuple[float, float]
    without: float
    beside: float
    as_well: tuple[str, ...] = ()

    @property
    def share(self) -> float:
        """Share of the mean square without it that goes with it."""
        return 1.0 - self.beside / self.without

    @property
    def estimates(self) -> dict[str, Estimate]:
        """The strength by its dotted name."""
        ((name, value),) = self.variant.fixed
        low, high = self.between
        known = high - low < 2.0 * HALF_KNOWN * value
        return {f"{self.variant.effect}.{name}": Estimate(value, low, high, known)}


Left = Callable[[float], Signal]
"""What the rule leaves of the recorded angle [rad] beside an effect of a strength, shape (free samples,)."""


def witnessed(signals: Signals, nominal: Model) -> Witness | None:
    """What the rule of a proportional controller tells of the sensor or the log of its input; None where it is silent.

    It has to explain most of what the rule leaves otherwise, and a time has to be longer than sampling tells. The rule
    beside it has to be exact: of the loop's error, which the duty follows from, next to nothing is left.
    """
    if signals.setpoints is None or signals.quantity == "speed":
        return None
    loop = _Loop.of(signals, nominal, signals.setpoints)
    if loop is None or loop.exact:
        return None
    asked = (_told(effect, loop, nominal) for effect in possible(nominal.actuator))
    told = sorted((each for each in asked if each and each.share >= TOLD), key=lambda each: each.beside)
    if not told or told[0].beside > (1.0 - EXACT) * loop.error or math.isinf(told[0].between[1]):
        return None
    best, *others = told
    return replace(best, as_well=tuple(each.variant.effect for each in others if each.beside < 2.0 * best.beside))


def _told(effect: Effect, loop: _Loop, nominal: Model) -> Witness | None:
    """What the rule tells of an effect, without an upper end where it tells none; None where it can tell nothing."""
    name, left, least = _way(effect, loop)
    if left is None:
        return None
    tried = np.geomspace(least, FAR * max(effect.parameter(name).expected(nominal.scales)[1], least), TRIED)
    each_left = [left(float(each)) for each in tried]
    leaves = np.array([_mean_square(each) for each in each_left])
    place = int(np.argmin(leaves))
    samples = each_left[place].size / repetition(each_left[place])
    possible_too = np.flatnonzero(leaves <= leaves[place] * (1.0 + TIED / samples))
    highest = math.inf if possible_too[-1] == TRIED - 1 else float(tried[possible_too[-1]])
    between = float(tried[possible_too[0]]), highest
    if between[0] <= nominal.values[f"{effect.id}.{name}"]:
        return None
    variant = Variant(effect.id, (), ((name, math.sqrt(between[0] * between[1])),))
    return Witness(variant, between, _mean_square(loop.undisturbed), float(leaves[place]))


def _way(effect: Effect, loop: _Loop) -> tuple[str, Left | None, float]:
    """The strength by which an effect shows in the rule, what the rule leaves beside it, and the least that is told."""
    if effect.lag is not None:
        return effect.lag, loop.lagging, INTERVALS * loop.interval
    if effect.dead_time is not None:
        return effect.dead_time, loop.delayed, INTERVALS * loop.interval
    if effect.play is not None and effect.stage == "sensor":
        return effect.play, loop.dragged, math.sqrt(_mean_square(loop.undisturbed))
    if effect.dead_band is not None:
        return effect.dead_band, loop.stepping, float(np.mean(np.abs(np.diff(loop.command.values))))
    return "", None, 0.0


@dataclass(frozen=True)
class _Loop:
    """A closed loop: angle = setpoint + p duty + q, for the p and q that suit best; all of shape (samples,).

    `free` are samples at which the duty is neither limited nor without effect, `interval` [s] that between samples.
    Controller and log may be some samples apart, by as much as suits best.
    """

    time: Signal
    angle: Signal
    setpoint: Signal
    free: Flags
    command: Channel
    interval: float

    @staticmethod
    def of(signals: Signals, nominal: Model, setpoints: Channel) -> _Loop | None:
        """The loop of some signals; None where too little of it moves freely."""
        free = free_of_limits(signals)
        angle, setpoint = decoded(nominal, signals.measured, signals.quantity), setpoints.at(signals.time)
        command = Channel(signals.inputs.time, signals.inputs.command)
        if (
            np.count_nonzero(free) < FEWEST
            or min(np.ptp(each[free]) for each in (signals.command, setpoint, angle)) == 0
        ):
            return None
        return _Loop(signals.time, angle, setpoint, free, command, signals.interval)

    @property
    def error(self) -> float:
        """Variance of how far the recorded angle is from the setpoint [rad^2]."""
        return float(np.var((self.angle - self.setpoint)[self.free]))

    @property
    def exact(self) -> bool:
        """Whether the rule leaves no more than rounding to single precision, which tells nothing."""
        return _mean_square(self.undisturbed) <= float(np.finfo(np.float32).eps) ** 2 * self.error

    @cached_property
    def duties(self) -> list[Signal]:
        """The duty as it was some samples before and after."""
        return [self.command.at(self.time - by * self.interval) for by in range(-INTERVALS, INTERVALS + 1)]

    @cached_property
    def undisturbed(self) -> Signal:
        """What is left where nothing acts."""
        ones = np.ones_like(self.time)
        return _least(_left(self.angle - self.setpoint, duty, ones, self.free) for duty in self.duties)

    def delayed(self, time: float) -> Signal:
        """What is left where the duty acts a `time` [s] after it was logged.

        It was computed between this sample and the last, half an interval before on average. Where too few samples
        tell, it is what is left undisturbed.
        """
        then = self.time - max(time - 0.5 * self.interval, 0.0)
        free: Flags = np.interp(then, self.time, self.free) == 1.0
        if np.count_nonzero(free) < FEWEST:
            return self.undisturbed
        return _left(self.angle - self.setpoint, self.command.at(then), np.ones_like(self.time), free)

    def stepping(self, width: float) -> Signal:
        """What is left where the duty steps over a band of a `width` around 0."""
        ones = np.ones_like(self.time)
        beyond = (np.copysign(np.maximum(np.abs(duty) - width, 0.0), duty) for duty in self.duties)
        return _least(_left(self.angle - self.setpoint, duty, ones, self.free) for duty in beyond)

    def lagging(self, time: float) -> Signal:
        """What is left where the recorded angle follows with a lag of a `time` [s]."""
        ones, nothing = np.ones_like(self.angle), np.zeros_like(self.angle)
        known = self.angle - _followed(self.time, self.setpoint, self.angle, self.free, time)
        constant = _followed(self.time, ones, nothing, self.free, time)
        lagged = (_followed(self.time, duty, nothing, self.free, time) for duty in self.duties)
        return _least(_left(known, duty, constant, self.free) for duty in lagged)

    def dragged(self, width: float) -> Signal:
        """What is left where the recorded angle is dragged along with a play of a `width` [rad]."""
        return _least(self._dragged(width, duty) for duty in self.duties)

    def _dragged(self, width: float, duty: Signal) -> Signal:
        behind, ones = np.zeros_like(self.angle), np.ones_like(self.angle)
        for _ in range(SETTLED):
            by, offset = _weights(self.angle - self.setpoint - behind, duty, ones, self.free)
            acted_on = self.setpoint + by * duty + offset
            behind = _dragged(acted_on, self.angle, self.free, 0.5 * width) - acted_on
        return _left(self.angle - self.setpoint - behind, duty, ones, self.free)


def _least(residuals: Iterable[Signal]) -> Signal:
    """The smallest of some residuals."""
    return min(residuals, key=_mean_square)


def _left(target: Signal, by_duty: Signal, constant: Signal, kept: Flags) -> Signal:
    """What two columns leave of a target, at the samples `kept`."""
    by, offset = _weights(target, by_duty, constant, kept)
    return np.asarray((target - by * by_duty - offset * constant)[kept])


def _mean_square(residual: Signal) -> float:
    return float(np.mean(np.square(residual)))


def _weights(target: Signal, by_duty: Signal, constant: Signal, kept: Flags) -> tuple[float, float]:
    """Weights of two columns by least squares; of a duty that tells no more than the constant it is 0.

    By Gram-Schmidt, for it is asked thousands of times: a decomposition takes twenty times as long.
    """
    known, duty, other = target[kept], by_duty[kept], constant[kept]
    square = float(other @ other)
    own = duty - float(duty @ other) / square * other
    rest = float(own @ own)
    by = float(known @ own) / rest if rest > np.finfo(float).eps * float(duty @ duty) else 0.0
    return by, float((known - by * duty) @ other) / square


@kernel
def _followed(time: Signal, values: Signal, shown: Signal, free: Flags, lag: float) -> Signal:
    """`values` behind a first-order `lag` [s], straight between samples; where they are not `free`, what is `shown`."""
    lagged = shown.copy()
    lagged[0] = values[0] if free[0] else shown[0]
    for k in range(1, values.size):
        if free[k]:
            before = values[k - 1] if free[k - 1] else values[k]
            interval = time[k] - time[k - 1]
            trail = (values[k] - before) / interval * lag
            lagged[k] = values[k] - trail + (lagged[k - 1] - before + trail) * math.exp(-interval / lag)
    result: Signal = lagged
    return result


@kernel
def _dragged(values: Signal, shown: Signal, free: Flags, half: float) -> Signal:
    """What `values` drag along with a play of twice `half`; where they are not `free`, what is `shown`."""
    magnet = shown.copy()
    for k in range(1, values.size):
        if free[k]:
            magnet[k] = min(max(magnet[k - 1], values[k] - half), values[k] + half)
    result: Signal = magnet
    return result
