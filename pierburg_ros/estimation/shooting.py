"""Simulations that begin again and again: for actuators that nothing brings back to where they should be.

A spring, or the back-EMF of a closed bridge, makes an actuator forget how it began; a pendulum or a free rotor driven
by a current or a torque does not, and upright or between two poles an error even grows. There a recording is simulated
in stretches, and where each begins is fitted with it (multiple shooting: Bock, Plitt, IFAC Proceedings 17 (1984)
1603-1608, here with the states left open, and eliminated in each evaluation).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from pierburg_ros.actuators import Actuator
from pierburg_ros.arrays import Signal
from pierburg_ros.estimation.torque_balance import WINDOW
from pierburg_ros.plant import Inputs, Model
from pierburg_ros.plant.decode import angle_per_unit, decoded, trail, turned
from pierburg_ros.plant.simulate import simulate_stretches
from pierburg_ros.recording.noise import noise_of

FEWEST = 20
"""Samples that a stretch has at least. Derived: its two unknowns then take a tenth of what it tells."""
TIMES = 2.0
"""Length of a stretch in times of the motion, velocity over acceleration: a third of a swing of a harmonic one.
Derived: an unstable equilibrium as stiff as that swing makes an error exp(2) = 7 times larger in it, and the beginning
is known to a fraction of the noise."""
MOVES = 2
"""Steps by which a beginning is moved. Work: one more simulation each; the second gains where the first was far.
Not varied."""
TRUST = 3.0
"""Standard deviations of what the samples say by which a beginning may be moved freely; more costs as a residual does.
Measured: held within 5 or 30 of them, identified AK80 and ODrive runs keep up to 1.4 to 3.2 times the error (n = 5),
for the steps of a real encoder are no white noise."""


@dataclass(frozen=True)
class Shooting:
    """Where stretches begin and what the samples there say: all of shape (stretches,).

    `first` are their first samples, `level`, `rate` [1/s] and `curvature` [1/s^2] the measured value there and its
    derivatives, each with its standard deviation. `length` [s] is that of a stretch.
    """

    first: np.ndarray
    level: Signal
    rate: Signal
    curvature: Signal
    level_error: Signal
    rate_error: Signal
    curvature_error: Signal
    length: float

    @staticmethod
    def of(time: Signal, measured: Signal, length: float) -> Shooting:
        """Stretches of `length` [s] over samples."""
        first = _first_samples(time, length)
        noise = noise_of(time, measured)
        found = np.array([_local(time, measured, sample, noise) for sample in first.tolist()])
        level, rate, curvature, level_error, rate_error, curvature_error = found.T
        return Shooting(first, level, rate, curvature, level_error, rate_error, curvature_error, length)

    def simulated(self, model: Model, inputs: Inputs, time: Signal, measured: Signal, quantity: str) -> Signal:
        """What a model measures, each stretch from the beginning that suits its samples best, shape (samples,)."""
        angle, velocity, angle_error, velocity_error = self._states(model, time, measured, quantity)
        shown = decoded(model, self.level, quantity)

        def shot(more_angle: Signal | float, more_velocity: Signal | float) -> Signal:
            # what a slow sensor shows moves with what it senses: else it would swing towards it within the lag
            moved = shown + (more_velocity if quantity == "speed" else more_angle)
            return simulate_stretches(
                model, inputs, time, self.first, angle + more_angle, velocity + more_velocity, moved
            )

        best, move = shot(0.0, 0.0), np.zeros((2, self.first.size))
        slopes = shot(angle_error, 0.0) - best, shot(0.0, velocity_error) - best
        error, lengths = self._sums(np.square(measured - best)), np.diff(np.append(self.first, time.size))
        for _ in range(MOVES):
            further = move + self._move(measured - best, *slopes, noise_of(time, measured))
            moved = shot(further[0] * angle_error, further[1] * velocity_error)
            reached = self._sums(np.square(measured - moved))
            better = reached < error
            best = np.where(np.repeat(better, lengths), moved, best)
            error, move = np.where(better, reached, error), np.where(better, further, move)
        return best

    def _states(
        self, model: Model, time: Signal, measured: Signal, quantity: str
    ) -> tuple[Signal, Signal, Signal, Signal]:
        """Angle [rad] and velocity [rad/s] that the samples show, and how far each may be off.

        What a sensor with a lag shows changes by as much as it is behind, over the lag: that is how far the shaft is
        ahead, and so is its velocity.
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

    def _move(self, residual: Signal, by_angle: Signal, by_velocity: Signal, noise: float) -> Signal:
        """Least-squares move of each beginning, in its errors, shape (2, stretches)."""
        sums = self._sums
        trust = (noise / TRUST) ** 2
        aa, vv = sums(by_angle**2) + trust, sums(by_velocity**2) + trust
        av, ra, rv = sums(by_angle * by_velocity), sums(residual * by_angle), sums(residual * by_velocity)
        determinant = aa * vv - av * av
        return np.array([(vv * ra - av * rv) / determinant, (aa * rv - av * ra) / determinant])

    def _sums(self, values: Signal) -> Signal:
        """Sum of `values` over each stretch; a very large number where they are none."""
        return np.asarray(np.add.reduceat(np.nan_to_num(values, nan=1e6), self.first))


UNKNOWN_ANGLE = 0.064
"""By how much the beginning of a stretch may be off where only the speed is measured, as a share of the travel or what
stands in its place. Chosen: 0.1 rad for a pendulum; an angle that matters shows in the speed, and the fit may move it
by several times as much; not varied."""


def forgets(actuator: Actuator) -> bool:
    """Whether an actuator forgets how it began: a spring or a closed bridge brings it back."""
    return actuator.load == "spring" or actuator.drive == "voltage"


def stretch_length(time: Signal, measured: Signal, quantity: str) -> float:
    """Length [s] of stretches in which an error of the beginning stays small: a few times of the motion itself."""
    interval = float(np.median(np.diff(time)))
    noise = noise_of(time, measured)
    first, second = (0, 1) if quantity == "speed" else (1, 2)
    velocity, acceleration = (spread(measured, order, interval, noise) for order in (first, second))
    own = TIMES * velocity / acceleration if acceleration > 0.0 else math.inf
    return min(max(own, FEWEST * interval), float(time[-1] - time[0]))


def spread(measured: Signal, order: int, interval: float, noise: float) -> float:
    """Standard deviation of a derivative of `measured`, over a window in which the noise is the lesser part of it."""
    from scipy.signal import savgol_coeffs  # takes long to load, and most actuators need none

    window, own, added = WINDOW, 0.0, 1.0
    while added > own and window <= measured.size:
        weights = savgol_coeffs(window, 3, deriv=order, delta=interval, use="dot")
        added = noise**2 * float(weights @ weights)
        own = float(np.var(np.convolve(measured, weights[::-1], mode="valid"))) - added
        window = 2 * window + 1
    return math.sqrt(max(own, 0.0))


def _first_samples(time: Signal, length: float) -> np.ndarray:
    """The first sample of each stretch: `length` [s] after the one before, and `FEWEST` samples at least."""
    first = [0]
    while True:
        later = int(np.searchsorted(time, time[first[-1]] + (1.0 - 1e-9) * length))
        following = max(later, first[-1] + FEWEST)
        if time.size - following < FEWEST:
            return np.array(first)
        first.append(following)


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
