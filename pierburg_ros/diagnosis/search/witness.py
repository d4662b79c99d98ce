"""A proportional controller as a second witness of the angle: it shows what the sensor and the log did to it.

Its duty follows from setpoint and angle by one rule, which is nearly exact whatever physics the model lacks. So the
duty shows the angle on which the controller acted. If the recorded angle trails behind that angle, its sensor has a lag
or a play that the controller does not see. If the duty precedes the setpoint and the angle that it follows from, it
takes effect later than it was logged. If the duty steps over a band around 0, its controller makes up for a dead band.
No simulation has to be right for this. The rule says nothing of a sensor whose faults the controller shares.

A controller with an integral is none of these cases. With a lag, its rule seems to explain most of the error that it
leaves otherwise, but not all. A controller with a derivative looks exactly like a proportional one behind a lag; there
the motion decides.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from pierburg_ros.arrays import Flags, Signal
from pierburg_ros.diagnosis.search.candidates import possible
from pierburg_ros.diagnosis.search.signals import Signals
from pierburg_ros.effects import Effect
from pierburg_ros.estimation.intervals import HALF_KNOWN, Estimate
from pierburg_ros.estimation.likelihood import TIED, repetition
from pierburg_ros.inference.explanation import Variant
from pierburg_ros.kernel import kernel
from pierburg_ros.plant import Model
from pierburg_ros.plant.decode import decoded
from pierburg_ros.recording import Channel

EXACT = 0.99
"""Share of the input, or of the error that it follows from, that the rule explains where there is one. Measured: 0.9996
or more of the input with a servo's own loop (n = 8), 0.90 or less where a nonlinear controller made it (n = 8); of the
error beside an effect 0.998 or more where that was put into the servo's channels (n = 29), 0.97 or less beside a lag
that is not there, of a controller with an integral (n = 8)."""
INSIDE = 0.98
"""Share of its range within which an input is not limited. Chosen: a controller's limit is where it stays for long."""
TOLD = 0.75
"""Share of the mean square of the rule's error that an effect has to remove: the error of the rule halves. Measured:
effects put into a servo's recordings remove 0.89 to 0.9999 (n = 15). Those found in the untouched recordings beyond two
of their sample intervals remove 0.54 at most (n = 8)."""
INTERVALS = 2
"""Sample intervals by which controller and log may be apart; only times beyond that are reported. Derived: the
controller acts up to one before or after the sample, and the sample is read up to one after."""
FAR = 10.0
"""Factor beyond the plausible range up to which a strength is searched. Work: a wider range takes longer; not
varied."""
TRIED = 120
"""Number of strengths that are tried over that range, some percent apart. Work: each takes some tenths of a
millisecond."""
FEWEST = 100
"""Least number of samples at which the duty is free. Chosen: half a second of a servo's, which determine three numbers;
not varied."""
SETTLED = 8
"""Number of steps in which play and rule are fitted in turn. Work: each step at least halves what is left to correct;
not varied."""


@dataclass(frozen=True)
class Witness:
    """An effect at the strength that the rule shows, and the mean squares [rad^2] that the rule leaves.

    The strength lies `between` two values, and their geometric mean is taken. The rule leaves `without` if the effect
    does not act, and `beside` if it does. `as_well` are effects with which the rule leaves less than twice as much.
    """

    variant: Variant
    between: tuple[float, float]
    without: float
    beside: float
    as_well: tuple[str, ...] = ()

    @property
    def share(self) -> float:
        """Share of the mean square without the effect that the effect removes."""
        return 1.0 - self.beside / self.without

    @property
    def estimates(self) -> dict[str, Estimate]:
        """The strength with its interval, by its dotted name."""
        ((name, value),) = self.variant.fixed
        low, high = self.between
        known = high - low < 2.0 * HALF_KNOWN * value
        return {f"{self.variant.effect}.{name}": Estimate(value, low, high, known)}


Left = Callable[[float], Signal]
"""Gives the error [rad] of the rule with an effect of a strength, shape (free samples,)."""


def witnessed(signals: Signals, nominal: Model) -> Witness | None:
    """The effect in the sensor or the input's log that a proportional controller's rule shows; None if it shows none.

    The effect has to remove most of the error that the rule leaves otherwise, and a lag or delay has to be longer than
    sampling can show. With the effect, the rule has to be exact: it leaves next to nothing of the loop's error, from
    which the duty follows.
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
    """An effect as the rule shows it, with an infinite upper end if the rule gives none; None if it shows nothing."""
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
    """Name of the strength by which an effect shows in the rule, the rule's error with it, and the least reported."""
    if effect.lag is not None:
        return effect.lag, loop.lagging, INTERVALS * loop.interval
    if effect.dead_time is not None:
        return effect.dead_time, loop.delayed, INTERVALS * loop.interval
    if effect.play is not None and effect.stage == "sensor":
        return effect.play, loop.dragged, math.sqrt(_mean_square(loop.undisturbed))
    if effect.dead_band is not None:
        return effect.dead_band, loop.stepping, float(np.mean(np.abs(np.diff(loop.command.values))))
    return "", None, 0.0


def free_of_limits(signals: Signals) -> Flags:
    """Samples at which the input is not limited, and acts."""
    command = signals.command
    low, high = float(np.min(command)), float(np.max(command))
    free: Flags = np.abs(command - 0.5 * (low + high)) < 0.5 * INSIDE * (high - low)
    enabled = signals.inputs.enabled
    if enabled is not None:
        place = np.searchsorted(signals.inputs.time, signals.time, side="right") - 1
        free &= enabled[np.maximum(place, 0)]
    return free


