"""How fast an error of the input moves a simulated shaft, and how long this error remains."""

from __future__ import annotations

import math

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.plant import Model
from pierburg_ros.plant.braking import braking


def top_speed(model: Model) -> float:
    """Speed of the free shaft at full duty [rad/s], at which the back-EMF equals the supply voltage.

    For other drives it is the speed that a large torque reaches against the load.
    """
    return model.scales.angle / model.scales.time


def remaining(moved: Signal, model: Model, duration: float) -> float:
    """Root mean square over a `duration` [s] of the error of a shaft that was `moved` so far, each time by chance.

    It has the unit of `moved`, shape (times,). Each error decays with the time constant of `model`, its square with
    half of it.
    """
    return math.sqrt(float(np.sum(np.square(moved))) * 0.5 * min(memory(model), duration) / duration)


def memory(model: Model) -> float:
    """Time constant [s] with which the spring removes an error of the angle; infinite without a spring."""
    stiffness = model.values.get("spring_stiffness", 0.0)
    return braking(model) / stiffness if stiffness > 0.0 else math.inf
