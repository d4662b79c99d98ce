"""Simulation in stretches, for actuators that do not forget their initial state.

A spring, or the back-EMF of a closed bridge, makes an actuator forget its initial state. A pendulum or a free rotor
driven by a current or a torque does not forget it, and upright or between two poles an error even grows. Its recording
is simulated in stretches, and a fit includes the initial state of each. (Multiple shooting: Bock, Plitt, IFAC
Proceedings 17 (1984) 1603-1608, here with the states left open, and eliminated in each evaluation.)
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from pierburg_ros.actuators import Actuator
from pierburg_ros.arrays import Signal
from pierburg_ros.estimation.initial_state import EVEN, keeps_still
from pierburg_ros.estimation.shots import Shots
from pierburg_ros.estimation.torque_balance import WINDOW
from pierburg_ros.plant import Inputs, Model
from pierburg_ros.plant.decode import angle_per_unit, decoded, trail, turned
from pierburg_ros.recording.noise import noise_of

FEWEST = 20
"""Smallest number of samples in a stretch. Derived: its two unknowns then take a tenth of its information."""
TIMES = 2.0
"""Length of a stretch in times of the motion, velocity over acceleration: a third of a swing of a harmonic one.
Derived: an unstable equilibrium as stiff as that swing makes an error exp(2) = 7 times larger in it. The initial state
is known to a fraction of the noise."""
MOVING = 8.0
"""Rate of a shaft, in its standard deviations, from which the shaft certainly moves, wherever a fit moves its initial
state. Below that, friction may or may not hold it, and steps along slopes end anywhere. Measured: of n = 64 recordings
of a pendulum that sticks, 19 had initial states off by 4.5 to 220 standard deviations of their error at the true
values. With this threshold, 7 have such states; the further steps (`shots.py`) correct the rest."""


@dataclass(frozen=True)
class Shooting:
    """The first samples of stretches and the state that they show; all of shape (stretches,).

    `first` are the first samples. `level`, `rate` [1/s] and `curvature` [1/s^2] are the measured value there and its
    derivatives, each with its standard deviation. `length` [s] is that of a stretch, `noise` that of the samples.
    """

    first: np.ndarray
    level: Signal
    rate: Signal
    curvature: Signal
    level_error: Signal
    rate_error: Signal
    curvature_error: Signal
    length: float
    noise: float

    @staticmethod
    def of(time: Signal, measured: Signal, length: float, quantity: str) -> Shooting:
        """Stretches of about `length` [s] over samples of a `quantity`.

        For an angle they begin where the shaft certainly moves, or rests for long.
        """
        noise = noise_of(time, measured)
        if quantity == "speed":
            first, begins = _first_samples(time, length, lambda sample: True), _local
        else:
            first, begins = (
                _first_samples(time, length, lambda sample: _told(time, measured, sample, noise)),
                _beginning,
            )
        found = np.array([begins(time, measured, sample, noise) for sample in first.tolist()])
        level, rate, curvature, level_error, rate_error, curvature_error = found.T
        return Shooting(first, level, rate, curvature, level_error, rate_error, curvature_error, length, noise)

    def simulated(self, model: Model, inputs: Inputs, time: Signal, measured: Signal, quantity: str) -> Signal:
        """The simulation, each stretch from the initial state that fits its samples best, shape (samples,)."""
        shown = decoded(model, self.level, quantity)
        states = self._states(model, time, measured, quantity)
        return Shots(model, inputs, time, measured, quantity, self.noise, self.first, *states, shown).suited()

    def _states(
        self, model: Model, time: Signal, measured: Signal, quantity: str
    ) -> tuple[Signal, Signal, Signal, Signal]:
        """Angle [rad] and velocity [rad/s] that the samples show, then the error of each, all of shape (stretches,).

        The reading of a sensor with a lag changes by its distance behind the shaft, over the lag. The shaft is
        therefore ahead by the rate times the lag, and so is its velocity.
        """
        scale = abs(angle_per_unit(model))
        value = decoded(model, self.level, quantity)
        if quantity != "speed":
            late, play = trail(model)
            velocity = (self.rate + late * self.curvature) * angle_per_unit(model)
            angle = value + late * self.rate * angle_per_unit(model) + 0.5 * play * np.sign(velocity)
            angle_error, velocity_error = (
                np.hypot(own, late * next_own) * scale
                for own, next_own in ((self.level_error, self.rate_error), (self.rate_error, self.curvature_error))
            )
            return angle, velocity, angle_error, velocity_error
        angle = turned(model, time, measured, quantity)[self.first]
        return angle, value, np.full(value.size, UNKNOWN_ANGLE * model.scales.angle), self.level_error * scale


UNKNOWN_ANGLE = 0.064
"""Standard deviation of the initial angle of a stretch where only the speed is measured, as a share of the travel or
what replaces it. Chosen: 0.1 rad for a pendulum. An angle that matters shows in the speed, and the fit may move it by
several times as much; not varied."""


def forgets(actuator: Actuator) -> bool:
    """Whether an actuator forgets its initial state: a spring or a closed bridge brings it back."""
    return actuator.load == "spring" or actuator.drive == "voltage"


def stretch_length(time: Signal, measured: Signal, quantity: str) -> float:
    """Length [s] of stretches in which an error of the initial state stays small: a few times of the motion itself."""
    interval = float(np.median(np.diff(time)))
    noise = noise_of(time, measured)
    first, second = (0, 1) if quantity == "speed" else (1, 2)
    velocity, acceleration = (spread(measured, order, interval, noise) for order in (first, second))
    own = TIMES * velocity / acceleration if acceleration > 0.0 else math.inf
    return min(max(own, FEWEST * interval), float(time[-1] - time[0]))


def spread(measured: Signal, order: int, interval: float, noise: float) -> float:
    """Standard deviation of a derivative of `measured`, over a window in which the noise is the smaller part of it."""
    from scipy.signal import savgol_coeffs  # takes long to load, and most actuators need none

    window, own, added = WINDOW, 0.0, 1.0
    while added > own and window <= measured.size:
        weights = savgol_coeffs(window, 3, deriv=order, delta=interval, use="dot")
        added = noise**2 * float(weights @ weights)
        own = float(np.var(np.convolve(measured, weights[::-1], mode="valid"))) - added
        window = 2 * window + 1
    return math.sqrt(max(own, 0.0))


def _first_samples(time: Signal, length: float, told: Callable[[int], bool]) -> np.ndarray:
    """The first sample of each stretch: about `length` [s] after the one before, and at least `FEWEST` samples.

    Of the samples that make a stretch half to one and a half times as long, the nearest for which `told` holds is
    taken.
    """
    first = [0]
    while True:
        later = int(np.searchsorted(time, time[first[-1]] + (1.0 - 1e-9) * length))
        due = max(later, first[-1] + FEWEST)
        if time.size - due < FEWEST:
            return np.array(first)
        half = (due - first[-1]) // 2
        allowed = range(max(due - half, first[-1] + FEWEST), min(due + half, time.size - FEWEST) + 1)
        near = (each for each in sorted(allowed, key=lambda sample: abs(sample - due)) if told(each))
        first.append(next(near, due))


def _told(time: Signal, measured: Signal, sample: int, noise: float) -> bool:
    """Whether the samples determine the initial state of a stretch there: the shaft certainly moves, or it rests."""
    _, rate, _, _, rate_error, curvature_error = _beginning(time, measured, sample, noise)
    return bool(curvature_error == 0.0 or abs(rate) > MOVING * rate_error)


def _beginning(time: Signal, measured: Signal, sample: int, noise: float) -> Signal:
    """Value, rate and curvature at a sample and their standard deviations: at rest, or of a parabola around it.

    Where a shaft rests, its rate is taken as zero, and its place is the mean of the samples.
    """
    start = min(max(sample - EVEN // 2, 0), max(time.size - EVEN, 0))
    around = slice(start, start + EVEN)
    if not keeps_still(time[around], measured[around], noise):
        return _local(time, measured, sample, noise)
    deviation = math.sqrt(EVEN) * float(np.std(time[around]))
    return np.array([np.mean(measured[around]), 0.0, 0.0, noise / math.sqrt(EVEN), noise / deviation, 0.0])


def _local(time: Signal, measured: Signal, sample: int, noise: float) -> Signal:
    """Value, rate and curvature at a sample from a parabola through those around it, then their standard deviations."""
    start = min(max(sample - WINDOW // 2, 0), max(time.size - WINDOW, 0))
    near = slice(start, start + WINDOW)
    elapsed = time[near] - time[sample]
    powers = np.stack([np.ones(elapsed.size), elapsed, elapsed**2], axis=1)
    inverse = np.linalg.pinv(powers)
    derivative = np.array([1.0, 1.0, 2.0])
    errors = noise * np.linalg.norm(inverse, axis=1)
    return np.concatenate([derivative * (inverse @ measured[near]), derivative * errors])
