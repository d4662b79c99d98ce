"""Start values of a fit from the torque balance along the measured motion, without a simulation.

Inertia, friction, load and motor must balance at every moment. No simulated slip can come at a wrong moment. The
balance is linear in nearly all unknowns, so it has one minimum, however wrong a description is. Noise and smoothing
bias its values: they are the start of a fit of simulations, not a result. An equation error before an output error:
Ljung, System Identification (2nd edition, 1999), section 10.5.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.inference.coordinates import in_order
from pierburg_ros.inference.least_squares import minimise
from pierburg_ros.plant import Inputs, Model
from pierburg_ros.plant.decode import decoded, turned
from pierburg_ros.plant.simulate import motor_torque
from pierburg_ros.plant.torques.missing import missing
from pierburg_ros.recording import Channel
from pierburg_ros.recording.noise import noise_of

FARTHEST = math.log(200.0)
"""Largest logarithm of the factor by which a number may be wrong, either way. Chosen: a description that is off by more
is better written anew."""
CUBIC = 3
"""Degree of the polynomial through the samples of a window. Derived: with it the acceleration may change within the
window."""
NARROWEST = 7
"""Smallest number of samples in a window for the motion. Derived: a cubic then leaves three of them free."""
BLURRED = 0.3
"""Largest share of the spread of the acceleration that may be noise. Derived: noise biases the inertia by the square of
this share, a tenth."""
CERTAIN = 4.0
"""Velocity, in standard deviations of its noise, from which the sign of friction is known. Derived: white noise reaches
it with a probability of 6e-5."""
NEAR = 0.01
"""Distance from a stop within which the force of the stop is unknown, as a share of the travel. Chosen: the distance at
which a diagnosis takes a shaft to rest on a stop; not varied."""
FEWEST = 50
"""Smallest number of moments for each number that is fitted. Derived: moments in one window say the same."""
MOST = 4000
"""Largest number of moments, spread evenly over the motion. Work: more moments do not improve a start."""
RELUCTANCE = 0.01
"""Cost of changing a number by a factor of e, as a share of the motor torque. Chosen: a number that the motion does not
determine stays as described, and a factor of 20 costs less than a thousandth of that torque squared."""
STEP = 1e-4
"""Step of the finite differences, in logarithms. Derived: the balance is smooth, and this is far above rounding."""
ITERATIONS = 100
"""Largest number of iterations of the fit. Work: a balance of 4000 moments takes less than a millisecond; not
varied."""


@dataclass(frozen=True)
class Motion:
    """The inputs of an actuator, and its `measured` `quantity` at each `time` [s], both of shape (samples,)."""

    inputs: Inputs
    time: Signal
    measured: Signal
    quantity: str


@dataclass(frozen=True)
class Moments:
    """Moments at which the shaft slides freely: time [s], angle [rad], its derivatives and the drive; shape (moments,).

    `driving` is the voltage of the armature [V] where its supply was recorded (`volts`), otherwise the input.
    """

    time: Signal
    angle: Signal
    velocity: Signal
    acceleration: Signal
    driving: Signal
    volts: bool

    def motor(self, model: Model) -> Signal:
        """Motor torque at the shaft [N.m]."""
        value = model.values
        if model.actuator.drive != "voltage":
            return self.driving * float(motor_torque(model, Inputs(np.zeros(1), np.ones(1)), np.zeros(1))[0])
        constant = value["gear_ratio"] * value["torque_constant"]
        volts = self.driving if self.volts else self.driving * value["supply_voltage"]
        return np.asarray(constant / value["armature_resistance"] * (volts - constant * self.velocity))

    def left(self, model: Model) -> Signal:
        """Torque that `model` leaves unexplained, over the root mean square of its motor torque, shape (moments,)."""
        motor = self.motor(model)
        torque = missing(model.record()[0], motor, self.time, self.angle, self.velocity, self.acceleration)
        return np.asarray(torque / (float(np.sqrt(np.mean(motor**2))) + 1e-300 * model.scales.torque))


def balanced(model: Model, motions: Sequence[Motion], names: Sequence[str]) -> Model | None:
    """`model` with the values of `names` at which the torques balance best; None where too few moments are usable."""
    names = [name for name in names if model.values[name] > 0.0 and model.range(name)[0] >= 0.0]
    several = [moments_of(motion, model, MOST // len(motions)) for motion in motions]
    if not names or sum(each.time.size for each in several) < FEWEST * len(names):
        return None
    nominal = np.array([model.values[name] for name in names])
    ranges = np.log(np.maximum([model.range(name) for name in names], 1e-300) / nominal[:, None])
    lower, upper = np.clip(ranges, -FARTHEST, FARTHEST).T

    def at(point: Signal) -> Model:
        values = dict(zip(names, (nominal * np.exp(point)).tolist(), strict=True))
        bounded = {name: min(max(value, model.range(name)[0]), model.range(name)[1]) for name, value in values.items()}
        return model.with_values(in_order(bounded, model))

    def left(point: Signal) -> Signal:
        here = at(point)
        torques = np.concatenate([each.left(here) for each in several])
        return np.concatenate([torques, RELUCTANCE * math.sqrt(torques.size) * point])

    found = minimise(left, np.zeros(nominal.size), lower, upper, np.full(nominal.size, STEP), ITERATIONS, 1e-6)
    return at(found.point)


def moments_of(motion: Motion, model: Model, most: int) -> Moments:
    """The moments of `motion` at which the shaft moves for certain, between the stops and with a closed bridge."""
    step = float(np.median(np.diff(motion.time)))
    time = np.arange(motion.time[0], motion.time[-1], step)
    angle = np.interp(time, motion.time, turned(model, motion.time, motion.measured, motion.quantity))
    value, speed = decoded(model, motion.measured, motion.quantity), motion.quantity == "speed"
    noise, shown = noise_of(motion.time, value), np.interp(time, motion.time, value)
    width = window(shown, noise, step, 1 if speed else 2)

    def smooth(values: Signal, order: int) -> Signal:
        return np.asarray(np.convolve(values, weights(width, order, step), mode="same"))

    velocity, acceleration = (smooth(shown, order - speed) for order in (1, 2))
    driving, recorded, closed = driven(motion, model, time)
    uncertain = noise * float(np.linalg.norm(weights(width, 0 if speed else 1, step)))
    kept = (np.abs(velocity) > CERTAIN * uncertain) & (smooth(closed, 0) > 0.999)
    low, high = model.actuator.lower_stop, model.actuator.upper_stop
    if math.isfinite(high - low):
        kept &= (angle > low + NEAR * (high - low)) & (angle < high - NEAR * (high - low))
    kept[: width // 2] = kept[-(width // 2) :] = False
    places = np.flatnonzero(kept)
    places = places[:: max(places.size // most, 1)]
    return Moments(
        time[places],
        smooth(angle, 0)[places],
        velocity[places],
        acceleration[places],
        smooth(driving, 0)[places],
        recorded,
    )


def driven(motion: Motion, model: Model, time: Signal) -> tuple[Signal, bool, Signal]:
    """The drive at each `time` [s], whether it is a recorded supply's voltage [V], and 1 where the bridge is closed."""
    inputs = motion.inputs

    def held(values: Signal) -> Signal:
        return Channel(inputs.time, values).at(time, before=0.0)

    closed = np.ones(time.size) if inputs.enabled is None else held(inputs.enabled.astype(float))
    supply = inputs.supply_voltage
    if model.actuator.drive != "voltage" or supply is None:
        return held(inputs.command), False, closed
    return held(inputs.command * supply), True, closed


def window(shown: Signal, noise: float, step: float, order: int) -> int:
    """Number of samples in a window over which noise is a small part of a derivative of `shown`."""
    width = NARROWEST
    while 4 * width < shown.size:
        kernel = weights(width, order, step)
        told = float(np.std(np.convolve(shown, kernel, mode="valid")))
        if noise * float(np.linalg.norm(kernel)) <= BLURRED * told:
            break
        width = 2 * (width // 2 * 3 // 2) + 1
    return width


def weights(width: int, order: int, step: float) -> Signal:
    """Weights of the samples of a window, the last one first, for a derivative of the cubic through them."""
    from scipy.signal import savgol_coeffs  # takes long to load

    return np.asarray(savgol_coeffs(width, CUBIC, deriv=order, delta=step))
