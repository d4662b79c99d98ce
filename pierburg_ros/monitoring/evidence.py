"""What one movement says about the parameters: the model's prediction from where it began, and its slopes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pierburg_ros.actuators import Actuator
from pierburg_ros.monitoring.movements import Movement, Samples, Signal
from pierburg_ros.plant import Inputs, Model, simulate

SLOPE_STEP = 0.01
"""Relative change of a parameter that a slope is taken over: friction makes smaller ones rough."""

SUPPLY = "supply_voltage"


@dataclass(frozen=True)
class Evidence:
    """Sums of a movement's equations `residual = slopes x`, in standard deviations of the sensor's noise.

    x are logarithms of parameters over the model's, shape (parameters,), linearised at `about`; the angle at the
    start is already eliminated.
    """

    movement: Movement
    about: Signal
    information: NDArray[np.float64]  # slopes' slopes, shape (parameters, parameters)
    gain: Signal  # slopes' residual, shape (parameters,)
    energy: float  # residual' residual


def watched(model: Model) -> tuple[str, ...]:
    """Names of the parameters whose drift can show: those that the actuator leaves free and that act."""
    return tuple(name for name in model.actuator.free if model.values[name] != 0.0)


def decoded(actuator: Actuator, measured: Signal) -> Signal:
    """Angle [rad] from what the actuator's sensor gives [V or rad], by its nominal calibration."""
    if actuator.quantity == "position":
        return measured
    closed = actuator.parameters["hall_voltage_closed"].nominal
    opened = actuator.parameters["hall_voltage_open"].nominal
    return actuator.lower_stop + (measured - closed) * (actuator.upper_stop - actuator.lower_stop) / (opened - closed)


def predicted(model: Model, samples: Samples, start: float, supply: float = 1.0) -> Signal:
    """Angle [rad] at the samples, simulated from `start` [rad] under their duty, shape (samples,).

    A logged supply is multiplied by `supply`; without one the model's own is in force.
    """
    known = bool(np.all(np.isfinite(samples.supply_voltage)))
    inputs = Inputs(samples.time, samples.duty, samples.supply_voltage * supply if known else None)
    return decoded(model.actuator, simulate(model, inputs, samples.time, start))


def scaled(model: Model, names: Sequence[str], logarithms: Signal) -> Model:
    """The model with parameters multiplied by the exponentials of `logarithms`."""
    factors = zip(names, np.exp(logarithms), strict=True)
    return model.with_values({name: float(model.values[name] * factor) for name, factor in factors if factor != 1.0})


def evidence(model: Model, movement: Movement, names: Sequence[str], about: Signal) -> Evidence:
    """The evidence of a movement on the parameters `names`, linearised at `about`."""
    samples, noise = movement.samples, movement.noise

    def run(logarithms: Signal, start: float) -> Signal:
        changed = scaled(model, names, logarithms)
        return predicted(changed, samples, start, changed.values[SUPPLY] / model.values[SUPPLY])

    angle = run(about, movement.start)
    columns = [(run(about + step, movement.start) - angle) / SLOPE_STEP for step in SLOPE_STEP * np.eye(about.size)]
    columns.append((run(about, movement.start + noise) - angle) / noise)
    slopes = np.column_stack(columns)
    residual = samples.angle - angle + slopes[:, :-1] @ about
    return summed(movement, about, slopes / noise, residual / noise)


def summed(movement: Movement, about: Signal, slopes: NDArray[np.float64], residual: Signal) -> Evidence:
    """The equations summed, with the last column, the angle at the start, eliminated."""
    own = slopes[:, -1]
    weight = float(own @ own)
    if weight > 0.0:
        slopes = slopes[:, :-1] - np.outer(own, own @ slopes[:, :-1]) / weight
        residual = residual - own * (own @ residual) / weight
    return Evidence(movement, about, slopes.T @ slopes, slopes.T @ residual, float(residual @ residual))