@dataclass(frozen=True)
class _Loop:
    """A closed loop: angle = setpoint + p duty + q, for the p and q that fit best; signals of shape (samples,).

    `free` are samples at which the duty is neither limited nor without effect. `interval` [s] is the time between
    samples. Controller and log may be some samples apart; the offset that fits best is taken.
    """

    time: Signal
    angle: Signal
    setpoint: Signal
    free: Flags
    command: Channel
    interval: float

    @staticmethod
    def of(signals: Signals, nominal: Model, setpoints: Channel) -> _Loop | None:
        """The loop of some signals; None if too few samples are free, or a signal is constant there."""
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
        """Variance of the recorded angle minus the setpoint [rad^2]."""
        return float(np.var((self.angle - self.setpoint)[self.free]))

    @property
    def exact(self) -> bool:
        """Whether the rule leaves no more than rounding to single precision, which shows nothing."""
        return _mean_square(self.undisturbed) <= float(np.finfo(np.float32).eps) ** 2 * self.error

    @cached_property
    def duties(self) -> list[Signal]:
        """The duty as it was some samples before and after, each of shape (samples,)."""
        return [self.command.at(self.time - by * self.interval) for by in range(-INTERVALS, INTERVALS + 1)]

    @cached_property
    def undisturbed(self) -> Signal:
        """Error [rad] of the rule without an effect, shape (free samples,)."""
        ones = np.ones_like(self.time)
        return _least(_left(self.angle - self.setpoint, duty, ones, self.free) for duty in self.duties)

    def delayed(self, time: float) -> Signal:
        """Error [rad] of the rule if the duty acts a `time` [s] after it was logged, shape (free samples,).

        The duty was computed between this sample and the last, half an interval before on average. If too few samples
        are free, the result is that without an effect.
        """
        then = self.time - max(time - 0.5 * self.interval, 0.0)
        free: Flags = np.interp(then, self.time, self.free) == 1.0
        if np.count_nonzero(free) < FEWEST:
            return self.undisturbed
        return _left(self.angle - self.setpoint, self.command.at(then), np.ones_like(self.time), free)

    def stepping(self, width: float) -> Signal:
        """Error [rad] of the rule if the duty steps over a band of a `width` around 0, shape (free samples,)."""
        ones = np.ones_like(self.time)
        beyond = (np.copysign(np.maximum(np.abs(duty) - width, 0.0), duty) for duty in self.duties)
        return _least(_left(self.angle - self.setpoint, duty, ones, self.free) for duty in beyond)

    def lagging(self, time: float) -> Signal:
        """Error [rad] of the rule if the recorded angle follows with a lag of a `time` [s], shape (free samples,)."""
        ones, nothing = np.ones_like(self.angle), np.zeros_like(self.angle)
        known = self.angle - _followed(self.time, self.setpoint, self.angle, self.free, time)
        constant = _followed(self.time, ones, nothing, self.free, time)
        lagged = (_followed(self.time, duty, nothing, self.free, time) for duty in self.duties)
        return _least(_left(known, duty, constant, self.free) for duty in lagged)

    def dragged(self, width: float) -> Signal:
        """Error [rad] of the rule if the recorded angle has a play of a `width` [rad], shape (free samples,)."""
        return _least(self._dragged(width, duty) for duty in self.duties)

    def _dragged(self, width: float, duty: Signal) -> Signal:
        behind, ones = np.zeros_like(self.angle), np.ones_like(self.angle)
        for _ in range(SETTLED):
            by, offset = _weights(self.angle - self.setpoint - behind, duty, ones, self.free)
            acted_on = self.setpoint + by * duty + offset
            behind = _dragged(acted_on, self.angle, self.free, 0.5 * width) - acted_on
        return _left(self.angle - self.setpoint - behind, duty, ones, self.free)


def _least(residuals: Iterable[Signal]) -> Signal:
    """The residual with the smallest mean square."""
    return min(residuals, key=_mean_square)


def _left(target: Signal, by_duty: Signal, constant: Signal, kept: Flags) -> Signal:
    """Residual of a target after a fit of two columns at the samples `kept`, shape (kept samples,)."""
    by, offset = _weights(target, by_duty, constant, kept)
    return np.asarray((target - by * by_duty - offset * constant)[kept])


def _mean_square(residual: Signal) -> float:
    return float(np.mean(np.square(residual)))


def _weights(target: Signal, by_duty: Signal, constant: Signal, kept: Flags) -> tuple[float, float]:
    """Weights of two columns by least squares; 0 for a duty that adds nothing to the constant.

    They are computed thousands of times, so by Gram-Schmidt: a decomposition takes twenty times as long.
    """
    known, duty, other = target[kept], by_duty[kept], constant[kept]
    square = float(other @ other)
    own = duty - float(duty @ other) / square * other
    rest = float(own @ own)
    by = float(known @ own) / rest if rest > np.finfo(float).eps * float(duty @ duty) else 0.0
    return by, float((known - by * duty) @ other) / square


@kernel
def _followed(time: Signal, values: Signal, shown: Signal, free: Flags, lag: float) -> Signal:
    """`values` after a first-order `lag` [s], linear between samples, `shown` where not `free`; shape (samples,)."""
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
    """What `values` drag along with a play of twice `half`, `shown` where not `free`; shape (samples,)."""
    magnet = shown.copy()
    for k in range(1, values.size):
        if free[k]:
            magnet[k] = min(max(magnet[k - 1], values[k] - half), values[k] + half)
    result: Signal = magnet
    return result
