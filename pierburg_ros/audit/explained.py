"""How much of a motion an actuator makes of the inputs, with its numbers free to drift: the measure of every test."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.audit.signals import Signals
from pierburg_ros.effects import EFFECT
from pierburg_ros.estimation.shooting import stretch_length
from pierburg_ros.inference.coordinates import in_order
from pierburg_ros.inference.least_squares import minimise
from pierburg_ros.plant import Model, simulate
from pierburg_ros.plant.decode import decoded

FEWEST = 40
"""Samples of a piece that starts from the measured state, at least. Derived: twice those over which a velocity is
told."""
SHORTER = 0.5
"""Length of the pieces in stretches of `estimation`, in which an error of the beginning stays small. Chosen: half, for
nothing corrects the beginning here."""
COMPARED = 4000
"""Samples that a fit compares. Work: more of them tell no more of a slip."""
BRIEF, FULL = 2, 7
"""Iterations of a fit that ranks slips, and of one that decides. Work: a wrong slip gains nothing in any number."""
STEP = 0.02
"""Step of the finite differences, in logarithms of parameters. Chosen: wide enough to look across stick and slip."""
RELUCTANCE = 0.1
"""What a drift by a factor of e costs, in the root of the share of motion left unexplained. Chosen: a drift by a factor
of 6 costs 3 % of the motion, so numbers move where they explain more than that."""
FARTHEST = 2.5
"""Bound of every drift, as a logarithm. Chosen: beyond `CREDIBLE`, so that no fit ends there that counts."""
CREDIBLE = 2.0
"""Largest drift of all numbers together that counts, root of the sum of squared logarithms. Derived: one number may be
off by a factor of 6, 1.8, as in every search; the rest is room for what effects pull at the others."""
ENOUGH = 0.5
"""Share of motion, and correlation of velocities, from which the signals are what they are read as. Measured: clean
recordings (n = 57) reach 0.55 and 0.77 or more, with the duty of other runs velocities agree by 0.4 or less."""
SHARP = 10
"""Samples over which a velocity is told, to either side. Chosen: 20 ms at 500 Hz; over 200 ms a duty of another run
agrees as little."""
BESIDE = 75
"""Samples by which simulated and measured velocities may lie apart. Chosen: 0.15 s at 500 Hz; delays are shorter."""
SENSOR = ("gear_ratio", "hall_voltage_closed", "hall_voltage_open", "sensor_scale", "sensor_offset")
"""Numbers that stay: those of the sensor, which the slips themselves change, and the gear, which is one with the
torque constant."""


@dataclass(frozen=True)
class Explained:
    """How signals and actuator agree: what is left of the motion, how velocities correlate, how far numbers drifted.

    `share` of the motion is explained by `model`, 1 all; `agreement` is the largest correlation of measured and
    simulated velocity within a few samples; `drift` the root of the sum of squared logarithms. Simulated in pieces of a
    `length` [s].
    """

    share: float
    agreement: float
    drift: float
    model: Model
    length: float
    measured: Signal
    simulated: Signal

    @property
    def suffices(self) -> bool:
        """Whether the actuator, as far as it may have drifted, moves like this with such inputs."""
        return self.share >= ENOUGH and self.agreement >= ENOUGH and self.drift <= CREDIBLE

    @property
    def cost(self) -> float:
        """What is left unexplained, and what the drifts cost."""
        return 1.0 - self.share + (RELUCTANCE * self.drift) ** 2


def explained(signals: Signals, nominal: Model, iterations: int = FULL) -> Explained:
    """The better of one simulation from the first sample and of pieces that each start from the measured state."""
    whole = Fit(signals, nominal).best(iterations)
    if whole.suffices or iterations < FULL:
        return whole
    stretch = SHORTER * stretch_length(signals.time, signals.measured, signals.quantity)
    pieces = Fit(signals, nominal, max(stretch, FEWEST * signals.interval)).best(iterations)
    return max(whole, pieces, key=lambda found: (found.suffices, found.share))


class Fit:
    """Least squares of the decoded angle by the logarithms of the actuator's positive numbers."""

    def __init__(self, signals: Signals, nominal: Model, length: float = math.inf) -> None:
        self.signals, self.nominal = signals, nominal
        self.names = tuple(_drifting(nominal))
        self.angle = decoded(nominal, signals.measured, signals.quantity)
        self.length = length
        self.starts = tuple(_starts(signals, nominal, self.angle, max(math.floor(signals.duration / length), 1)))
        self.stride = max(signals.time.size // COMPARED, 1)
        self.motion = self._motion()

    def best(self, iterations: int, begin: Model | None = None) -> Explained:
        """The numbers that explain the most, drifting reluctantly; from those of `begin`, else as described."""
        size = len(self.names)
        start, bound = np.zeros(size) if begin is None else self.point(begin), np.full(size, FARTHEST)
        found = minimise(self._cost, start, -bound, bound, np.full(size, STEP), iterations, 1e-3)
        model = self.model(found.point)
        simulated = self.simulated(model)
        share = 1.0 - float(np.mean(np.square(found.residual[size:]))) if self.motion > 0.0 else 0.0
        agreement = agreed(self.angle, simulated, self.cuts)
        drift = float(np.linalg.norm(found.point))
        return Explained(share, agreement, drift, model, self.length, self.angle, simulated)

    @property
    def cuts(self) -> list[int]:
        """Samples at which a piece begins."""
        return [first for first, *_ in self.starts]

    def share(self, model: Model) -> float:
        """Share of the motion that `model` explains."""
        return 1.0 - float(np.mean(np.square(self.left(model)))) if self.motion > 0.0 else 0.0

    def left(self, model: Model) -> Signal:
        """What `model` leaves of each compared sample, in the root mean square of the motion."""
        left = (self.angle[:: self.stride] - self.simulated(model, self.stride)) / (self.motion or 1.0)
        return np.asarray(np.nan_to_num(left, nan=1e3, posinf=1e3, neginf=-1e3))

    def _cost(self, point: Signal) -> Signal:
        left = self.left(self.model(point))
        return np.concatenate([RELUCTANCE * math.sqrt(left.size) * point, left])

    def model(self, point: Signal) -> Model:
        """The actuator with its numbers moved by these logarithms."""
        values = {}
        for name, moved in zip(self.names, point, strict=True):
            least, most = self.nominal.range(name)
            values[name] = min(max(self.nominal.values[name] * math.exp(moved), least), most)
        return self.nominal.with_values(in_order(values, self.nominal))

    def point(self, model: Model) -> Signal:
        """The logarithms by which the numbers of `model` are moved."""
        return np.array([math.log(model.values[name] / self.nominal.values[name]) for name in self.names])

    def simulated(self, model: Model, stride: int = 1) -> Signal:
        """Decoded angle at every `stride`th sample."""
        output = np.full(self.signals.time[::stride].size, np.nan)
        for first, last, angle, velocity in self.starts:
            kept = slice(-(-first // stride), -(-last // stride))
            times = self.signals.time[::stride][kept]
            if times.size:
                output[kept] = simulate(model, self.signals.inputs, times, angle, velocity)
        return decoded(self.nominal, output)

    def _motion(self) -> float:
        """Root mean square of what no input would explain: the way from each start, less what is usual from there."""
        if len(self.starts) == 1:
            return float(np.std(self.angle))
        left = []
        since = np.concatenate([np.arange(last - first) * 10 // (last - first) for first, last, *_ in self.starts])
        begun = np.concatenate([np.full(last - first, angle) for first, last, angle, _ in self.starts])
        rate = np.concatenate([np.full(last - first, velocity) for first, last, _, velocity in self.starts])
        for tenth in range(10):
            here = since == tenth
            way = (self.angle - begun)[here]
            known = np.stack([np.ones(way.size), begun[here], rate[here]], axis=1)
            left.append(way - known @ np.linalg.lstsq(known, way, rcond=None)[0])
        return float(np.sqrt(np.mean(np.square(np.concatenate(left)))))


def _drifting(nominal: Model) -> Iterator[str]:
    """Positive numbers of the actuator and of the effects that it always has."""
    for name in nominal.actuator.parameters:
        if name not in SENSOR and nominal.values[name] > 0.0:
            yield name
    for effect in nominal.active_effects:
        for parameter in EFFECT[effect].parameters:
            name = f"{effect}.{parameter.name}"
            if nominal.values[name] > 0.0 and not parameter.choices:
                yield name


def _starts(signals: Signals, nominal: Model, angle: Signal, pieces: int) -> Iterator[tuple[int, int, float, float]]:
    """First sample, sample after the last, angle [rad] and velocity [rad/s] of each piece."""
    actuator, cuts = nominal.actuator, np.linspace(0, angle.size, pieces + 1).astype(int)
    near = 0.003 * (actuator.upper_stop - actuator.lower_stop)
    for first, last in pairwise(cuts):
        around = slice(max(first - SHARP, 0), first + SHARP + 1)
        velocity, here = np.polyfit(signals.time[around] - signals.time[first], angle[around], 1)
        if np.isfinite(near) and (here <= actuator.lower_stop + near or here >= actuator.upper_stop - near):
            here, velocity = min(max(here, actuator.lower_stop), actuator.upper_stop), 0.0
        yield int(first), int(last), float(here), float(velocity)


def agreed(measured: Signal, simulated: Signal, cuts: Sequence[int] = ()) -> float:
    """Largest correlation of the two velocities while they lie no more than `BESIDE` samples apart."""
    _, correlation = correlated(slopes(measured, cuts), slopes(simulated, cuts), BESIDE)
    return float(np.max(correlation, initial=0.0))


def slopes(values: Signal, cuts: Sequence[int] = ()) -> Signal:
    """Change of `values` over 2 `SHARP` samples around each, less its mean; 0 around `cuts`, where a piece begins."""
    change = values[2 * SHARP :] - values[: -2 * SHARP]
    for cut in cuts:
        change[max(cut - 2 * SHARP, 0) : cut] = 0.0
    return np.asarray(change - np.mean(change))


def correlated(measured: Signal, simulated: Signal, beside: int) -> tuple[Signal, Signal]:
    """By how many samples `measured` comes after `simulated`, and how they then correlate; empty where one is still."""
    if not all(np.all(np.isfinite(each)) and np.ptp(each) > 0.0 for each in (measured, simulated)):
        return np.empty(0), np.empty(0)
    size = 1 << (2 * measured.size - 1).bit_length()
    product = np.fft.irfft(np.fft.rfft(measured, size) * np.conj(np.fft.rfft(simulated, size)), size)
    most = min(beside, measured.size - 1)
    lags = np.arange(-most, most + 1)
    return lags.astype(np.float64), product[lags] / math.sqrt(float(measured @ measured) * float(simulated @ simulated))


def simulated_from(signals: Signals, model: Model) -> Signal:
    """Decoded angle that `model` makes of the inputs from the first sample on."""
    return Fit(signals, model).simulated(model)
